"""Pages and the printed paper, of results that are made."""

import hashlib
import io
import os
import re
import shutil
import tempfile
import unittest
from contextlib import redirect_stderr
from pathlib import Path
from unittest import mock

import test_comparison
from made_results import results_of
from matplotlib import pyplot
from test_run import SMALL, STATEMENTS
from tools.paper import draft, print as printing
from tools.paper.__main__ import PAGES, PUBLISHED, ROOT, gathered
from tools.paper.archive import Archive
from tools.paper.comparison import Comparison, load
from tools.paper.comparison_cases import COMPARISON, kept
from tools.paper.experiment import Unusable, all_experiments
from tools.paper.figures import Figure, new
from tools.paper.judge import judge
from tools.paper.rules import RuleBook
from tools.paper.tables import Table

RUN = {"run": 1, "quick": False, "seconds": 30.0, "date": "2026-11-26", "machine": {"cpu": "one", "cores": 2},
       "build": {"version": "1.0"}, "processor_share": 0.5, "busy": True, "load_before": None, "load_after": 0.25,
       "measurements": 5, "unsteady": 1}
PHASES = ("initializing_ms", "adding_ms", "searching_ms", "detecting_ms", "finding", "written")
HAS_PRINTERS = all(map(shutil.which, ("pandoc", "pdflatex", "rsvg-convert")))


def content(is_measured=True, ratio=1.5) -> printing.Content:
    """A small experiment whose claim is confirmed by a ratio of 1.5; a comparison with one fact, table and figure."""
    book = RuleBook()
    results = results_of(SMALL, lambda case, spec: ratio if spec == "paper_grid" else 1.0)
    finding, = judge(SMALL, results, book)
    claim = printing.judged_claim(SMALL.claims[0], finding, book.of("small"), STATEMENTS, "small")
    one = printing.JudgedExperiment(SMALL, [claim], list(SMALL.figures(results, book.of("small"))), [RUN])
    if not is_measured:
        return printing.Content([], [SMALL], STATEMENTS, book)
    compared = Comparison({"lead": "7.1"}, {"leads": Table(["case", "lead:"], [["one", "7.1"]])},
                          [Figure("comparison_leads", "Leads.", new()[0])])
    return printing.Content([one], [], STATEMENTS, book, compared)


