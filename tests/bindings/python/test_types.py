"""The types that are declared are those that there are."""

import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

import broadside

pytest.importorskip("mypy")

USE = """
    import numpy as np
    import broadside

    boxes = np.zeros((3, 4), np.float32)
    reveal_type(broadside.pairs(boxes))
    reveal_type(broadside.pairs([[0, 0, 1, 1]], boxes, sort=True, threads=2))
    reveal_type(broadside.pairs(boxes, output="arrow"))
    reveal_type(broadside.count(boxes, filters=broadside.filters(3)))
    world = broadside.World(2)
    begun, ended = world.update()
    reveal_type(begun)
    reveal_type(broadside.Index(boxes).nearest(boxes[:, :2], k=4).box)
    broadside.pairs(boxes, output="pandas")  # no such
    broadside.World("2")  # no number
    broadside.pairs(boxes, boxes, "grid")  # all but the boxes by name
"""


def mypy(*arguments, cwd):
    done = subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True, cwd=cwd)
    return done.stdout + done.stderr


def test_the_package_is_typed_strictly(tmp_path):
    assert "Success" in mypy("mypy", "--strict", "-p", "broadside", cwd=tmp_path)


def test_a_user_s_types_are_checked(tmp_path):
    (tmp_path / "use.py").write_text(textwrap.dedent(USE))
    said = mypy("mypy", "--strict", "use.py", cwd=tmp_path)
    assert said.count('Revealed type is "numpy.ndarray[') == 4
    assert 'Revealed type is "broadside._core.PairTable"' in said
    assert 'Revealed type is "int"' in said or 'Revealed type is "builtins.int"' in said
    assert "Found 3 errors" in said, said


def test_the_stub_has_what_the_extension_has(tmp_path):
    # What nanobind's functions take is told by their docstrings, not by a signature that stubtest could compare.
    (tmp_path / "allowed").write_text("broadside._core._Queried\n")
    said = mypy("mypy.stubtest", "broadside._core", "--allowlist", "allowed", "--ignore-positional-only", cwd=tmp_path)
    assert "Success" in said, said


def test_is_marked_as_typed():
    assert (Path(broadside.__file__).parent / "py.typed").exists()
