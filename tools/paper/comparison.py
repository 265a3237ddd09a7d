"""The comparison with other libraries: the results of its processes, as facts, tables and figures.

A lead is a rival's time over ours, in the same rounds; its interval is between the processes.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path

import numpy
import pandas

from . import figures
from .archive import Archive
from .comparison_cases import COMPARISON, DENSITIES, GROUPS, NUMBERS, Compared
from .experiment import Unusable
from .figures import COLOURS, Figure
from .results import Results
from .rules import RuleBook
from .statistics import Estimate, between_runs, digits
from .tables import Table

# Debian compiles these libraries with assertions (docs/peers.md).
WITH_ASSERTIONS = ("box2d", "embree", "fcl")
KINDS = {"own": "ours", "paper": "the draft's", "literature": "the literature's", "peer": "a library's"}
LIBRARIES = {"cgal": "CGAL", "boost": "Boost", "geos": "GEOS", "embree": "Embree", "bullet": "Bullet", "ode": "ODE",
             "fcl": "FCL", "box2d": "Box2D 2.4", "chipmunk": "Chipmunk", "packed": "packed spatial index",
             "geo": "geo-index", "rstar": "rstar", "parry": "parry", "rapier": "Rapier", "obvhs": "obvhs",
             "box2d3": "Box2D 3", "box3d": "Box3D", "physx": "PhysX"}
# The rivals of a lead, by kind and algorithm.
RIVALS: dict[str, Callable[[str, str], bool]] = {
    "peer": lambda kind, algorithm: kind == "peer",
    "literature": lambda kind, algorithm: kind == "literature",
}
OURS = ("auto", "best")  # what users call; the fastest of our others, chosen after timing


def library_of(algorithm: str) -> str:
    return algorithm.split("_", 1)[0]


@dataclass(frozen=True, eq=False)
class Lead:
    """The ratio of a rival's time to ours in a case."""

    case: Compared
    ours: str
    rival: str
    ratio: Estimate
    ours_ms: Estimate
    rival_ms: Estimate


class Leads:
    """Leads of several cases, classified by comparing their intervals with the rules' level."""

    def __init__(self, leads: Sequence[Lead], level: float, confidence: float):
        self.all = list(leads)
        self._confidence = confidence
        self.won = [lead for lead in leads if lead.ratio.is_above(level)]
        self.lost = [lead for lead in leads if lead.ratio.is_below(1 / level)]
        self.level = [lead for lead in leads if lead.ratio.is_above(1 / level) and lead.ratio.is_below(level)]
        self.open = [lead for lead in leads if lead not in self.won + self.lost + self.level]
        self.behind = [lead for lead in leads if lead.ratio.value < 1]  # whatever the interval says

    @cached_property
    def mean(self) -> Estimate | None:
        """The geometric mean, taken within each process first, because a disturbance slows a process in many cases."""
        if not self.all:
            return None
        of_runs = numpy.exp(numpy.mean(numpy.log([lead.ratio.runs for lead in self.all]), axis=0))
        return between_runs(of_runs, self._confidence)

    @property
    def least(self) -> Lead:
        return min(self.all, key=lambda lead: lead.ratio.value)

    @property
    def greatest(self) -> Lead:
        return max(self.all, key=lambda lead: lead.ratio.value)