class Pages(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.addCleanup(pyplot.close, "all")
        self.folder = Path(temporary.name)
        self.pages = self.folder / "docs" / "paper"
        self.templates = self.folder / "templates"
        shutil.copytree(printing.TEMPLATES, self.templates)
        shutil.rmtree(self.templates / "sections")
        before, printing.TEMPLATES = printing.TEMPLATES, self.templates
        self.addCleanup(setattr, printing, "TEMPLATES", before)
        for page in self.templates.glob("*.md"):
            if page.name != "statements.md":
                page.unlink()

    def write(self, template: str, **made) -> str:
        """The paper's page as it is filled."""
        (self.templates / "paper.md").write_text(template)
        printing.write_pages(content(**made), self.pages)
        return (self.pages / "paper.md").read_text().removeprefix(printing.NOTICE).strip()

    def test_have_figures_verdicts_and_facts_by_name(self):
        self.assertRegex(self.write('{{ figure("1a", "it") }}'), r"^1\.\d\d \(1\.\d\d to 1\.\d\d\)$")
        self.assertRegex(self.write('{{ span("1a", "i") }}'), r"^1\.\d\d \(")
        self.assertEqual(self.write('{{ verdict("1a") }}, {{ fact("lead") }}'), "is confirmed, 7.1")
        self.assertEqual(self.write('{{ table("leads") }}'), "| case | lead |\n| ------ | -----: |\n| one | 7.1 |")
        by = '{{ by("1a", confirmed="yes", bounds="some", refuted="no", otherwise="open") }}'
        self.assertEqual([self.write(by), self.write(by, ratio=1.0), self.write(by, is_measured=False)],
                         ["yes", "no", "open"])

    def test_with_a_name_that_is_not_there_are_refused_in_a_line_that_says_where_and_what_there_is(self):
        for template, message in {
            '{{ figure("1a", "that") }}': "no figure of 1a 'that'; expected one of: it",
            '{{ span("1a", "that") }}': "no figure of 1a has 'that' in its name; expected one of: it",
            '{{ verdict("1x") }}': "no claim '1x'; expected one of: 1a",
            '{{ picture("big") }}': "no figure 'big'; expected one of: small; comparison_leads",
            '{{ see("big") }}': "no figure 'big'",
            '{{ fact("leed") }}': "no fact of the comparison 'leed'; expected one of: lead",
            '{{ table("leeds") }}': "no table of the comparison 'leeds'; expected one of: leads",
            "{{ macine.cores }}": "'macine' is undefined",
            '{{ by("1a", confirmd="") }}': "confirmd",
        }.items():
            with self.assertRaisesRegex(Unusable, "template paper.md, line 2: .*" + re.escape(message)) as caught:
                self.write("one\n" + template)
            self.assertNotIn("\n", str(caught.exception))
        with self.assertRaisesRegex(Unusable, "template paper.md, line 2: "):
            self.write("one\n{{ verdict(")
        self.assertFalse((self.pages / "statements.md").exists())

    def test_number_pictures_in_the_order_of_the_text(self):
        text = self.write('{{ see("small") }}\n\n{{ picture("swept_grid", "Swept.") }}\n\n{{ picture("small") }}')
        self.assertEqual(text.splitlines()[::2], ["Figure 2", "![Figure 1. Swept.](diagrams/swept_grid.svg)",
                                                  "![Figure 2. A small one.](figures/small)"])
        self.assertTrue((self.pages / "figures" / "small.svg").exists())

    def test_have_links_that_lead_from_where_they_are_written(self):
        links = re.findall(r"\]\(([^)#]*)", self.write("[a](../draft.md) [b](../../README.md#use) [c](paper.md)"))
        self.assertTrue((self.pages / links[0]).samefile(ROOT / "docs" / "draft.md"))
        self.assertTrue((self.pages / links[1]).samefile(ROOT / "README.md"))
        self.assertEqual(links[2], "paper.md")

    def test_have_every_statement_with_its_rule_and_runs(self):
        self.write("")
        text = (self.pages / "statements.md").read_text()
        self.assertRegex(text, r"\| \[1a\]\(#small\) \| Half \\\| are left. \| confirmed \|")
        self.assertIn("*Confirmed if:* More than 1.25.", text)
        self.assertIn("| Small | 1 | 30.0 | 2026-11-26 | 1 (50% of a processor) | unknown, 0.2 | 1 of 5 |", text)
        self.write("", is_measured=False)
        self.assertIn("| not measured |", (self.pages / "statements.md").read_text())

    def printed(self, text: str) -> str:
        errors = io.StringIO()
        with redirect_stderr(errors):
            self.write(text)
            printing.print_paper(self.pages, content(), self.folder / "work")
        return errors.getvalue()

    @unittest.skipUnless(HAS_PRINTERS, "pandoc, pdflatex or rsvg-convert is missing (tools/setup/setup --paper)")
    def test_are_printed_with_sources_and_captions(self):
        (self.templates / "references.bib").write_text(
            "@book{ericson, author={Ericson, Christer}, title={Real-Time Collision Detection}, year=2005}")
        self.printed('# Boxes\n\nAs in [@ericson] and [errata.md](../errata.md).\n\n{{ picture("small") }}\n\n'
                     '{{ picture("swept_grid", "Swept.") }}\n\n```\nfunction\n```\n\n## References\n')
        page = (self.pages / "paper.md").read_text()
        self.assertTrue(page.startswith(printing.NOTICE))
        self.assertIn("(Ericson 2005)", page)
        self.assertRegex(page, r"!\[\]\(figures/small.svg\)\n\n\*Figure 1. A small one.\*")
        self.assertIn("Figure 1. A small one.", (self.folder / "work" / "paper.html").read_text())
        first = (self.pages / "paper.pdf").read_bytes()
        self.assertIn(b"/TextSum", first)
        self.printed((self.templates / "paper.md").read_text())
        self.assertEqual((self.pages / "paper.pdf").read_bytes(), first)

    @unittest.skipUnless(HAS_PRINTERS, "pandoc, pdflatex or rsvg-convert is missing (tools/setup/setup --paper)")
    def test_name_sources_and_pictures_that_are_not_there(self):
        with self.assertRaisesRegex(Unusable, "nobody.*not found"):
            self.printed("As in [@nobody].")
        with self.assertRaisesRegex(Unusable, "paper.md.*big.png"):
            self.printed("![Big](big.png)")

    def test_say_what_is_missing_and_what_is_printed_without(self):
        path = os.environ["PATH"]
        self.addCleanup(os.environ.__setitem__, "PATH", path)
        os.environ["PATH"] = str(self.folder)
        self.assertRegex(self.printed("one"), r"^pandoc is missing \(.*\): the other pages are written")

    def test_are_quoted_by_others(self):
        (self.templates / "quotes").mkdir(exist_ok=True)
        (self.templates / "quotes" / "leads.md").write_text('{{ table("leads") }}')
        (self.folder / "docs").mkdir()
        for name in printing.QUOTING:
            (self.folder / name).write_text("one\n<!-- quote: leads -->\nold\n<!-- end of quote -->\ntwo\n")
        printing.fill_quotes(content(), self.folder)
        self.assertEqual((self.folder / "README.md").read_text(),
                         "one\n<!-- quote: leads -->\n| case | lead |\n| ------ | -----: |\n| one | 7.1 |\n\n"
                         "<!-- end of quote -->\ntwo\n")
        (self.templates / "quotes" / "leads.md").unlink()
        with self.assertRaisesRegex(Unusable, "leads"):
            printing.fill_quotes(content(), self.folder)


class TheTemplates(unittest.TestCase):
    def judged(self, experiment) -> printing.JudgedExperiment:
        """By results of a model in which algorithms differ somehow."""
        book, statements = RuleBook(), draft.statements()
        rules = book.of(experiment.name)
        results = results_of(experiment, lambda case, spec: 1 + len(case.name + spec) % 7 / 7,
                             lambda case, spec: (2 + len(spec) % 5, 3), lambda case, spec: dict.fromkeys(PHASES, 1.0))
        claims = [printing.judged_claim(claim, finding, rules, statements, experiment.name)
                  for claim, finding in zip(experiment.claims, judge(experiment, results, book))]
        return printing.JudgedExperiment(experiment, claims, list(experiment.figures(results, rules)), [RUN])

    def test_name_only_what_there_is(self):
        self.addCleanup(pyplot.close, "all")
        with tempfile.TemporaryDirectory() as name, mock.patch("tools.paper.figures.save"):
            folder = Path(name)
            for process in range(1, 6):
                Archive(folder).write(process, COMPARISON, RuleBook(), "program", False, 60,
                                      kept(test_comparison.results_of(process)))
            content = printing.Content([self.judged(one) for one in all_experiments().values()], [],
                                       draft.statements(), RuleBook(), load(folder))
            pages = {page.name: page.read_text() for page in printing.write_pages(content, folder / "pages")}
            (folder / "docs").mkdir()
            for quoting in printing.QUOTING:
                shutil.copy(ROOT / quoting, folder / quoting)
            printing.fill_quotes(content, folder)
        self.assertNotIn(printing.NOT_MEASURED, "".join(pages.values()))
        known = set(re.findall(r"^@\w+{(\w+),", (printing.TEMPLATES / "references.bib").read_text(), re.M))
        cited = set(re.findall(r"(?<![\w`])@(\w+)", pages[printing.PAPER]))
        self.assertEqual(cited, known)


@unittest.skipUnless(PUBLISHED.exists(), "tools/paper/results is missing; expected what `make paper` prints")
class PublishedPages(unittest.TestCase):
    """docs/paper has what the committed results print; the paper's page where there is pandoc, the PDF by its sum."""

    def test_are_what_the_results_print(self):
        content = gathered(PUBLISHED, None, [], is_whole=True)
        with tempfile.TemporaryDirectory() as name, redirect_stderr(io.StringIO()):
            folder = Path(name)
            pages = printing.write_pages(content, folder, home=PAGES)
            printing.print_paper(folder, content, folder / "work", has_pdf=False)
            for page in pages:
                if page.name != printing.PAPER or HAS_PRINTERS:
                    self.assertEqual(page.read_text(), (PAGES / page.name).read_text(), f"{page}: make paper")
            self.assertEqual(sorted(path.name for path in (folder / "figures").glob("*.svg")),
                             sorted(path.name for path in (PAGES / "figures").glob("*.svg")))
            (folder / "docs").mkdir()
            for quoting in printing.QUOTING:
                shutil.copy(ROOT / quoting, folder / quoting)
            printing.fill_quotes(content, folder)
            for quoting in printing.QUOTING:
                self.assertEqual((folder / quoting).read_text(), (ROOT / quoting).read_text(), "make paper")
        text = hashlib.sha256((PAGES / printing.PAPER).read_bytes()).hexdigest()
        self.assertIn(text.encode(), (PAGES / "paper.pdf").read_bytes(), "paper.pdf is of another text: make paper")


if __name__ == "__main__":
    unittest.main()
