"""python3 -m tools.paper COMMAND: measures, judges and prints."""

from __future__ import annotations

import argparse
import shutil
import signal
import sys
from collections.abc import Sequence
from pathlib import Path

ROOT = Path(__file__).parents[2]
MEASURED = ROOT / "build" / "experiments"
COMPARED = ROOT / "build" / "comparison"
PUBLISHED = Path(__file__).parent / "results"
PAGES = ROOT / "docs" / "paper"
PACKAGES = "python3-numpy, python3-scipy, python3-pandas, python3-matplotlib and python3-jinja2"

try:
    from . import draft, print as printing
    from .archive import Archive
    from .comparison import disagreements, load
    from .comparison_cases import COMPARISON, MeasuringComparison
    from .experiment import Experiment, Unusable, experiments_named
    from .rules import RuleBook
    from .run import Measuring
except ModuleNotFoundError as missing:
    sys.exit(f"tools.paper: {missing.name} is missing; expected Debian's {PACKAGES} (tools/setup/setup --paper) and "
             f"to be run by /usr/bin/python3")
except KeyboardInterrupt:  # importing takes seconds on a busy machine
    sys.exit(130)


def main(arguments: Sequence[str]) -> int:
    options = parse(arguments)
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # so that the program that measures ends, too
    try:
        return options.command(options)
    except Unusable as error:
        print(f"tools.paper: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"tools.paper: {error.filename}: {error.strerror}; expected folders that can be written and "
              f"programs that can be run", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("tools.paper: interrupted; what had ended is kept, and the same command goes on from there",
              file=sys.stderr)
        return 130


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python3 -m tools.paper", description="Measures and judges the statements of the draft, and prints the "
        "paper. tools/paper/README.md is the guide.")
    verbs = parser.add_subparsers(required=True, metavar="COMMAND")

    def verb(command, name: str, text: str) -> argparse.ArgumentParser:
        added = verbs.add_parser(name, help=text, description=text)
        added.set_defaults(command=command)
        return added

    def takes_experiments(added: argparse.ArgumentParser, folder: Path) -> None:
        added.add_argument("names", nargs="*", metavar="NAME", help="experiments (default: all)")
        added.add_argument("--results", type=Path, default=folder, metavar="FOLDER",
                           help=f"folder of the runs (default: {folder.relative_to(ROOT)})")

    def takes_runs(added: argparse.ArgumentParser, runs: int) -> None:
        added.add_argument("--runs", type=int, default=runs, metavar="N", help=f"how many runs (default: {runs})")
        added.add_argument("--first", type=int, default=1, metavar="N",
                           help="number of the first run; the number seeds its boxes (default: 1)")
        added.add_argument("--quick", action="store_true",
                           help="fewer rounds, for a first impression; quick runs cannot be published")
        added.add_argument("--program", type=Path, default=ROOT / "build/release/broadside", metavar="FILE",
                           help="the program (default: build/release/broadside)")

    verb(list_experiments, "list", "List the experiments and their statements")
    measuring = verb(run, "run", "Measure experiments; runs that are already in the folder are kept")
    takes_experiments(measuring, MEASURED)
    takes_runs(measuring, 3)
    comparing = verb(compare, "compare", "Measure the comparison with other libraries; "
                     "processes that are already in the folder are kept")
    comparing.add_argument("--results", type=Path, default=COMPARED, metavar="FOLDER",
                           help="folder of the runs (default: build/comparison)")
    takes_runs(comparing, 10)
    takes_experiments(verb(judge, "judge", "Judge experiments by their runs"), MEASURED)
    printed = verb(print_paper, "print", "Print the paper and its pages from the runs")
    takes_experiments(printed, PUBLISHED)
    printed.add_argument("--to", type=Path, default=ROOT / "build/paper", metavar="FOLDER",
                         help="folder for pages, figures and PDF (default: build/paper); docs/paper takes complete "
                              "results only, and README.md and docs/results.md then quote them")
    printed.add_argument("--comparison", type=Path, metavar="FOLDER",
                         help="folder of the comparison's runs (default: the folder comparison within --results)")
    published = verb(publish, "publish",
                     "Copy complete sets of runs to tools/paper/results, which `make paper` prints")
    published.add_argument("--results", type=Path, default=MEASURED, metavar="FOLDER",
                           help="runs of the experiments (default: build/experiments)")
    published.add_argument("--comparison", type=Path, default=COMPARED, metavar="FOLDER",
                           help="runs of the comparison (default: build/comparison)")
    agreeing = verb(agree, "agree",
                    "List the verdicts, or the leads of the comparison, on which two sets of runs disagree")
    agreeing.add_argument("sets", nargs=2, type=Path, metavar="FOLDER",
                          help="folders of runs, both of experiments or both of the comparison")
    return parser.parse_args(arguments)


def list_experiments(_: argparse.Namespace) -> int:
    for experiment in experiments_named([]):
        numbers = ", ".join(claim.number for claim in experiment.claims)
        print(f"{experiment.name:20}  {experiment.title} ({numbers})")
    return 0


def run(options: argparse.Namespace) -> int:
    return measure(Measuring, experiments_named(options.names), options)


def compare(options: argparse.Namespace) -> int:
    return measure(MeasuringComparison, [COMPARISON], options)


def measure(how: type[Measuring], experiments: Sequence[Experiment], options: argparse.Namespace) -> int:
    if options.runs < 1 or options.first < 1:
        raise Unusable(f"--runs is {options.runs} and --first {options.first}; expected 1 or more")
    measuring = how(options.program, Archive(options.results), options.results / "work", RuleBook(), options.quick)
    measuring.measure(experiments, range(options.first, options.first + options.runs))
    return 0