class Times:
    """The results of all processes: times and ratios, and the fastest in each case."""

    def __init__(self, results: Results, level: float):
        self.confidence = results.confidence
        self.level = level
        self.processes = len(results.runs)
        self.table = pandas.concat([run.table for run in results.runs], keys=range(self.processes), names=["run"])
        by_case = self.table.groupby(level=["case", "algorithm"], sort=False)
        self.measured = by_case.first()
        self.measured["unsteady"] = by_case["unsteady"].agg(lambda values: values.dropna().astype(float).mean() > 0.5)
        self.kinds = dict(zip(self.measured["algorithm"], self.measured["kind"]))
        self._columns = {name: {key: values.to_numpy(dtype=float) for key, values in by_case[name]}
                         for name in ("ratio", "median_ms", "p99_ms", "floor_ms")}
        # Only algorithms with a time in every process: one that was too slow in some process is fastest nowhere.
        self._ratio = {key: values for key, values in self._columns["ratio"].items()
                       if len(values) == self.processes and numpy.isfinite(values).all()}
        self._ranked: dict[str, list[str]] = {}
        for case, algorithm in sorted(self._ratio, key=lambda key: numpy.log(self._ratio[key]).mean()):
            self._ranked.setdefault(case, []).append(algorithm)

    def timed(self, case: str, is_one: Callable[[str, str], bool] = lambda kind, algorithm: True) -> list[str]:
        """The algorithms with a time that match, the fastest first: one order for all processes."""
        return [one for one in self._ranked.get(case, []) if is_one(self.kinds[one], one)]

    def fastest(self, case: str, is_one: Callable[[str, str], bool]) -> str | None:
        return next(iter(self.timed(case, is_one)), None)

    @cache
    def time(self, case: str, algorithm: str, column: str = "median_ms") -> Estimate:
        return between_runs(self._columns[column][case, algorithm], self.confidence, "ms")

    @cache
    def over(self, case: str, algorithm: str, other: str) -> Estimate:
        """The ratio of one time to the other."""
        return between_runs(self._ratio[case, algorithm] / self._ratio[case, other], self.confidence)

    def ours(self, case: str, which: str) -> str | None:
        """`auto`, or the best of our others; empty in a case that lacks them."""
        return self.fastest(case, lambda kind, algorithm: kind == "own" and (algorithm == "auto") == (which == "auto"))

    def lead(self, case: Compared, which: str, rival: str) -> Lead | None:
        return self.lead_over(case, self.ours(case.name, which), self.fastest(case.name, RIVALS[rival]))

    def lead_over(self, case: Compared, ours: str | None, rival: str | None) -> Lead | None:
        if ours is None or rival is None:
            return None
        return Lead(case, ours, rival, self.over(case.name, rival, ours), self.time(case.name, ours),
                    self.time(case.name, rival))

    def leads(self, cases: Iterable[Compared], which: str, rival: str) -> Leads:
        return self.those(self.lead(case, which, rival) for case in cases)

    def those(self, leads: Iterable[Lead | None]) -> Leads:
        return Leads([lead for lead in leads if lead is not None], self.level, self.confidence)

    def mean_over_fastest(self, timed: Sequence[tuple[str, str]]) -> Estimate:
        """The geometric mean, over cases each with an algorithm, of its time over that of the case's fastest."""
        return between_runs(numpy.exp(numpy.mean([
            numpy.log(self._ratio[case, algorithm] / self._ratio[case, self._ranked[case][0]])
            for case, algorithm in timed], axis=0)), self.confidence)

    def standings(self, cases: Sequence[Compared]) -> list[tuple[str, Estimate, int, int]]:
        """For each algorithm, the geometric mean of its time over that of each case's fastest, the number of cases in
        which it has a time, and in how many it is the fastest; the best first."""
        by_algorithm: dict[str, list[tuple[str, str]]] = {}
        for case in cases:
            for algorithm in self.timed(case.name):
                by_algorithm.setdefault(algorithm, []).append((case.name, algorithm))
        wins = Counter(self.timed(case.name)[0] for case in cases if self.timed(case.name))
        found = [(name, self.mean_over_fastest(timed), len(timed), wins[name]) for name, timed in by_algorithm.items()]
        return sorted(found, key=lambda standing: standing[1].value)


@dataclass(frozen=True)
class Comparison:
    """The names for templates: facts, formatted with their intervals; tables; figures."""

    facts: Mapping[str, str | bool]
    tables: Mapping[str, Table]
    figures: Sequence[Figure]


