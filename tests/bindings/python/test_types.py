"""The types that are declared are those that there are."""

import ast
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

import broadside
from broadside import _core

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


def test_the_types_of_the_package_are_those_at_run_time(tmp_path):
    # Leaves out the extension: stubtest does not know nanobind's functions. The next test checks them.
    (tmp_path / "allowed").write_text(r"broadside\._core\..*" + "\n")
    said = mypy("mypy.stubtest", "broadside", "--allowlist", "allowed", "--ignore-unused-allowlist", cwd=tmp_path)
    assert "Success" in said, said


def test_the_stub_has_what_the_extension_has():
    # By name: what nanobind's functions take is not told by a signature that stubtest could compare.
    stub = ast.parse((Path(broadside.__file__).parent / "_core.pyi").read_text())
    classes = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef)}
    names = {node.name for node in stub.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
    names |= {node.target.id for node in stub.body if isinstance(node, ast.AnnAssign)}
    there = {name for name in dir(_core) if not name.startswith("_") or name == "__version__"}
    assert names - {"_Queried"} == there
    for name in there & set(classes):
        node = classes[name]
        bodies = [node, *(classes[base.id] for base in node.bases)]
        declared = {method.name for body in bodies for method in body.body if isinstance(method, ast.FunctionDef)}
        own = {key for key in vars(getattr(_core, name)) if not key.startswith("_") or key.startswith(("__arrow", "__len"))}
        assert declared == own, name


def test_is_marked_as_typed():
    assert (Path(broadside.__file__).parent / "py.typed").exists()