def measured_ones(archive: Archive, names: Sequence[str]) -> list[Experiment]:
    found = [experiment for experiment in experiments_named(names)
             if names or archive.run_numbers(experiment.name)]
    if not found:
        raise Unusable(f"{archive.folder} has no runs; expected some, as `make experiments` measures")
    return found


def judge(options: argparse.Namespace) -> int:
    """Prints verdicts. Reports an unusable experiment in one line, and judges the others."""
    archive, statements, status = Archive(options.results), draft.statements(), 0
    for one in measured_ones(archive, options.names):
        try:
            experiment = printing.judged_experiment(one, archive, RuleBook(), statements)
        except Unusable as error:
            printing.say(f"tools.paper: {error}; {one.name} is not judged")
            status = 2
            continue
        count = len(experiment.runs)
        seconds = sum(one["seconds"] for one in experiment.runs) / count
        quick = "quick " if experiment.runs[0]["quick"] else ""
        print(f"{experiment.name} ({count} {quick}run{'s' if count > 1 else ''} of {seconds:.0f} s)")
        for claim in experiment.claims:
            print(f"  {claim.number:4} {claim.verdict}")
            print(f"         confirmed if: {claim.confirmed_if}")
            print(f"         refuted if: {claim.refuted_if}")
            for name, at in claim.finding.evidence.items():
                print(f"         {name}: {at.text()}")
    return status


def print_paper(options: argparse.Namespace) -> int:
    is_whole = options.to.resolve() == PAGES
    content = gathered(options.results, options.comparison, [] if is_whole else options.names, is_whole)
    printing.write_pages(content, options.to)
    printing.print_paper(options.to, content, ROOT / "build" / "paper" / "print")
    if is_whole:
        printing.fill_quotes(content, ROOT)
    return 0


def gathered(results: Path, compared: Path | None, names: Sequence[str], is_whole: bool) -> printing.Content:
    """The results to print. Reports an unusable experiment in one line and prints it as not measured; raises if all
    are required."""
    archive, book, statements = Archive(results), RuleBook(), draft.statements()
    found, unmeasured, missing = [], [], []
    named = experiments_named(names)
    for experiment in experiments_named([]):
        try:
            if experiment in named and (is_whole or archive.run_numbers(experiment.name)):
                found.append(printing.judged_experiment(experiment, archive, book, statements))
                continue
            missing.append(experiment.name)
        except Unusable as error:
            if is_whole:
                raise
            printing.say(f"tools.paper: {error}; its statements are printed as not measured")
        unmeasured.append(experiment)
    if missing:
        printing.say(f"tools.paper: {results} has no runs of {', '.join(missing)}: printed as not measured")
    try:
        comparison = load(compared or results / COMPARISON.name)
    except Unusable as error:
        if is_whole:
            raise
        printing.say(f"tools.paper: {error}; the comparison is printed as not measured")
        comparison = None
    return printing.Content(found, unmeasured, statements, book, comparison)


def publish(options: argparse.Namespace) -> int:
    """Publishes the measured experiments, the comparison, or both."""
    sets = [(experiments_named([]), Archive(options.results), PUBLISHED),
            ([COMPARISON], Archive(options.comparison), PUBLISHED / COMPARISON.name)]
    sets = [one for one in sets if any(one[1].folder.glob("run-*"))]
    if not sets:
        raise Unusable(f"{options.results} and {options.comparison} have no runs; expected some in one of them")
    for experiments, archive, _ in sets:
        check_set(experiments, archive)
    for _, archive, to in sets:
        publish_set(archive, to)
    return 0


def check_set(experiments: Sequence[Experiment], archive: Archive) -> None:
    """Refuses a set unless every experiment has all of its runs, with rules that were committed before them."""
    book = RuleBook()
    for experiment in experiments:
        _, runs = archive.results(experiment, book)
        least = book.of(experiment.name).min_runs
        if len(runs) < least:
            raise Unusable(f"{experiment.name} has {len(runs)} runs; expected {least:g} or more")
        for one in runs:
            if one["quick"]:
                raise Unusable(f"run {one['run']} of {experiment.name} was a quick one; expected a whole one")
            if not one["rules"]["commit"]:
                raise Unusable(f"run {one['run']} of {experiment.name} was measured before its rules were "
                               f"committed; expected rules.toml and experiments/ committed first")


def publish_set(archive: Archive, to: Path) -> None:
    for old in to.glob("run-*"):
        shutil.rmtree(old)
    for folder in sorted(archive.folder.glob("run-*")):
        shutil.copytree(folder, to / folder.name)
    print(f"{to.relative_to(ROOT)} has what {archive.folder} has; commit it")


def agree(options: argparse.Namespace) -> int:
    if all(Archive(folder).run_numbers(COMPARISON.name) for folder in options.sets):
        found = disagreements(*options.sets)
    else:
        first, second = (verdicts(Archive(folder)) for folder in options.sets)
        found = [f"{name}: {first.get(name, 'none')}, then {second.get(name, 'none')}" for name in {**first, **second}
                 if first.get(name) != second.get(name)]
    print("\n".join(found) or "the two sets agree")
    return 1 if found else 0


def verdicts(archive: Archive) -> dict[str, str]:
    statements = draft.statements()
    found = [printing.judged_experiment(one, archive, RuleBook(), statements) for one in measured_ones(archive, [])]
    return {f"{experiment.name}, {claim.number}": claim.finding.verdict.value
            for experiment in found for claim in experiment.claims}


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