def read(folder: Path) -> tuple[Times, list[dict]]:
    """The times, and the metadata of each process."""
    book = RuleBook()
    results, runs = Archive(folder).results(COMPARISON, book)
    return Times(results, book.of(COMPARISON.name).level), runs


def load(folder: Path) -> Comparison:
    """The processes in a folder. Raises Unusable, in one line, if there are none, if they differ in revision or
    machine, if their cases or rules are not today's, or if a result was wrong."""
    times, runs = read(folder)
    cases = [case for case in COMPARISON.cases() if times.timed(case.name)]
    if not times.leads(cases, "auto", "peer").all:
        raise Unusable(f"{folder} has no case with times of auto and of a peer; expected one at least")
    groups = {"all": cases, **{name: [case for case in cases if case.group == name] for name in GROUPS}}
    leads = {(group, which, rival): times.leads(those, which, rival)
             for group, those in groups.items() for which in OURS for rival in RIVALS}
    tables = {
        "groups": groups_table(leads),
        "numbers": curve_table(times, cases, "number", NUMBERS, "boxes:"),
        "densities": curve_table(times, cases, "density", DENSITIES, "neighbours:"),
        "rest": cases_table(times, [case for case in cases if not case.frames]),
        "moving": cases_table(times, [case for case in cases if case.frames]),
        "behind": leads_table(leads["all", "auto", "peer"].behind + leads["all", "auto", "literature"].behind),
        "standings": standings_table(times, cases),
        "scenes": scenes_table(times, cases),
        "processes": processes_table(runs),
    }
    return Comparison(facts_of(times, cases, leads, runs), tables, [
        mean_leads_figure(leads), *leads_figures(leads), curves_figure(times, cases), libraries_figure(times, cases)])


def facts_of(times: Times, cases: Sequence[Compared], leads: Mapping[tuple, Leads],
             runs: Sequence[Mapping]) -> dict[str, str | bool]:
    """By name: "moving.auto.literature.mean" is the mean lead of auto over the literature's, where boxes move by a
    rule; mean, least, greatest, won, lost, level, open and behind of each group, ours and rival."""
    facts: dict[str, str | bool] = {}
    for (group, which, rival), those in leads.items():
        facts |= {f"{group}.{which}.{rival}.{name}": fact for name, fact in facts_of_leads(those).items()}
    choices = times.those(times.lead_over(case, times.ours(case.name, "best"), times.ours(case.name, "auto"))
                          for case in cases)
    over_peers = {kind: leads_over_peers(times, cases, kind) for kind in ("literature", "paper")}
    rival = max(over_peers["literature"], key=lambda name: len(over_peers["literature"][name].won), default="none")
    rival_leads = over_peers["literature"].get(rival, times.those([]))
    listings = {lead.case.name for those in over_peers["paper"].values() for lead in those.won}
    table, machine, build = times.table, runs[0]["machine"], runs[0]["build"]
    timed = table[table["median_ms"].notna()]
    agreeing = timed["verified_by"].astype(str).str.extract(r"by (\d+) structures? of (\d+)").dropna().astype(int)
    floors = [ratio for case in cases if (best := times.ours(case.name, "best")) and not numpy.isnan(
        ratio := times.time(case.name, best).value / times.time(case.name, best, "floor_ms").value)]
    dates = sorted(run["date"][:10] for run in runs)
    return facts | {
        "cases": f"{len(cases):,}",
        "cases_at_rest": f"{sum(not case.frames for case in cases):,}",
        "cases_moving": f"{sum(bool(case.frames) for case in cases):,}",
        "processes": f"{len(runs)}",
        "busy": f"{sum(run['busy'] for run in runs)}",
        "measurements": f"{len(timed):,}",
        "skipped": f"{len(table) - len(timed):,}",
        "unsteady": f"{sum(run['unsteady'] for run in runs):,}",
        "level": f"{times.level:g}",
        "minutes": digits(sum(run["seconds"] for run in runs) / len(runs) / 60),
        "checked.by_definition": f"{(timed['verified_by'] == 'by definition').sum():,}",
        "checked.by_others": f"{len(agreeing):,}",
        "checked.least_structures": f"{agreeing[0].min()}" if len(agreeing) else "0",
        "checked.least_libraries": f"{agreeing[1].min()}" if len(agreeing) else "0",
        "algorithms.peer": f"{table[table['kind'] == 'peer']['algorithm'].nunique()}",
        "algorithms.literature": f"{table[table['kind'] == 'literature']['algorithm'].nunique()}",
        "choice.mean": choices.mean.text(), "choice.worst": choices.greatest.ratio.text(),
        "choice.worst_case": choices.greatest.case.name,
        **{f"rival.{name}": fact for name, fact in facts_of_leads(rival_leads).items()}, "rival": rival,
        "listings.won": f"{len(listings)}",
        "floor.least": digits(min(floors)) if floors else "-",
        "floor.greatest": digits(max(floors)) if floors else "-",
        "date": dates[0] if dates[0] == dates[-1] else f"{dates[0]} to {dates[-1]}",
        "processor": f"{machine.get('cpu') or 'a processor'} with {machine.get('cores') or 'some'} cores",
        "instruction_set": next(iter(table["target"].dropna()), "unknown") if "target" in table else "unknown",
        "system": machine.get("os") or "an unknown system",
        "compiler": build["compiler"], "revision": build.get("revision") or "unknown",
        **{f"version.{one['algorithm']}": one["version"] for _, one in times.measured.reset_index(drop=True).iterrows()
           if one["kind"] == "peer"},
    }


