"""Builds the documentation as a site: site.py FOLDER, by the Python that has requirements.txt.

Lays out README.md, what it links to and what these pages link to, as in the repository, so that relative links hold in
both; adds the C++ API by Doxygen; and runs MkDocs on them. A page that links to what is missing fails the build.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
LINK = re.compile(r"(\]\()([^)#\s:]+)")
MANY = 100  # files of a linked folder that are too many to be copied

API = """# The C++ API

By Doxygen, from the comments of the headers:

- [Functions and types of namespace `broadside`]({0}namespacebroadside.html)
- [Classes]({0}annotated.html)
- [Headers]({0}files.html), that of the [C interface]({0}broadside_8h.html) among them
"""
HOME = "- [The other pages of the documentation](../../index.html)\n"

DOXYFILE = """
PROJECT_NAME = Broadside
INPUT = include/broadside bindings/c/broadside.h "{folder}/cpp-home.md"
USE_MDFILE_AS_MAINPAGE = "{folder}/cpp-home.md"
RECURSIVE = YES
STRIP_FROM_PATH = include bindings/c
STRIP_FROM_INC_PATH = include bindings/c
OUTPUT_DIRECTORY = "{folder}"
HTML_OUTPUT = cpp
HTML_EXTRA_STYLESHEET = tools/docs/doxygen_dark.css
HTML_TIMESTAMP = NO
GENERATE_LATEX = NO
JAVADOC_AUTOBRIEF = YES
EXTRACT_ALL = YES
EXTRACT_STATIC = YES
EXCLUDE_SYMBOLS = broadside::detail std std::hash
ENABLE_PREPROCESSING = YES
MACRO_EXPANSION = YES
EXPAND_ONLY_PREDEF = YES
PREDEFINED = BROADSIDE_PUBLIC= BROADSIDE_HIDDEN= BROADSIDE_CALLERS_VECTOR= BROADSIDE_RECORDER_ABI= BROADSIDE_API= BROADSIDE_EXPERIMENTAL=
SORT_MEMBER_DOCS = NO
SHOW_USED_FILES = NO
HAVE_DOT = NO
QUIET = YES
WARNINGS = NO
"""


def lay_out(start: list[str], pages: Path) -> None:
    """Copies files of the repository, and those they link to, into `pages`; a folder becomes a list of its files."""
    waiting, seen = list(start), set()
    while waiting:
        path = waiting.pop()
        if path in seen:
            continue
        seen.add(path)
        source = ROOT / path
        if source.suffix != ".md":
            (pages / path).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, pages / path)
            continue

        def linked(match: re.Match, folder: str = os.path.dirname(path)) -> str:
            target = os.path.normpath(os.path.join(folder, match[2]))
            if not (ROOT / target).exists():
                return match[0]
            if (ROOT / target).is_file():
                waiting.append(target)
                return match[0]
            waiting.append(target + "/README.md")
            return match[1] + match[2].rstrip("/") + "/README.md"

        (pages / path).parent.mkdir(parents=True, exist_ok=True)
        text = source.read_text() if source.exists() else listing(os.path.dirname(path))
        (pages / path).write_text(LINK.sub(linked, text))


def listing(folder: str) -> str:
    """A page that links to the files of a folder of the repository, or names its parts if they are many."""
    command = ["git", "-C", ROOT / folder, "ls-files"]
    names = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    if len(names) > MANY:
        lines = sorted({f"- {name.split('/')[0]}" for name in names})
    else:
        lines = [f"- [{name}]({name})" for name in names]
    return "\n".join([f"# {folder}", "", *lines, ""])


def build(folder: Path) -> None:
    pages, site = folder / "pages", folder / "site"
    shutil.rmtree(pages, ignore_errors=True)
    documents = [str(path.relative_to(ROOT)) for path in (ROOT / "docs").rglob("*.md")]
    lay_out(["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", *documents], pages)
    (pages / "docs/cpp-api.md").write_text(API.format("cpp/"))
    (pages / "docs/cpp-home.md").write_text(API.format("") + HOME)
    for name in ("iframe-worker.js", "wide.css"):
        shutil.copy(ROOT / "tools/docs" / name, pages)
    subprocess.run(["doxygen", "-"], cwd=ROOT, check=True, text=True, input=DOXYFILE.format(folder=pages / "docs"))
    (pages / "docs/cpp-home.md").unlink()
    # Material's note about MkDocs 2 does not concern a pinned version.
    environment = os.environ | {"PAGES": str(pages), "SITE": str(site), "NO_MKDOCS_2_WARNING": "1"}
    subprocess.run([sys.executable, "-m", "mkdocs", "build", "--quiet", "--strict", "--clean",
                    "--config-file", ROOT / "tools/docs/mkdocs.yml"], env=environment, check=True)
    print(site / "index.html")


if __name__ == "__main__":
    build(Path(sys.argv[1]).resolve())
