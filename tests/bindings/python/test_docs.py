"""The pages about the Python package do what they say."""

import json
import re
import runpy
from pathlib import Path

import broadside

ROOT = Path(__file__).parents[3]


def test_the_guide_runs():
    blocks = re.findall(r"^```python\n(.*?)^```", (ROOT / "docs/python.md").read_text(), re.M | re.S)
    assert len(blocks) > 5
    namespace = {}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), namespace)


def test_the_tutorial_prints_what_it_shows(capsys):
    page = (ROOT / "docs/tutorials/python-data.md").read_text()
    code, shown = re.search(r"^```python\n(.*?)^```.*^```\n(.*?)^```", page, re.M | re.S).groups()
    exec(compile(code, "docs/tutorials/python-data.md", "exec"), {})
    assert capsys.readouterr().out == shown


def test_the_notebook_runs():
    notebook = json.loads((ROOT / "docs/python.ipynb").read_text())
    code = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert all(cell["outputs"] for cell in code), "run it, by jupyter nbconvert --execute --inplace docs/python.ipynb"
    cells = ["".join(cell["source"]) for cell in code]
    assert len(cells) > 5
    namespace = {}
    for cell in cells:
        exec(compile(cell, "docs/python.ipynb", "exec"), namespace)
    assert len(namespace["world"]) == 2000


def test_the_reference_is_that_of_the_docstrings():
    made = runpy.run_path(str(ROOT / "tools/docs/python_reference.py"))["reference"]()
    assert (ROOT / "docs/python-api.md").read_text() == made, "run tools/docs/python_reference.py"


def test_everything_public_has_a_docstring():
    for name in broadside.__all__:
        assert name == "__version__" or getattr(broadside, name).__doc__, name


def test_the_version_is_the_library_s():
    header = (ROOT / "include/broadside/version.hpp").read_text()
    assert f'define BROADSIDE_VERSION "{broadside.__version__}"' in header
