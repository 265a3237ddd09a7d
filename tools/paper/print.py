"""Prints: templates become Markdown by Jinja2, and that HTML and PDF by pandoc and LaTeX."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import jinja2

from . import draft, figures
from .archive import Archive
from .experiment import Claim, Experiment, Unusable
from .judge import Finding, judge
from .rules import RuleBook, Rules
from .statistics import Estimate, digits

TEMPLATES = Path(__file__).parent / "templates"
PRINTED = Path(__file__).parents[2] / "paper" / "print"  # what LaTeX and HTML make of the text


@dataclass(frozen=True)
class JudgedClaim:
    """A statement of the draft with what became of it, as templates have it."""

    statement: draft.DraftStatement
    confirmed_if: str
    refuted_if: str
    finding: Finding

    @property
    def number(self) -> str:
        return self.statement.number

    @property
    def verdict(self) -> str:
        condition = self.finding.condition
        return self.finding.verdict.value + (f": {condition}" if condition else "")


@dataclass(frozen=True)
class JudgedExperiment:
    """An experiment with its findings and figures, as templates have it."""

    experiment: Experiment
    claims: Sequence[JudgedClaim]
    figures: Sequence[figures.Figure]
    runs: Sequence[Mapping]

    @property
    def name(self) -> str:
        return self.experiment.name


def judged_experiment(experiment: Experiment, archive: Archive, book: RuleBook,
                      statements: Mapping[str, draft.DraftStatement]) -> JudgedExperiment:
    results, runs = archive.results(experiment, book)
    findings = judge(experiment, results, book)
    rules = book.of(experiment.name)
    claims = [judged_claim(claim, finding, rules, statements, experiment.name)
              for claim, finding in zip(experiment.claims, findings)]
    return JudgedExperiment(experiment, claims, list(experiment.figures(results, rules)), runs)


def judged_claim(claim: Claim, finding: Finding, rules: Rules,
                 statements: Mapping[str, draft.DraftStatement], experiment: str) -> JudgedClaim:
    if claim.number not in statements:
        raise Unusable(f"experiment {experiment} is about statement {claim.number}; expected one that is in "
                       f"docs/draft.md")
    return JudgedClaim(statements[claim.number], rules.fill(claim.confirmed_if), rules.fill(claim.refuted_if),
                       finding)


def write_pages(experiments: Sequence[JudgedExperiment], book: RuleBook,
                statements: Mapping[str, draft.DraftStatement], folder: Path) -> list[Path]:
    """Every template as a page of that name, and the figures beside them in figures/."""
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(TEMPLATES), undefined=jinja2.StrictUndefined,
                                     trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True)
    environment.filters["digits"] = digits
    environment.filters["estimate"] = Estimate.text
    environment.filters["cell"] = lambda text: text.replace("|", "\\|").replace("\n", " ")
    judged_by_number = {claim.number: claim for experiment in experiments for claim in experiment.claims}
    folder.mkdir(parents=True, exist_ok=True)
    pages = []
    for name in environment.list_templates(extensions=["md"]):
        try:
            text = environment.get_template(name).render(experiments=experiments, rules=book,
                                                         statements=statements.values(), judged=judged_by_number)
        except jinja2.TemplateError as error:
            raise Unusable(f"template {name}: {error}") from None
        pages.append(folder / name)
        pages[-1].write_text(text, encoding="utf-8")
    for experiment in experiments:
        for figure in experiment.figures:
            figures.save(figure, folder / "figures")
    return pages


def print_pages(pages: Sequence[Path], folder: Path) -> None:
    """As HTML and as PDF, into `folder`. What is missing is said in a line; the rest is printed."""
    if shutil.which("pandoc") is None:
        say("pandoc is missing (packages-paper.txt): the pages and figures are written as Markdown, SVG and PDF; "
            "HTML and PDF of whole pages are not")
        return
    folder.mkdir(parents=True, exist_ok=True)
    for page in pages:
        pandoc(page, folder / f"{page.stem}.html", "--to", "html", "--self-contained", "--css",
               str(PRINTED / "page.css"))
    if shutil.which("pdflatex") is None:
        say("pdflatex is missing (packages-paper.txt): the pages are written as Markdown and HTML; PDF is not")
        return
    for page in pages:
        # SVG for pages on the web, the same figures as PDF for LaTeX.
        printed = folder / page.name
        printed.write_text(page.read_text(encoding="utf-8").replace(".svg)", ".pdf)"), encoding="utf-8")
        pandoc(printed, folder / f"{page.stem}.pdf", "--pdf-engine", "pdflatex", "--include-in-header",
               str(PRINTED / "preamble.tex"), "--variable", "classoption=10pt", "--resource-path",
               str(page.parent))


def pandoc(page: Path, to: Path, *arguments: str) -> None:
    ended = subprocess.run(["pandoc", "--from", "gfm", "--standalone", "--shift-heading-level-by", "-1", *arguments,
                            "--output", str(to.resolve()), str(page.resolve())],
                           cwd=page.parent, capture_output=True, text=True, check=False)
    if ended.returncode != 0:
        last = (ended.stderr.strip().splitlines() or ["no message"])[-1]
        raise Unusable(f"pandoc cannot make {to} ({last}); expected the packages of packages-paper.txt")
    say(f"{to} is written")


def say(text: str) -> None:
    print(text, file=sys.stderr)
