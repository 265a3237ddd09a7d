"""Measuring: runs that are kept, resumed and refused; with a stand-in for the program, and with the program."""

import io
import json
import lzma
import os
import stat
import tempfile
import unittest
from contextlib import redirect_stderr
from pathlib import Path

from tools.paper import print as printing
from tools.paper.archive import Archive
from tools.paper.draft import DraftStatement
from tools.paper.experiment import Boxes, Case, Claim, Experiment, Unusable
from tools.paper.figures import Figure, label, line, new
from tools.paper.judge import judged
from tools.paper.rules import RuleBook
from tools.paper.run import Measuring, seed_of

PROGRAM = os.environ.get("BROADSIDE_PROGRAM")

# Answers as `broadside measure` does, and counts its calls in a file beside it.
STAND_IN = """#!/usr/bin/python3
import json, os, sys
with open("calls", "a") as calls: calls.write(sys.argv[2] + "\\n")
if os.path.exists("interrupted"): sys.exit(130)
if os.path.exists("refused"): sys.exit(2)
cases = json.load(open(sys.argv[2]))["cases"]
json.dump({"schema": "broadside.results/2", "date": "2026-11-26", "machine": {"cpu": "one", "clock_mhz": 1,
           "caches": {"L1d": 1024}}, "build": {"revision": REVISION}, "processor_share": 1, "busy": False,
           "load_before": 0, "load_after": 0, "measurements": [
             {"case": case["name"], "algorithm": spec, "boxes": 10, "frames": 0, "seeds": [case.get("seed", 1)],
              "samples_ms": [1.0, 1.1, 1.2, 1.3, 1.4], "tests_by_seed": [5], "references_by_seed": [10],
              "verified": VERIFIED, "skipped": None, "unsteady": False}
             for case in cases for spec in case["specs"]]}, open(sys.argv[4], "w"))
"""


def draw(results, rules):
    drawing, (axes,) = new()
    line(axes, [1, 2], [results.time("small", "paper_grid")] * 2, "the draft's grid")
    label(axes, "boxes", "milliseconds")
    yield Figure("small", "A small one.", drawing)


def corner(random):
    minima = random.uniform(0, 10, (50, 2))
    return [[x, y, x + 1, y + 1] for x, y in minima]


SMALL = Experiment(
    title="Small", measured="A few boxes.", claims=[Claim("1a", "More than {clearly}.", "Less.")],
    cases=lambda: [Case("small", "uniform", ["paper_grid", "grid"], boxes=200, seeds=2, take=["time", "phases"]),
                   Case("own", Boxes("corner", corner, inputs=2), ["grid"])],
    judge=lambda results, rules: [judged("1a", {"it": results.ratio("small", "paper_grid", "grid")},
                                         above=rules.clearly)],
    figures=draw, name="small")

STATEMENTS = {"1a": DraftStatement("1a", "II. Brute force", "Half | are left.", "claim")}


