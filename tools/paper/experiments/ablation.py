"""Our own claim: how much of the speedup of our fastest searches comes from SIMD."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import log

from .. import figures
from ..experiment import Case, Claim, Experiment
from ..judge import Finding, judged
from ..results import Results
from ..rules import Rules
from ..statistics import Estimate

BOXES = 100_000
SCENES = ("uniform", "clustered")
DIMENSIONS = (2, 3)

# The same structures, written plainly and compiled without SIMD, and the parts that can be left out of each. The first
# two are the memory layout of boxes and the way hits are written, where SIMD may need what plain code does not.
LAYOUT = {"arrays": "an array of boxes", "branch_free": "a branch at each test"}
SWITCHES = {
    "grid": {**LAYOUT, "buckets": "sorting by comparisons in each cell", "carry": "a copy in each cell",
             "sample": "no sample"},
    "bvh": {**LAYOUT, "buckets": "sorting by comparisons to pack", "join": "a query for each box"},
}
SEARCHES = {"grid": "grid", "bvh": "tree of bounds"}


def plain(search: str, *left_out: str) -> str:
    return f"plain_{search}" + "".join(f":{switch}=no" for switch in left_out)


def plain_forms(search: str) -> list[str]:
    """The same structure with each memory layout and each way to write hits."""
    return [plain(search), plain(search, "arrays"), plain(search, "branch_free"), plain(search, *LAYOUT)]


def nothing(search: str) -> str:
    return plain(search, *SWITCHES[search])


def scalar(search: str) -> str:
    return f"held_back:search={search}:simd=SCALAR"


def case_of(search: str, scene: str, dimension: int) -> str:
    return f"our {SEARCHES[search]} on {scene} boxes in {dimension}D"


def specs(search: str) -> list[str]:
    one_less = [plain(search, switch) for switch in SWITCHES[search]]
    return list(dict.fromkeys([search, scalar(search), *plain_forms(search), *one_less, nothing(search)]))


PLACES = [(search, scene, dimension) for search in SEARCHES for scene in SCENES for dimension in DIMENSIONS]


def cases() -> list[Case]:
    return [Case(case_of(search, scene, dimension), scene, specs(search), boxes=BOXES, dimension=dimension)
            for search, scene, dimension in PLACES]


def share(results: Results, case: str, search: str, plainly: str) -> Estimate:
    """As a share of the whole speedup: factors multiply, so shares are of logarithms."""
    return results.between(lambda run: log(run.ratio(case, plainly, search)) /
                           log(run.ratio(case, nothing(search), search)))


def judge(results: Results, rules: Rules) -> Sequence[Finding]:
    """Judges by the fastest scalar code: anything else it lacks besides SIMD would be counted as SIMD's gain."""
    shares, beside = {}, {}
    for place in PLACES:
        search, case = place[0], case_of(*place)
        plainly = results.fastest(case, plain_forms(search))
        shares[f"SIMD in {case}"] = share(results, case, search, results.fastest(case, [plainly, scalar(search)]))
        beside[f"share by the fastest plain form, {case}"] = share(results, case, search, plainly)
        for one, words in ((plainly, "the fastest plain form"), (nothing(search), "the plainest form"),
                           (scalar(search), "the library held to its scalar target")):
            beside[f"{words} over the library, {case}"] = results.ratio(case, one, search)
    return [judged("B2", shares, above=rules.most_of_the_gain, where="it is {}", beside=beside)]


def draw(results: Results, rules: Rules) -> Iterator[figures.Figure]:
    for search, name in SEARCHES.items():
        forms = {scalar(search): "its scalar target", plain(search): "plain"}
        forms |= {plain(search, switch): f"plain, {words}" for switch, words in LAYOUT.items()}
        forms |= {plain(search, *LAYOUT): "plain, both of these"}
        forms |= {plain(search, switch): f"plain, {words}" for switch, words in SWITCHES[search].items()
                  if switch not in LAYOUT}
        forms |= {nothing(search): "plain, all of these"}
        drawing, columns = figures.new(columns=2, height=2.4)
        for axes, dimension in zip(columns, DIMENSIONS):
            for scene in SCENES:
                case = case_of(search, scene, dimension)
                figures.line(axes, [results.ratio(case, one, search) for one in forms], range(len(forms)), scene,
                             joined=False)
            axes.set_yticks(range(len(forms)), forms.values() if axes is columns[0] else [])
            figures.label(axes, "time over the library's", "", f"in {dimension}D", log="x")
            axes.invert_yaxis()
        figures.legend(columns[1], is_shared=True)
        yield figures.Figure(f"ablation_{search}", f"Our {name} without SIMD, on {BOXES:,} boxes: held to its scalar "
                             "target; in plain code; and in plain code with each of the named things changed, which "
                             "are explained in the text. Bars: 95% intervals between runs.", drawing)


EXPERIMENT = Experiment(
    title="What makes the fastest searches fast",
    measured=f"Our grid and our tree of bounds on {BOXES:,} uniform and clustered boxes, in the plane and in space; "
             "the same structures in plain code without SIMD, with one thing after the other left out, and all; and "
             "the library held to its scalar target, which is SIMD's code with one lane and no plain code.",
    claims=[Claim("B2", "Of the whole gain over the plainest form, by logarithms, more than {most_of_the_gain} is "
                  "the gain over the fastest scalar code of the same structure, be it a plain form or the library's "
                  "code for one lane, for grid and tree of bounds on both scenes in the plane and in space.",
                  "It is less than that in all of these.")],
    cases=cases, judge=judge, figures=draw)
