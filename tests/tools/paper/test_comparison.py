"""What the comparison's processes come to, on results that are made by a model."""

import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy
from matplotlib import pyplot
from matplotlib.text import Text

from tools.paper import comparison, figures
from tools.paper.archive import Archive
from tools.paper.comparison import load
from tools.paper.comparison_cases import COMPARISON, EFFORT, kept
from tools.paper.experiment import Unusable
from tools.paper.rules import RuleBook

PROGRAM = os.environ.get("BROADSIDE_PROGRAM")
KINDS = {"auto": "own", "grid": "own", "terdiman_box_pruning": "literature", "paper_grid": "paper",
         "boost_rtree": "peer", "box2d_tree": "peer"}
PILE = "trembling in a pile, 2D, 2,000 boxes"
LATTICE = "touching on a lattice, 2D, 10,000 boxes"


def model(case: str, algorithm: str) -> float:
    """Milliseconds; 0: skipped. box2d_tree wins in the pile, and boost_rtree is level on the lattice."""
    times = {"auto": 1.05, "grid": 1, "terdiman_box_pruning": 2, "paper_grid": 3, "boost_rtree": 5, "box2d_tree": 8}
    if case == PILE:
        times |= {"box2d_tree": 0.5}
    if case == LATTICE:
        times |= {"boost_rtree": 1.04}
    if "3D" in case:
        times |= {"box2d_tree": 0, "paper_grid": 0}
    return times[algorithm]


def results_of(process: int, revision: str = "abc", time=model, is_busy: bool = False) -> dict:
    """What `broadside measure` writes; all times are those of the model, give or take a little."""
    random = numpy.random.default_rng(process)
    measurements = []
    for case in COMPARISON.cases():
        slow = random.normal(1, 0.2)  # a process is slow in all
        times = {name: time(case.name, name) * slow * random.normal(1, 0.003) for name in KINDS}
        fastest = min(ms for ms in times.values() if ms)
        for name, ms in times.items():
            measurements.append({
                "case": case.name, "scene": case.scene, "scene_parameters": {"neighbours": "4"}, "seeds": [1, 2],
                "dimension": case.dimension, "boxes": case.boxes or 3000, "frames": case.frames or 0, "moving": 0.5,
                "drift": None, "teleport": None, "algorithm": name, "version": "Boost 1.74", "kind": KINDS[name],
                "target": "AVX2" if name == "grid" else None, "pairs": 6000, "verified": True if ms else None,
                "verified_by": "cross-checked by 3 structures of 2 libraries" if ms else None,
                "skipped": None if ms else "does not support 3D", "rounds": 8 if ms else 0, "median_ms": ms or None,
                "p99_ms": 2 * ms or None, "unsteady": False if ms else None, "floor_ms": None if case.frames else 0.5,
                "samples_ms": [ms] * 8,
                "ratio_to_fastest": {"of": "grid", "median": ms / fastest} if ms else None})
    return {"schema": "broadside.results/2", "date": "2026-11-26", "machine": {"cpu": "A processor", "cores": 2},
            "build": {"revision": revision, "compiler": "GNU 12"}, "processor_share": 0.8 if is_busy else 1.0,
            "busy": is_busy, "load_before": 0.1, "load_after": 1.1, "measurements": measurements}


