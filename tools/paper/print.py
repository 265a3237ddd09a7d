"""Prints: Jinja2 fills templates with Markdown, and pandoc and LaTeX turn the paper into a page, HTML and PDF."""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import sys
import traceback
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timezone
from pathlib import Path
from typing import TYPE_CHECKING

import jinja2

from . import draft, figures
from .archive import Archive
from .experiment import Claim, Experiment, Unusable, order_of
from .judge import Finding, Verdict, judge, listing
from .rules import RuleBook, Rules
from .statistics import digits
from .tables import Table
from .words import NOT_MEASURED, Words

if TYPE_CHECKING:
    from .comparison import Comparison

TEMPLATES = Path(__file__).parent / "templates"
DIAGRAMS = Path(__file__).parents[2] / "docs" / "paper" / "diagrams"
NOTICE = "<!-- Made by `make paper` from tools/paper/; edit the templates there. -->\n\n"
PAPER = "paper.md"  # printed by pandoc; the other pages are the filled Markdown
MOST_OF_A_CONDITION = 100  # maximum length of a verdict in a short table
QUOTING = ("README.md", "docs/results.md")  # pages of the repository that quote results


@dataclass(frozen=True)
class JudgedClaim:
    """A statement of the draft with its outcome, for templates."""

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
    """An experiment with its findings and figures, for templates."""

    experiment: Experiment
    claims: Sequence[JudgedClaim]
    figures: Sequence[figures.Figure]
    runs: Sequence[Mapping]

    @property
    def name(self) -> str:
        return self.experiment.name


@dataclass(frozen=True)
class Content:
    """The content of all pages. `unmeasured` lists the experiments without a run."""

    experiments: Sequence[JudgedExperiment]
    unmeasured: Sequence[Experiment]
    statements: Mapping[str, draft.DraftStatement]
    book: RuleBook
    comparison: Comparison | None = None

    @property
    def runs(self) -> list[Mapping]:
        """The metadata of each run, for all experiments together."""
        return [run for experiment in self.experiments for run in experiment.runs]


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


def write_pages(content: Content, folder: Path, home: Path | None = None) -> list[Path]:
    """Writes every template as a page of that name, with the figures beside them in figures/. The paper's page is
    still pandoc's Markdown: print_paper makes the readable page from it. Links start from `home`, by default the
    folder."""
    drawings = [figure for experiment in content.experiments for figure in experiment.figures]
    if content.comparison is not None:
        drawings += content.comparison.figures
    claims = [claim for experiment in content.experiments for claim in experiment.claims]
    unmeasured = [claim.number for experiment in content.unmeasured for claim in experiment.claims]
    pages = {}
    for name in environment(content, None).list_templates(filter_func=lambda name: re.fullmatch(r"\w+\.md", name)):
        words = Words(claims, unmeasured, content.statements, drawings, content.comparison)
        for _ in range(2):  # the second pass knows the numbers of figures that are referenced before they occur
            pages[name] = filled(environment(content, words), name)
    shutil.rmtree(folder / "figures", ignore_errors=True)  # figures of other results
    folder.mkdir(parents=True, exist_ok=True)
    if not (folder / "diagrams").exists():
        shutil.copytree(DIAGRAMS, folder / "diagrams")
    for name, text in pages.items():
        text = re.sub(r"(?<=\]\()\.\./[^)#]*",  # templates write links relative to docs/paper
                      lambda link: os.path.relpath(DIAGRAMS.parent / link[0], home or folder), text)
        (folder / name).write_text(NOTICE + text, encoding="utf-8")
    for drawing in drawings:
        figures.save(drawing, folder / "figures")
    return [folder / name for name in pages]


def environment(content: Content, words: Words | None) -> jinja2.Environment:
    made = jinja2.Environment(loader=jinja2.FileSystemLoader(TEMPLATES), undefined=jinja2.StrictUndefined,
                              trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True)
    made.filters["listing"] = listing
    made.globals.update(content=content, rules=content.book, machine=machine_words(content), total=totals(content),
                        evidence_table=evidence_table, runs_table=lambda: runs_table(content),
                        statements_table=lambda **which: statements_table(content, **which),
                        **(words.names() if words else {}))
    return made


def filled(templates: jinja2.Environment, name: str) -> str:
    """A template's text. If it uses an unknown name, raises Unusable with the template and the line."""
    try:
        return templates.get_template(name).render().strip() + "\n"
    except jinja2.TemplateSyntaxError as error:
        raise Unusable(f"template {error.name}, line {error.lineno}: {error.message}") from None
    except (jinja2.TemplateError, Unusable, TypeError) as error:
        places = [frame for frame in traceback.extract_tb(error.__traceback__)
                  if Path(frame.filename).is_relative_to(TEMPLATES)]
        if isinstance(error, jinja2.TemplateNotFound):
            raise Unusable(f"no template {error}; expected it in {TEMPLATES}") from None
        if not places:
            raise
        place = f"{Path(places[-1].filename).relative_to(TEMPLATES)}, line {places[-1].lineno}"
        raise Unusable(f"template {place}: {error}") from None