def facts_of_leads(those: Leads) -> dict[str, str | bool]:
    facts: dict[str, str | bool] = {"cases": f"{len(those.all)}", "any": bool(those.all)}
    for name in ("won", "lost", "level", "open", "behind"):
        found = getattr(those, name)
        facts |= {name: f"{len(found)}", f"any_{name}": bool(found), f"{name}_named": named(found)}
    facts["mean"] = those.mean.text() if those.mean else "-"
    for name in ("least", "greatest"):
        lead = getattr(those, name) if those.all else None
        facts |= {name: lead.ratio.text() if lead else "-", f"{name}_case": lead.case.name if lead else "-",
                  f"{name}_rival": lead.rival if lead else "-"}
    return facts


def named(leads: Sequence[Lead]) -> str:
    """ "trembling in a pile, 2D, 2,000 boxes: 0.84 (0.79 to 0.86) against box2d_tree; ..." """
    return "; ".join(f"{lead.case.name}: {lead.ratio.text()} against `{lead.rival}`" for lead in leads) or "none"


def leads_over_peers(times: Times, cases: Sequence[Compared], kind: str) -> dict[str, Leads]:
    """The leads of each algorithm of a kind over the fastest peer."""
    found: dict[str, list[Lead | None]] = {}
    for case in cases:
        peer = times.fastest(case.name, RIVALS["peer"])
        for algorithm in times.timed(case.name, lambda its_kind, _: its_kind == kind):
            found.setdefault(algorithm, []).append(times.lead_over(case, algorithm, peer))
    return {name: times.those(leads) for name, leads in found.items()}


def groups_table(leads: Mapping[tuple, Leads]) -> Table:
    """The leads of auto over the fastest peer and the literature's fastest, a line for each group of cases."""
    def cells(those: Leads) -> list[str]:
        return [those.mean.text(), those.least.ratio.text(),
                f"{len(those.lost)} / {len(those.level)} / {len(those.open)}"] if those.all else ["-"] * 3
    rows = [[words, str(len(leads[group, "auto", "peer"].all)), *cells(leads[group, "auto", "peer"]),
             *cells(leads[group, "auto", "literature"])]
            for group, words in {**GROUPS, "all": "all"}.items() if leads[group, "auto", "peer"].all]
    heads = [f"{whose}, {what}:" for whose in ("library", "literature")
             for what in ("mean", "least", "lost / level / open")]
    return Table(["cases", "how many:", *heads], rows)


