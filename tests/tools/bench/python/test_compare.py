"""Each installed library finds the pairs; one that is not installed is left out by name."""

from __future__ import annotations

import pathlib
import subprocess
import sys

import pytest

pytest.importorskip("broadside")

import compare
from libraries import LIBRARIES
from rounds import Case, Runner


@pytest.mark.parametrize("library", LIBRARIES, ids=lambda library: library.name)
def test_library_finds_the_pairs(library):
    found = compare.availability(library)
    if found.startswith("left out"):
        pytest.skip(found)
    runner = Runner(library, 1)
    for dimension in library.dimensions:
        for kind in library.kinds:
            result = compare.compare([runner], Case(300, dimension, kind), 1, 60.0, 60.0)[library.name]
            assert (result.note, len(result.times)) == ("", 1)
    runner.stop()


def test_names_what_is_not_installed_and_how_to_install_it(monkeypatch):
    monkeypatch.setattr(compare, "version", lambda package: None)
    by_name = {library.name: compare.availability(library) for library in LIBRARIES}
    assert by_name["ipctk LBVH"].startswith("left out: ipctk not installed (`pip install ipctk==")
    assert "duckdb-extension-spatial==" in by_name["DuckDB SPATIAL_JOIN"]


def test_prints_a_table():
    script = pathlib.Path(compare.__file__)
    command = [sys.executable, script, "--boxes", "100", "--rounds", "1", "--libraries", "scipy", "--kinds", "one set"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=200)
    assert done.returncode == 0, done.stderr
    assert "- broadside: broadside " in done.stdout
    assert "| 100 | 3D | one set | broadside |" in done.stdout