def machine_words(content: Content) -> dict[str, str]:
    """The machine and the build of the experiments, in words."""
    first = content.runs[0] if content.runs else {"machine": {}, "build": {}}
    machine, build = first["machine"], first["build"]
    clocks = [run["machine"]["clock_mhz"] / 1000 for run in content.runs if run["machine"].get("clock_mhz")]
    caches = [f"{name} {size // 1024:,} KiB" for name, size in (machine.get("caches") or {}).items()]
    return {
        "processor": f"{machine.get('cpu') or 'a processor'} with {machine.get('cores') or 'some'} cores",
        "clock": f"at {' to '.join(dict.fromkeys([f'{min(clocks):.2f}', f'{max(clocks):.2f}']))} GHz" if clocks else
                 "at a clock that it does not tell",
        "caches": listing(caches) if caches else "that it does not tell",
        "memory": f"{machine['memory_bytes'] / 2**30:.0f} GiB" if machine.get("memory_bytes") else "some",
        "system": machine.get("os") or "an unknown system",
        **{name: build.get(name) or "unknown" for name in ("compiler", "flags", "version", "revision")},
        "instruction_set": first.get("instruction_set") or "unknown",
        "date": max((run["date"] for run in content.runs), default="unknown")[:10],
    }


def statements_table(content: Content, is_ours: bool = False, is_whole: bool = True) -> str:
    """All statements of the draft, or our own claims, with the outcome of each; or only those that can be decided."""
    claims = {claim.number: claim for experiment in content.experiments for claim in experiment.claims}
    unmeasured = {claim.number for experiment in content.unmeasured for claim in experiment.claims}
    section = {claim.number: re.sub(r"[^\w -]", "", experiment.experiment.title.lower()).replace(" ", "-")
               for experiment in content.experiments for claim in experiment.claims}

    def verdict(statement: draft.DraftStatement) -> str:
        if statement.number in claims:
            claim = claims[statement.number]
            if is_whole or len(claim.verdict) <= MOST_OF_A_CONDITION:
                return claim.verdict
            return f"{claim.finding.verdict.value}, at {claim.finding.share}"
        return "not measured" if statement.number in unmeasured else f"({statement.kind})"
    shown = [one for one in content.statements.values() if (one.kind == "our claim") == is_ours]
    if not is_whole:
        shown = sorted((one for one in shown if one.number in unmeasured or one.number in claims),
                       key=lambda one: order_of(one.number))
    return Table(["statement", "what it says", "verdict"],
                 [[f"[{one.number}](#{section[one.number]})" if is_whole and one.number in section else one.number,
                   one.says, verdict(one)] for one in shown]).markdown()


def evidence_table(claim: JudgedClaim) -> str:
    rows = [[f"{mark}{name}", at.text(), "; ".join(map(digits, at.runs))]
            for mark, figures_of_it in (("", claim.finding.evidence), ("*beside:* ", claim.finding.beside))
            for name, at in figures_of_it.items()]
    return Table(["figure", "value and interval", "each run"], rows).markdown() if rows else "(no figures)"


def runs_table(content: Content) -> str:
    headings = ["experiment", "runs:", "seconds a run:", "date", "busy runs", "load before and after", "unsteady"]
    return Table(headings, [[
        one.experiment.title, str(len(one.runs)) + " (quick)" * one.runs[0]["quick"],
        digits(sum(run["seconds"] for run in one.runs) / len(one.runs)), max(run["date"] for run in one.runs)[:10],
        listing([f"{run['run']} ({run['processor_share']:.0%} of a processor)" for run in one.runs if run["busy"]]
                or ["none"]),
        "; ".join(f"{load_text(run['load_before'])}, {load_text(run['load_after'])}" for run in one.runs),
        f"{sum(run['unsteady'] for run in one.runs)} of {sum(run['measurements'] for run in one.runs)}",
    ] for one in content.experiments]).markdown()


def load_text(load: float | None) -> str:
    return "unknown" if load is None else f"{load:.1f}"


def totals(content: Content) -> dict[str, int | float]:
    """The number of the draft's statements by verdict, and of measurements."""
    verdicts = [claim.finding.verdict for experiment in content.experiments for claim in experiment.claims
                if claim.statement.kind != "our claim"]
    numbers = {run["run"] for run in content.runs}
    return {
        "judged": len(verdicts),
        **{verdict.name.lower(): verdicts.count(verdict) for verdict in Verdict},
        "runs": len(numbers),
        "processes": len(content.runs),
        "minutes": round(sum(run["seconds"] for run in content.runs) / max(len(numbers), 1) / 60, 1),
        "busy": sum(run["busy"] for run in content.runs),
        "unsteady": sum(run["unsteady"] for run in content.runs),
        "measurements": sum(run["measurements"] for run in content.runs),
        "quick": any(run["quick"] for run in content.runs),
    }


