"""The cases of the comparison with other libraries, how they are measured, and which results are kept."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from .experiment import Case, Experiment
from .run import Measuring

# The numbers and densities of uniform boxes. When the other is varied, there are 10,000 boxes that touch 4 others
# each.
NUMBERS = (100, 300, 1_000, 3_000, 10_000, 100_000, 1_000_000)
DENSITIES = (0.25, 1, 4, 16, 64)
# A million boxes are only for algorithms that take seconds at most.
FAST = ("auto", "grid", "bvh", "sweep_and_prune", "literature", "embree_collide", "boost_rtree",
        "fcl_dynamic_aabb_tree_array", "bullet_dbvt", "cgal_box_intersection", "packed_spatial_index", "parry_bvh",
        "obvhs_bvh")
FAST_IN = {2: ("geo_index", "box2d3_tree"), 3: ("box3d_tree", "physx_abp")}

GROUPS = {
    "few": "uniform, 100 to 3,000 boxes",
    "uniform": "uniform, 10,000 boxes",
    "many": "uniform, 100,000 and 1,000,000 boxes",
    "spread": "spread otherwise, up to 10,000 boxes",
    "real": "a mesh and two maps",
    "joined": "two sets",
    "filtered": "with filters",
    "moving": "moving by a rule",
    "recorded": "recorded from engines",
}

EFFORT = {"budget_seconds": 0.25, "history_seconds": 1, "share_seconds": 0.1, "min_rounds": 5, "max_rounds": 100,
          "slow_seconds": 0.05, "slow_history_seconds": 0.4, "slow_rounds": 3}
QUICK_EFFORT = {**EFFORT, "share_seconds": 0.01, "min_rounds": 2, "slow_seconds": 0.01, "slow_rounds": 1}
EFFORT_OF_A_MILLION = {"budget_seconds": 4, "slow_rounds": 2}


@dataclass(frozen=True)
class Compared(Case):
    """A case of the comparison: its group, and its place on the curves of uniform boxes."""

    group: str = ""
    number: int | None = None
    density: float | None = None


def cases() -> list[Compared]:
    return [*uniform(), *spread_otherwise(), *real(), *joined(), *filtered(), *moving()]


def uniform() -> Iterator[Compared]:
    for dimension in (2, 3):
        for number in NUMBERS:
            most = number == NUMBERS[-1]
            yield Compared(f"uniform, {dimension}D, {number:,} boxes", "uniform:neighbours=4",
                           (*FAST, *FAST_IN[dimension]) if most else ("all",), number, dimension,
                           group="few" if number < 10_000 else "uniform" if number == 10_000 else "many",
                           effort=EFFORT_OF_A_MILLION if most else {}, number=number,
                           density=4 if number == 10_000 else None)
        for density in DENSITIES:
            if density != 4:
                yield Compared(f"uniform with {density:g} neighbours, {dimension}D, 10,000 boxes",
                               f"uniform:neighbours={density:g}", ("all",), 10_000, dimension, group="uniform",
                               density=density)


def spread_otherwise() -> Iterator[Compared]:
    for scene, words in {"power_law": "sizes by a power law", "mixed": "one in a hundred huge",
                         "clustered": "clustered", "one_line": "all on one line", "lattice": "touching on a lattice",
                         "thin": "long and thin", "terdiman": "Terdiman's scene",
                         "one_point": "all over one point"}.items():
        boxes = 2_000 if scene == "one_point" else 10_000
        for dimension in (2, 3):
            yield Compared(f"{words}, {dimension}D, {boxes:,} boxes", scene, ("all",), boxes, dimension,
                           group="spread")


def real() -> Iterator[Compared]:
    for scene, words, dimension in (
            ("bunny", "triangles of a mesh, seen from one side", 2), ("bunny", "triangles of a mesh", 3),
            ("counties", "counties", 2), ("counties:boxes=segments", "segments of counties", 2),
            ("coastlines", "coastlines", 2), ("coastlines:boxes=segments", "segments of coastlines", 2)):
        yield Compared(f"{words}, {dimension}D", scene, ("all",), None, dimension, group="real")


def joined() -> Iterator[Compared]:
    for dimension in (2, 3):
        for number in (1_000, 10_000, 100_000):
            yield Compared(f"uniform halves, {dimension}D, {number:,} boxes", "uniform", ("all",), number, dimension,
                           left=0.5, group="joined")
    for scene, words, dimension in (("counties", "counties", 2), ("bunny", "triangles of a mesh", 3)):
        yield Compared(f"a tenth of {words} with the others, {dimension}D", scene, ("all",), None, dimension, left=0.1,
                       group="joined")


def filtered() -> Iterator[Compared]:
    for dimension in (2, 3):
        for number in (1_000, 10_000):
            yield Compared(f"uniform with filters, {dimension}D, {number:,} boxes", "uniform", ("all",), number,
                           dimension, filtered=True, group="filtered")


def moving() -> Iterator[Compared]:
    for boxes, share, frames in ((1_000, 1, 20), (10_000, 0.01, 10), (10_000, 1, 10), (100_000, 0.1, 5)):
        for dimension in (2, 3):
            yield Compared(f"uniform, {dimension}D, {boxes:,} boxes, {share:.0%} moving".replace("%", " %"),
                           "uniform", ("all",), boxes, dimension, frames=frames, moving=share, group="moving")
    for scene, words, boxes, frames in (("churn", "coming and going", 1_000, 20),
                                        ("pile", "trembling in a pile", 2_000, 10)):
        for dimension in (2, 3):
            yield Compared(f"{words}, {dimension}D, {boxes:,} boxes", scene, ("all",), boxes, dimension,
                           frames=frames, group="moving")
    for scene, words, dimension in (("box2d_rain", "rain in Box2D", 2), ("box2d_tumbler", "a tumbler in Box2D", 2),
                                    ("box2d_pyramid", "a pyramid in Box2D", 2),
                                    ("bullet_free_fall", "free fall in Bullet", 3),
                                    ("bullet_moving_gravity", "moving gravity in Bullet", 3)):
        yield Compared(f"{words}, {dimension}D, 1,000 boxes", scene, ("all",), 1_000, dimension, frames=30,
                       group="recorded")


COMPARISON = Experiment(title="The comparison with other libraries", measured="Times of all algorithms.", claims=(),
                        cases=cases, judge=lambda results, rules: (), figures=lambda results, rules: (),
                        name="comparison")

# The fields kept of a measurement. Samples are not kept: each process has several hundred thousand.
KEPT = ("case", "scene_parameters", "seeds", "dimension", "boxes", "frames", "moving", "drift", "algorithm", "version",
        "kind", "target", "pairs", "verified", "verified_by", "skipped", "rounds", "median_ms", "p99_ms", "unsteady",
        "floor_ms")


def kept(results: dict) -> dict:
    """Results without samples. A measurement's `ratio` is its time over that of the case's fastest in this process, in
    their common rounds; the quotient of two ratios is the ratio of the two algorithms' times."""
    measurements = []
    for measured in results["measurements"]:
        one = {name: measured.get(name) for name in KEPT}
        one["seeds"] = len(measured["seeds"])
        if measured["ratio_to_fastest"] is not None:
            one["ratio"] = measured["ratio_to_fastest"]["median"]
        measurements.append({name: float(f"{value:.5g}") if isinstance(value, float) else value
                             for name, value in one.items() if value is not None or name in ("verified", "unsteady")})
    return {**results, "measurements": measurements}


class MeasuringComparison(Measuring):
    """Measures processes of the comparison."""

    effort = EFFORT
    quick_effort = QUICK_EFFORT

    def results_of(self, run: int, experiment: Experiment) -> dict:
        return kept(super().results_of(run, experiment))