def curve_table(times: Times, cases: Sequence[Compared], what: str, values: Sequence[float], heading: str) -> Table:
    """The leads of auto on uniform boxes."""
    def cell(value: float, dimension: int, rival: str) -> str:
        lead = lead_at(times, cases, what, value, dimension, rival)
        return lead.ratio.text() if lead else "-"
    rows = [[f"{value:,}", *(cell(value, dimension, rival) for dimension in (2, 3)
                             for rival in ("peer", "literature"))] for value in values]
    return Table([heading, *(f"{dimension}D, over {whom}:" for dimension in (2, 3)
                             for whom in ("the fastest peer", "the literature"))], rows)


def lead_at(times: Times, cases: Sequence[Compared], what: str, value: float, dimension: int,
            rival: str) -> Lead | None:
    return next((times.lead(case, "auto", rival) for case in cases
                 if getattr(case, what) == value and case.dimension == dimension), None)


def cases_table(times: Times, cases: Sequence[Compared]) -> Table:
    """The times of auto, our best, the fastest peer and the fastest of the literature's, and auto's leads."""
    moves = any(case.frames for case in cases)

    def cell(case: Compared, algorithm: str | None, has_name: bool = True) -> str:
        if algorithm is None:
            return "-"
        measured = times.measured.loc[(case.name, algorithm)]
        has_assertions = measured["kind"] == "peer" and library_of(algorithm) in WITH_ASSERTIONS
        marks = "†" * bool(measured["unsteady"]) + "‡" * has_assertions
        slow = f", p99 {digits(times.time(case.name, algorithm, 'p99_ms').value)}" if moves else ""
        return f"{f'`{algorithm}` ' if has_name else ''}{digits(times.time(case.name, algorithm).value)}{slow}{marks}"

    def lead_cell(lead: Lead | None) -> str:
        if lead is None:
            return "-"
        return f"**{lead.ratio.text()}**" if lead.ratio.value < 1 else lead.ratio.text()

    rows = []
    for case in cases:
        peer, literature = (times.lead(case, "auto", rival) for rival in ("peer", "literature"))
        rows.append([case.name, cell(case, times.ours(case.name, "auto"), has_name=False),
                     cell(case, times.ours(case.name, "best")), cell(case, peer and peer.rival), lead_cell(peer),
                     cell(case, literature and literature.rival), lead_cell(literature)])
    return Table(["boxes", "`auto`, ms:", "best of our others, ms", "fastest peer, ms", "lead:",
                  "the literature's fastest, ms", "lead:"], rows)


def leads_table(leads: Sequence[Lead]) -> Table:
    return Table(["boxes", "ours", "ms:", "rival", "ms:", "lead:"],
                 [[lead.case.name, f"`{lead.ours}`", digits(lead.ours_ms.value), f"`{lead.rival}`",
                   digits(lead.rival_ms.value), lead.ratio.text()] for lead in leads])


def standings_table(times: Times, cases: Sequence[Compared]) -> Table:
    """Every algorithm over all cases, with the number of cases in which it is faster than auto."""
    rows = []
    for name, ratio, count, wins in times.standings(cases):
        of_auto = times.those(times.lead_over(case, "auto", name) for case in cases
                              if {"auto", name} <= set(times.timed(case.name)))
        against = f"{len(of_auto.lost)} / {len(of_auto.level)} / {len(of_auto.open)} / {len(of_auto.won)}"
        rows.append([f"`{name}`", KINDS.get(times.kinds[name], times.kinds[name]), str(count), str(wins), ratio.text(),
                     "-" if name == "auto" else against])
    return Table(["algorithm", "whose", "cases:", "fastest in:", "time over the fastest's:",
                  "faster than `auto` / level / open / slower:"], rows)