class TheComparison(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(pyplot.close, "all")
        self.folder = Path(folder.name)

    def write(self, process: int, results: dict, folder: str = "") -> None:
        Archive(self.folder / folder).write(process, COMPARISON, RuleBook(), "program", False, 60, kept(results))

    def load(self, time=model, processes: int = 4) -> comparison.Comparison:
        for process in range(1, processes + 1):
            self.write(process, results_of(process, time=time, is_busy=process == 2))
        return load(self.folder)

    def test_says_where_a_peer_wins_where_it_is_level_and_how_far_ahead_ours_are(self):
        facts = self.load().facts
        self.assertEqual((facts["moving.auto.peer.lost"], facts["moving.auto.peer.cases"]), ("1", "12"))
        self.assertRegex(facts["moving.auto.peer.lost_named"], f"^{PILE}: 0.4[678].* against `box2d_tree`$")
        self.assertEqual((facts["spread.best.peer.level"], facts["spread.best.peer.lost"]), ("1", "0"))
        self.assertRegex(facts["spread.best.peer.level_named"], f"^{LATTICE}: 1.0[345]")
        self.assertRegex(facts["uniform.best.peer.mean"], r"^(5.0\d|4.9\d) \([45]\..* to 5\..*\)$")
        self.assertRegex(facts["recorded.auto.literature.mean"], r"^1.[89]")
        self.assertEqual(facts["real.auto.peer.least_rival"], "boost_rtree")
        self.assertRegex(facts["choice.mean"], "^1.0[456]")
        self.assertEqual((facts["rival"], facts["busy"], facts["processes"]), ("terdiman_box_pruning", "1", "4"))
        self.assertEqual(facts["checked.least_structures"], "3")

    def test_gives_intervals_between_processes_and_none_for_one(self):
        facts = self.load(processes=1).facts
        self.assertEqual(facts["uniform.auto.peer.won"], "0")
        self.assertEqual(facts["uniform.auto.peer.open"], facts["uniform.auto.peer.cases"])

    def test_counts_an_algorithm_that_was_too_slow_in_one_process_in_no_case_of_it(self):
        def slow(case: str, name: str) -> float:
            return 0 if name == "boost_rtree" and "clustered" in case else model(case, name)
        for process in (1, 2, 3):
            self.write(process, results_of(process, time=slow if process == 2 else model))
        table = load(self.folder).tables["rest"]
        row = next(row for row in table.rows if row[0].startswith("clustered, 2D"))
        self.assertIn("box2d_tree", row[3])
        row = next(row for row in table.rows if row[0].startswith("clustered, 3D"))
        self.assertEqual(row[3:5], ["-", "-"])

    def test_has_tables_of_all_and_figures_that_can_be_read(self):
        made = self.load()
        for table in made.tables.values():
            self.assertIn("|", table.markdown())
        standings = {row[0]: row for row in made.tables["standings"].rows}
        cases = len(list(COMPARISON.cases()))
        self.assertEqual(standings["`grid`"][2:4], [str(cases), str(cases - 1)])
        self.assertEqual(standings["`boost_rtree`"][5], f"0 / 1 / 0 / {cases - 1}")
        self.assertEqual([row[0] for row in made.tables["numbers"].rows][-2:], ["100,000", "1,000,000"])
        self.assertIn("(busy)", made.tables["processes"].rows[1][3])
        for figure in made.figures:
            figures.save(figure, self.folder / "figures")
        libraries = next(figure for figure in made.figures if figure.name == "comparison_libraries")
        words = {text.get_text() for text in libraries.drawing.findobj(Text)}
        for dimension in (2, 3):
            count = sum(case.dimension == dimension for case in COMPARISON.cases())
            self.assertIn(f"{dimension}D, {count} cases", words)

    def test_refuses_processes_that_do_not_go_together_or_are_wrong(self):
        self.write(1, results_of(1))
        self.write(2, results_of(2, revision="abd"))
        with self.assertRaisesRegex(Unusable, "its build is revision abd.*; expected revision abc.*, that of run 1"):
            load(self.folder)
        wrong = results_of(2)
        wrong["measurements"][0] |= {"verified": False, "skipped": "3 pairs; expected 4"}
        self.write(2, wrong)
        with self.assertRaisesRegex(Unusable, "auto is wrong in case .*; expected results that were verified"):
            load(self.folder)
        with self.assertRaisesRegex(Unusable, "has no run of comparison; expected one at least"):
            load(self.folder / "none")

    def test_says_which_leads_two_sets_of_processes_disagree_about(self):
        def other(case: str, name: str) -> float:
            return {LATTICE: 0.2, PILE: 3}.get(case, 8) if name == "box2d_tree" else model(case, name)
        for process in (1, 2, 3):
            self.write(process, results_of(process), "first")
            self.write(process, results_of(process, time=other), "second")
        first, second = self.folder / "first", self.folder / "second"
        self.assertEqual(comparison.disagreements(first, first), [])
        self.assertEqual(comparison.disagreements(first, second), [f"{PILE} over peer"])

    @unittest.skipUnless(PROGRAM, "BROADSIDE_PROGRAM is not set; expected the program")
    def test_lists_cases_that_the_program_takes(self):
        listed = subprocess.run([PROGRAM, "list"], capture_output=True, text=True, check=True).stdout
        known = re.findall(r"^  (\w+) +(?:own|peer) +[23]D", listed, re.MULTILINE)
        cases = [case.listed(1) for case in COMPARISON.cases() if case.scene.split(":")[0] not in
                 ("bunny", "counties", "coastlines")]  # those are of files
        for case in cases:  # this build may lack peers
            case["specs"] = [spec for spec in case["specs"] if spec in (*known, "all", "literature")]
        file = self.folder / "cases.json"
        file.write_text(json.dumps({"schema": "broadside.cases/1", "effort": EFFORT, "cases": cases}))
        ended = subprocess.run([PROGRAM, "measure", file, "--check"], capture_output=True, text=True, check=False)
        self.assertEqual(ended.returncode, 0, ended.stderr)


if __name__ == "__main__":
    unittest.main()
