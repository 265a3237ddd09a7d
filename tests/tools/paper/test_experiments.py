"""What every experiment declares."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy

from tools.paper import draft
from tools.paper.experiment import Boxes, all_experiments, experiments_named, order_of, Unusable
from tools.paper.rules import RuleBook
from tools.paper.run import EFFORT

PROGRAM = os.environ.get("BROADSIDE_PROGRAM")


class Experiments(unittest.TestCase):
    def test_are_about_statements_of_the_draft_each_judged_once(self):
        statements = draft.statements()
        numbers = [claim.number for experiment in all_experiments().values() for claim in experiment.claims]
        self.assertEqual(len(numbers), len(set(numbers)))
        for number in numbers:
            self.assertIn(number, statements)
            self.assertIn(statements[number].kind, ("claim", "definition", "our claim"))
        self.assertLessEqual({one.number for one in statements.values() if "claim" in one.kind}, set(numbers))

    def test_say_what_would_decide_in_values_that_the_rules_have(self):
        book = RuleBook()
        for name, experiment in all_experiments().items():
            for claim in experiment.claims:
                for sentence in (claim.confirmed_if, claim.refuted_if):
                    filled = book.of(name).fill(sentence)
                    self.assertNotIn("{", filled)
                    self.assertTrue(filled.endswith("."), filled)
        self.assertLessEqual(set(book.experiments()), {*all_experiments(), "comparison"})

    @unittest.skipUnless(shutil.which("git"), "git is missing")
    def test_are_committed_where_thresholds_and_sentences_are(self):
        with tempfile.TemporaryDirectory() as folder:
            rules, sentences = Path(folder) / "rules.toml", Path(folder) / "experiments" / "one.py"
            sentences.parent.mkdir()
            sentences.write_text("more\n")
            rules.write_text("version = 1\n[all]\nlevel = 1.1\n")
            self.assertEqual(RuleBook(rules).commit(), "", "no repository")
            for arguments in (["init", "-q"], ["add", "."], ["-c", "user.name=a", "-c", "user.email=a@b.example",
                                                            "commit", "-q", "-m", "Rules"]):
                subprocess.run(["git", *arguments], cwd=folder, check=True)
            self.assertRegex(RuleBook(rules).commit(), "^[0-9a-f]{40}$")
            sentences.write_text("less\n")
            self.assertEqual(RuleBook(rules).commit(), "")

    def test_stand_in_the_order_of_the_draft_and_are_found_by_name(self):
        self.assertEqual(sorted(["10a", "2b", "B1", "2a"], key=order_of), ["2a", "2b", "10a", "B1"])
        self.assertEqual([one.name for one in experiments_named(["sweep_insertion"])], ["sweep_insertion"])
        with self.assertRaisesRegex(Unusable, "no experiment 'phlogiston'; expected some of: brute_force_tests"):
            experiments_named(["phlogiston"])

    def test_make_the_same_boxes_for_the_same_run(self):
        for experiment in all_experiments().values():
            for case in experiment.cases():
                if isinstance(case.scene, Boxes):
                    made = [case.scene.make(numpy.random.default_rng([1, 0])) for _ in range(2)]
                    numpy.testing.assert_array_equal(*made)
                    self.assertEqual(made[0].shape[1], 2 * case.dimension)
                    self.assertTrue((made[0][:, :case.dimension] <= made[0][:, case.dimension:]).all())

    @unittest.skipUnless(PROGRAM, "BROADSIDE_PROGRAM is not set; expected the program")
    def test_list_cases_that_the_program_takes(self):
        for experiment in all_experiments().values():
            with tempfile.TemporaryDirectory() as folder:
                for dimension in (2, 3):
                    box = numpy.array([[0] * dimension + [1] * dimension], dtype=numpy.float32)
                    numpy.save(Path(folder) / f"{dimension}.npy", box)
                cases = [case.listed(1, [f"{case.dimension}.npy"]) for case in experiment.cases()]
                listed = Path(folder) / "cases.json"
                listed.write_text(json.dumps({"schema": "broadside.cases/1", "effort": EFFORT, "cases": cases}))
                ended = subprocess.run([PROGRAM, "measure", listed, "--check"], cwd=folder, capture_output=True,
                                       text=True, check=False)
                self.assertEqual(ended.returncode, 0, ended.stderr)


class TheDraft(unittest.TestCase):
    def test_is_read_statement_by_statement(self):
        with tempfile.TemporaryDirectory() as folder:
            page = Path(folder) / "draft.md"
            page.write_text("# What\n\n| statement | a | kind | errata |\n|---|---|---|---|\n\n## V. Trees\n\n"
                            "| statement | what | kind | errata |\n|---|---|---|---|\n| 8a | Many. | claim | |\n"
                            "## VI. More\n### A. All\n\n| VI-A.1 | So. | opinion | T6 error |\n"
                            "## Ours\n\n| B1a | None. | our claim | |\n")
            found = draft.statements(page)
        self.assertEqual(list(found), ["8a", "VI-A.1", "B1a"])
        self.assertEqual((found["8a"].says, found["8a"].section), ("Many.", "V. Trees"))
        self.assertEqual(found["VI-A.1"].section, "VI. More, A. All")
        self.assertEqual(found["B1a"].section, "Ours")


if __name__ == "__main__":
    unittest.main()