def scenes_table(times: Times, cases: Sequence[Compared]) -> Table:
    """How each case's boxes are made."""
    rows = []
    for case in cases:
        one = times.measured.loc[case.name].iloc[0]
        motion = f"{one['frames']:.0f} frames, {one['moving']:.2g} moving" if case.frames else ""
        pairs = times.measured.loc[case.name]["pairs"].max()
        parameters = ", ".join(f"{name} {value}" for name, value in one["scene_parameters"].items())
        rows.append([case.name, f"`{case.scene}`", parameters, f"{one['boxes']:,.0f}",
                     digits(2 * pairs / one["boxes"]), f"{one['seeds']:.0f}", motion])
    return Table(["boxes", "scene", "parameters", "how many:", "overlaps of a box:", "seeds:", "motion"], rows)


def processes_table(runs: Sequence[Mapping]) -> Table:
    """Every process, including those on a busy machine, with its metadata."""
    def load(value: float | None) -> str:
        return "unknown" if value is None else f"{value:.1f}"
    return Table(["process:", "date", "minutes:", "share of a processor:", "load before:", "after:", "unsteady:"],
                 [[str(run["run"]), run["date"][:10], digits(run["seconds"] / 60),
                   f"{run['processor_share']:.0%}{' (busy)' if run['busy'] else ''}", load(run["load_before"]),
                   load(run["load_after"]), f"{run['unsteady']} of {run['measurements']}"] for run in runs])


def lines_figure(name: str, caption: str, series: Mapping[str, Mapping[str, Estimate]], rows: Sequence[str],
                 x: str) -> Figure:
    """A line for each row, with a dot for each series that has a value there."""
    drawing, (axes,) = figures.new(height=0.9 + 0.19 * len(rows) * max(1, len(series) / 3))
    for number, (label, estimates) in enumerate(series.items()):
        shown = [row for row in rows if row in estimates]
        step = 0.6 * (number / max(len(series) - 1, 1) - 0.5) if len(series) > 1 else 0
        at = [estimates[row] for row in shown]
        bars = numpy.abs(numpy.nan_to_num([[one.value - one.low, one.high - one.value] for one in at])).T
        axes.errorbar([one.value for one in at], [rows.index(row) + step for row in shown], xerr=bars, label=label,
                      fmt=figures.MARKERS[number], color=COLOURS[number], capsize=2, elinewidth=0.8)
    axes.axvline(1, color="black", linewidth=0.8)
    axes.set_yticks(range(len(rows)), rows)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    figures.label(axes, x, "", log="x")
    if len(series) > 1:
        figures.legend(axes, is_shared=True)
    return Figure(name, caption, drawing)


def mean_leads_figure(leads: Mapping[tuple, Leads]) -> Figure:
    rows = [words for group, words in {**GROUPS, "all": "all"}.items() if leads[group, "auto", "peer"].all]
    names = {words: group for group, words in {**GROUPS, "all": "all"}.items()}
    series = {f"our {'own choice' if which == 'auto' else 'best'}, over {whom}":
              {row: those.mean for row in rows if (those := leads[names[row], which, rival]).all}
              for rival, whom in (("peer", "libraries"), ("literature", "the literature")) for which in OURS}
    return lines_figure("comparison_groups", "How many times as fast ours are, by group of cases: geometric means, "
                        "with 95% intervals between processes. At 1 a rival is as fast.", series, rows,
                        "times as fast")