class Runs(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = Path(self.temporary.name)
        self.archive = Archive(self.folder / "results")
        self.errors = io.StringIO()

    def program(self, revision="a", verified=True) -> Path:
        path = self.folder / "broadside"
        path.write_text(STAND_IN.replace("REVISION", repr(revision)).replace("VERIFIED", repr(verified)))
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        return path

    def measuring(self, **changes) -> Measuring:
        program = changes.pop("program", None) or self.program()
        return Measuring(program, self.archive, self.folder / "work", RuleBook(), **changes)

    def measure(self, runs=(1, 2, 3), **changes):
        with redirect_stderr(self.errors):
            self.measuring(**changes).measure([SMALL], runs)

    def calls(self) -> int:
        return len((self.folder / "work" / "calls").read_text().splitlines())

    def test_are_each_on_seeds_and_files_of_their_own(self):
        self.measure(runs=[1, 2])
        cases = json.loads((self.folder / "work" / "small.cases.json").read_text())["cases"]
        self.assertEqual(cases[0]["seed"], seed_of(2))
        self.assertEqual(cases[1]["scene"], ["inputs/corner-2-0.npy", "inputs/corner-2-1.npy"])
        self.assertNotEqual((self.folder / "work" / "inputs" / "corner-1-0.npy").read_bytes(),
                            (self.folder / "work" / "inputs" / "corner-2-0.npy").read_bytes())

    def test_that_are_there_are_kept_and_the_rest_is_measured(self):
        self.measure(runs=[1])
        before = self.archive.path(1, "small").read_bytes()
        self.measure()
        self.assertEqual(self.calls(), 3)
        self.assertEqual(self.archive.path(1, "small").read_bytes(), before)
        self.assertEqual(self.archive.run_numbers("small"), [1, 2, 3])

    def test_that_are_cut_off_leave_no_file_and_are_measured_again(self):
        (self.folder / "work").mkdir()
        (self.folder / "work" / "interrupted").touch()
        with self.assertRaises(KeyboardInterrupt):
            self.measure()
        self.assertEqual(self.archive.run_numbers("small"), [])
        (self.folder / "work" / "interrupted").unlink()
        self.measure()
        self.assertEqual(self.archive.run_numbers("small"), [1, 2, 3])

    def test_that_the_program_refuses_are_reported(self):
        (self.folder / "work").mkdir()
        (self.folder / "work" / "refused").touch()
        with self.assertRaisesRegex(Unusable, "broadside measure ended with 2"):
            self.measure()

    def test_by_another_program_are_refused_before_anything_is_measured(self):
        self.measure(runs=[2])
        with self.assertRaisesRegex(Unusable, r"run-2/small.json.xz: the program that measured it is \w+; expected"):
            self.measure(program=self.program(revision="b"))
        self.assertEqual(self.calls(), 1)

    def refused(self, change, message):
        """Measures, changes what run 2's file says, and expects it refused in a line."""
        self.measure()
        path = self.archive.path(2, "small")
        content = json.loads(lzma.decompress(path.read_bytes()))
        change(content)
        path.write_bytes(lzma.compress(json.dumps(content).encode()))
        with self.assertRaisesRegex(Unusable, message) as caught:
            self.archive.results(SMALL, RuleBook())
        self.assertNotIn("\n", str(caught.exception))

    def test_of_another_schema_are_refused(self):
        self.refused(lambda content: content.update(schema="broadside.experiment-run/0"),
                     "run-2/small.json.xz: schema is broadside.experiment-run/0; expected broadside.experiment-run/1")

    def test_by_other_rules_are_refused(self):
        self.refused(lambda content: content["rules"].update(digest="0"),
                     r"the rules' version is 1 \(0\); expected .* as changed rules take new data: remove it")

    def test_of_other_cases_are_refused(self):
        self.refused(lambda content: content.update(cases="0"), "the cases of small have changed")

    def test_of_another_build_do_not_go_together(self):
        self.refused(lambda content: content["results"]["build"].update(revision="b"),
                     "its build is revision b; expected revision a, that of run 1")

    def test_of_another_program_do_not_go_together(self):
        self.refused(lambda content: content.update(program="0"), "the program that measured it is 0; .* run 1")

    def test_that_are_copies_of_another_run_are_refused(self):
        self.refused(lambda content: content.update(run=1), "the run is 1 of small; expected 2 of small, as its path")

    def test_that_lack_a_part_are_refused(self):
        self.refused(lambda content: content.pop("rules"),
                     "run-2/small.json.xz cannot be read .it has no 'rules'.; expected")

    def test_that_two_processes_measure_at_once_are_refused(self):
        with self.measuring().alone(), self.assertRaisesRegex(Unusable, "another process measures into"):
            self.measure()

    def test_in_folders_of_other_names_are_let_be(self):
        self.measure(runs=[1])
        self.archive.path(1, "small").parent.rename(self.archive.folder / "run-copy")
        self.assertEqual(self.archive.run_numbers("small"), [])

    def test_of_another_clock_do(self):
        with self.assertRaises(AssertionError):
            self.refused(lambda content: content["results"]["machine"].update(clock_mhz=2), "clock")

    def test_that_were_cut_in_the_file_are_refused(self):
        self.measure()
        path = self.archive.path(2, "small")
        path.write_bytes(path.read_bytes()[:100])
        with self.assertRaisesRegex(Unusable, "run-2/small.json.xz cannot be read"):
            self.archive.results(SMALL, RuleBook())

    def test_with_a_wrong_result_are_refused(self):
        self.measure(program=self.program(verified=False))
        with self.assertRaisesRegex(Unusable, "is wrong in case 'small'"):
            self.archive.results(SMALL, RuleBook())

    def test_in_which_something_was_too_slow_say_what(self):
        self.measure()
        results, _ = self.archive.results(SMALL, RuleBook())
        for run in results.runs:
            run.measurement("small", "grid").update(samples_ms=None, tests_by_seed=[None], skipped="estimated 9 s")
        for figure in (lambda: results.ratio("small", "paper_grid", "grid"), lambda: results.time("small", "grid"),
                       lambda: results.count("small", "grid", "tests")):
            with self.assertRaisesRegex(Unusable, r"case 'small': grid has no \w+ \(estimated 9 s\)"):
                figure()

    def test_that_lack_what_an_experiment_asks_for_say_what_they_have(self):
        self.measure()
        results, _ = self.archive.results(SMALL, RuleBook())
        with self.assertRaisesRegex(Unusable, "no case 'large' was measured; expected one of: .*small"):
            results.time("large", "grid")
        with self.assertRaisesRegex(Unusable, "case 'small': 'bvh' was not measured; expected one of: .*grid"):
            results.time("small", "bvh")

    def test_that_are_not_there_are_asked_for(self):
        with self.assertRaisesRegex(Unusable, "has no run of small; expected one at least"):
            self.archive.results(SMALL, RuleBook())

    def test_quick_ones_do_not_go_with_whole_ones(self):
        self.measure(runs=[1], is_quick=True)
        with self.assertRaisesRegex(Unusable, "it is a quick run; expected a whole run"):
            self.measure()

    def test_about_a_statement_that_is_not_there_are_refused(self):
        self.measure()
        with self.assertRaisesRegex(Unusable, "experiment small is about statement 1a; expected one that is in"):
            printing.judged_experiment(SMALL, self.archive, RuleBook(), {})

    @unittest.skipUnless(PROGRAM, "BROADSIDE_PROGRAM is not set; expected the program")
    def test_by_the_program_itself_can_be_judged(self):
        self.measure(program=Path(PROGRAM), is_quick=True)
        results, runs = self.archive.results(SMALL, RuleBook())
        self.assertGreater(results.ratio("small", "paper_grid", "grid").value, 0)
        run = results.runs[0]
        self.assertEqual((run.boxes("own"), run.seeds("own"), run.boxes("small")), (50, 2, 200))
        parts = run.time("small", "paper_grid", ["initializing", "adding", "searching"])
        self.assertTrue(0 < parts <= run.time("small", "paper_grid"))
        self.assertNotEqual(results.runs[0].count("small", "grid", "tests"),
                            results.runs[1].count("small", "grid", "tests"), "on boxes of its own")
        self.assertEqual([one["run"] for one in runs], [1, 2, 3])


if __name__ == "__main__":
    unittest.main()