def print_paper(folder: Path, content: Content, work: Path, has_pdf: bool = True) -> None:
    """The paper as a page and as PDF in its folder, and as HTML in `work`. If a program is missing, a line says which
    one, and what is printed without it."""
    if shutil.which("pandoc") is None:
        say(f"pandoc is missing (tools/setup/setup --paper): the other pages are written; {folder / PAPER} is in "
            f"pandoc's Markdown, without sources, and there is no HTML or PDF of it")
        return
    work.mkdir(parents=True, exist_ok=True)
    source = work / PAPER
    source.write_text((folder / PAPER).read_text(encoding="utf-8").removeprefix(NOTICE), encoding="utf-8")
    page = pandoc(source, folder, "--to", "gfm-raw_html", "--columns", "119", "--default-image-extension", "svg")
    (folder / PAPER).write_bytes(NOTICE.encode() + page)
    printed = ["--standalone", "--shift-heading-level-by", "-1", "--metadata", "lang=en"]
    pandoc(source, folder, *printed, "--to", "html", "--self-contained", "--default-image-extension", "svg", "--css",
           str(TEMPLATES / "page.css"), "--output", str((work / "paper.html").resolve()))
    say(f"{folder / PAPER} and {work / 'paper.html'} are written")
    if not has_pdf:
        return
    missing = [program for program in ("pdflatex", "rsvg-convert") if shutil.which(program) is None]
    if missing:
        say(f"{listing(missing)} missing (tools/setup/setup --paper): pages and HTML are written, "
            f"{folder}/paper.pdf is not")
        return
    # The PDF contains the page's checksum, so that a test can detect a PDF of another text.
    sum_of_page = work / "sum.tex"
    sum_of_page.write_text(f"\\pdfinfo{{/TextSum ({hashlib.sha256(NOTICE.encode() + page).hexdigest()})}}\n")
    pandoc(source, folder, *printed, "--pdf-engine", "pdflatex", "--default-image-extension", "pdf",
           "--include-in-header", str(TEMPLATES / "preamble.tex"), "--include-in-header", str(sum_of_page.resolve()),
           "--variable", "classoption=10pt", "--variable", "colorlinks", "--variable", "linkcolor=black",
           "--variable", "urlcolor=black", "--output", str((folder / "paper.pdf").resolve()),
           day=machine_words(content)["date"])
    say(f"{folder / 'paper.pdf'} is written")


def pandoc(source: Path, folder: Path, *arguments: str, day: str = "") -> bytes:
    """pandoc's output for the paper. Uses the results' date as printing date, so that the bytes are the same."""
    variables = dict(os.environ)
    if re.fullmatch(r"\d{4}-\d\d-\d\d", day):
        seconds = datetime.fromisoformat(day).replace(tzinfo=timezone.utc).timestamp()
        variables |= {"SOURCE_DATE_EPOCH": f"{seconds:.0f}", "FORCE_SOURCE_DATE": "1"}
    ended = subprocess.run(
        ["pandoc", "--from", "markdown-smart", "--citeproc", "--bibliography", str(TEMPLATES / "references.bib"),
         "--lua-filter", str(TEMPLATES / "filter.lua"), *arguments, str(source.resolve())],
        cwd=folder, capture_output=True, check=False, env=variables)
    messages = ended.stderr.decode(errors="replace").strip().splitlines()
    if ended.returncode != 0:
        fault = " ".join([line for line in messages if re.match(r"! |l\.\d", line)] or messages[-1:])
        raise Unusable(f"pandoc cannot print {source} ({fault}); expected the packages of tools/setup/setup --paper")
    for line in messages:
        if "not found" in line or "Could not" in line:
            raise Unusable(f"{source}: {line}; expected what the templates name to be there")
    return ended.stdout


def fill_quotes(content: Content, root: Path) -> None:
    """Fills passages of other pages, between `<!-- quote: NAME -->` and `<!-- end of quote -->`, from
    templates/quotes/."""
    if content.comparison is None:
        say(f"{listing(QUOTING)} quote the comparison, which has no results: they are left as they were")
        return
    templates = environment(content, Words([], [], content.statements, [], content.comparison))
    for name in QUOTING:
        text = (root / name).read_text(encoding="utf-8")
        passages = re.compile(r"(<!-- quote: (\w+) -->\n).*?(<!-- end of quote -->)", re.DOTALL)
        (root / name).write_text(passages.sub(
            lambda found: found[1] + filled(templates, f"quotes/{found[2]}.md") + "\n" + found[3], text),
            encoding="utf-8")


def say(text: str) -> None:
    print(text, file=sys.stderr)