def leads_figures(leads: Mapping[tuple, Leads]) -> Iterable[Figure]:
    for name, words, is_shown in (("rest", "Boxes at rest, but for uniform ones",
                                   lambda case: not case.frames and case.group not in ("few", "uniform", "many")),
                                  ("moving", "Boxes that move", lambda case: bool(case.frames))):
        series = {whom: {lead.case.name: lead.ratio for lead in leads["all", "auto", rival].all if is_shown(lead.case)}
                  for rival, whom in (("peer", "over the fastest library"),
                                      ("literature", "over the literature's fastest"))}
        rows = list(dict.fromkeys(row for those in series.values() for row in those))
        if rows:
            yield lines_figure(f"comparison_{name}", f"{words}: how many times as fast our own choice is, case by "
                               "case, with 95% intervals between processes.", series, rows, "times as fast")


def curves_figure(times: Times, cases: Sequence[Compared]) -> Figure:
    drawing, (left, right) = figures.new(2)
    for axes, what, values in ((left, "number", NUMBERS), (right, "density", DENSITIES)):
        for rival, whom in (("peer", "over libraries"), ("literature", "over the literature")):
            for dimension in (2, 3):
                at = {value: lead_at(times, cases, what, value, dimension, rival) for value in values}
                at = {value: lead for value, lead in at.items() if lead}
                if at:
                    figures.line(axes, list(at), [lead.ratio for lead in at.values()], f"{dimension}D, {whom}")
        axes.axhline(1, color="black", linewidth=0.8)
    figures.label(left, "boxes", "times as fast")
    figures.label(right, "others that a box overlaps", "")
    left.set_xticks(NUMBERS[::2])
    figures.legend(left, is_shared=True)
    return Figure("comparison_curves", "How many times as fast our own choice is on uniform boxes, by their number "
                  "and, for 10,000, by their density. Bars: 95% intervals between processes.", drawing)


def libraries_figure(times: Times, cases: Sequence[Compared]) -> Figure:
    """Auto, and the fastest algorithm of each library and of the literature in each case: for a dimension, all over the
    same cases. A library that does fewer than half of a dimension's cases is left out there."""
    def words(kind: str, algorithm: str) -> str | None:
        return {"own": "our own choice" if algorithm == "auto" else None, "literature": "the literature's fastest",
                "peer": LIBRARIES.get(library_of(algorithm), library_of(algorithm))}.get(kind)

    series: dict[str, dict[str, Estimate]] = {}
    for dimension in (2, 3):
        fastest = {case.name: {} for case in cases if case.dimension == dimension and times.timed(case.name)}
        for case, found in fastest.items():
            for algorithm in times.timed(case):
                if whose := words(times.kinds[algorithm], algorithm):
                    found.setdefault(whose, algorithm)
        count = Counter(whose for found in fastest.values() for whose in found)
        shown = [whose for whose, number in count.items() if number >= len(fastest) / 2]
        shared = {case: found for case, found in fastest.items() if all(whose in found for whose in shown)}
        if shared:
            series[f"{dimension}D, {len(shared)} cases"] = {
                whose: times.mean_over_fastest([(case, found[whose]) for case, found in shared.items()])
                for whose in shown}
    least = {whose: min(means[whose].value for means in series.values() if whose in means)
             for means in series.values() for whose in means}
    return lines_figure("comparison_libraries", "Time as a multiple of the fastest algorithm's in each case: our own "
                        "choice, and the fastest algorithm of each library. Geometric means, of a dimension all over "
                        "the same cases: those that all libraries shown there do within their budget. Bars: 95% "
                        "intervals between processes.", series, sorted(least, key=least.get),
                        "times the time of the fastest")


def disagreements(first: Path, second: Path) -> list[str]:
    """Leads of auto that are won in one set of processes and lost in the other. There should be none."""
    sets = [{rival: times.leads(COMPARISON.cases(), "auto", rival) for rival in RIVALS}
            for times in (read(first)[0], read(second)[0])]
    def names(leads: Sequence[Lead]) -> set[str]:
        return {lead.case.name for lead in leads}
    return [f"{case} over {rival}" for rival in RIVALS for one, other in (sets, reversed(sets))
            for case in sorted(names(one[rival].won) & names(other[rival].lost))]
