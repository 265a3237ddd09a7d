"""The attributes that subclasses add to this package's classes, for pickle and copy."""

from __future__ import annotations

from typing import Any


def state_of(instance: object, base: type) -> tuple[dict[str, Any] | None, dict[str, Any]] | None:
    """The attributes beyond those of `base`, in the form that pickle restores; None if there are none."""
    kinds = type(instance).__mro__
    names = [name for kind in kinds[: kinds.index(base)] for name in _slots_of(kind)]
    slots = {name: getattr(instance, name) for name in names if hasattr(instance, name)}
    attributes = getattr(instance, "__dict__", None)
    return (attributes, slots) if attributes or slots else None


def _slots_of(kind: type) -> list[str]:
    found = vars(kind).get("__slots__", ())
    names = [found] if isinstance(found, str) else list(found)
    hidden = f"_{kind.__name__.lstrip('_')}"
    return [
        hidden + name if name.startswith("__") and not name.endswith("__") else name
        for name in names
        if name not in ("__dict__", "__weakref__")
    ]
