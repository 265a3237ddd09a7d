"""Writes the reference of the Python package, docs/python-api.md, from its docstrings: python_reference.py [FILE]."""

from __future__ import annotations

import inspect
import sys
from pathlib import Path

import broadside
import broadside.dask

HEAD = """\
# Python reference

Made from the docstrings by `tools/docs/python_reference.py`; [python.md](python.md) shows how things are used.
"""


def signature_of(function: object) -> str:
    signature = inspect.signature(function)
    plain = [parameter.replace(annotation=inspect.Parameter.empty) for parameter in signature.parameters.values()]
    shown = [parameter for parameter in plain if parameter.name != "self"]
    return str(signature.replace(parameters=shown, return_annotation=inspect.Signature.empty))


def text_of(documented: object) -> str:
    return inspect.cleandoc(documented.__doc__ or "")


def members_of(kind: type) -> list[tuple[str, object]]:
    kinds = [one for one in reversed(kind.__mro__) if one is kind or one.__name__.startswith("_")]
    own = [(name, member) for one in kinds for name, member in vars(one).items() if not name.startswith("_")]
    return [(name, member) for name, member in own if getattr(member, "__doc__", None)]


def described(kind: type) -> str:
    parts = [f"## {kind.__name__}", text_of(kind)]
    fields = getattr(kind, "_fields", None) or tuple(getattr(kind, "__dataclass_fields__", ()))
    if fields:
        parts.append("Fields: " + ", ".join(f"`{field}`" for field in fields) + ".")
    for name, member in members_of(kind):
        if name in fields:
            continue
        if isinstance(member, property):
            parts += [f"### {kind.__name__}.{name}", text_of(member)]
        elif inspect.isfunction(member):
            parts += [f"### {kind.__name__}.{name}{signature_of(member)}", text_of(member)]
    return "\n\n".join(parts)


def fenced(text: str) -> str:
    """Sections such as "Args:" keep their lines as they are."""
    blocks = []
    for block in text.split("\n\n"):
        first = block.split("\n", 1)[0]
        blocks.append(f"```text\n{block}\n```" if first.endswith(":") and "\n    " in block else block)
    return "\n\n".join(blocks)


def reference() -> str:
    functions = [name for name in broadside.__all__ if inspect.isfunction(getattr(broadside, name))]
    classes = [name for name in broadside.__all__ if inspect.isclass(getattr(broadside, name))]
    parts = [HEAD.strip(), text_of(broadside)]
    for name in sorted(functions):
        function = getattr(broadside, name)
        parts += [f"## {name}{signature_of(function)}", text_of(function)]
    parts += [described(getattr(broadside, name)) for name in sorted(classes)]
    parts += ["## broadside.dask", text_of(broadside.dask)]
    for name in broadside.dask.__all__:
        function = getattr(broadside.dask, name)
        parts += [f"### dask.{name}{signature_of(function)}", text_of(function)]
    return fenced("\n\n".join(parts)) + "\n"


if __name__ == "__main__":
    Path(sys.argv[1] if len(sys.argv) > 1 else "docs/python-api.md").write_text(reference(), encoding="utf-8")
