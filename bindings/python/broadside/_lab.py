"""Which algorithms there are and which suits boxes; files of boxes; drawings."""

from __future__ import annotations

import io
import os
import re
import stat
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

from numpy.typing import NDArray

from broadside import _arguments, _columns, _convert, _core, _parquet
from broadside._columns import Columns
from broadside._errors import FileError

_BYTES_AT_ONCE = 2**20


class Readable(Protocol):
    """An object with read()."""

    def read(self, size: int, /) -> bytes | str:
        """The next bytes or characters, or none at the end."""


@dataclass(frozen=True)
class Algorithm:
    """An algorithm that `pairs`, `World` and `Tracker` know by its name."""

    name: str
    summary: str
    source: str
    """The paper, book or program it is from."""
    kind: str
    """``"own"``, or ``"paper"`` for a listing that the library is compared with, which is not meant for use."""
    dimensions: tuple[int, ...]
    """2, 3 or both."""
    tunables: dict[str, tuple[str, str]]
    """By name: a summary and the standard value. A spec sets some: ``"grid:cell=2.5:threads=4"``."""


def algorithms() -> list[Algorithm]:
    """All algorithms, the library's own first."""
    return [
        Algorithm(
            name, summary, source, kind, dimensions, {tunable: (text, value) for tunable, text, value in tunables}
        )
        for name, summary, source, kind, dimensions, tunables in _core.algorithms()
    ]


@dataclass(frozen=True)
class Advice:
    """What `advise` found. Printed, it is the text that the program's ``advise`` prints."""

    algorithm: str
    """The spec that is advised; empty if there is nothing to choose."""
    milliseconds: float
    """That it takes for these boxes."""
    reasons: list[str]
    changes: list[str]
    """What would change the advice, as far as it was measured."""
    ranking: list[tuple[str, float]]
    """Each spec that was measured and its milliseconds, the best first; inf where it was too slow."""
    verified: bool
    """Whether all algorithms found the same pairs."""
    text: str

    def __str__(self) -> str:
        return self.text


@_arguments.suggests
def advise(
    boxes: Any,
    *,
    algorithms: str = "own",
    threads: int | list[int] = 1,
    budget: float = 6.0,
    columns: Columns | None = None,
) -> Advice:
    """Measures which algorithm suits these boxes, and says why. Every result is verified.

    Args:
        boxes: n boxes, whatever `pairs` takes.
        algorithms: Names, specs or groups (own, paper, literature, all) with commas between.
        threads: Numbers of threads to try besides one.
        budget: About how many seconds it may take.
        columns: The names of a table's columns of bounds, or a layout such as "xywh": see `pairs`.

    Raises InvalidAlgorithmError, InvalidBoxError, ValueError. Ctrl-C ends it, even during a long search.
    """
    budget = _arguments.number(budget, "budget")
    if not 0 < budget <= 3600:
        raise ValueError(f"budget is {budget}; expected a number of seconds above 0, at most 3600")
    tried = list(threads) if isinstance(threads, (list, tuple)) else [threads]
    if not tried:
        raise ValueError("threads is empty; expected a number at least")
    tried = [_arguments.integer(count, "threads", 1, 1024) for count in tried]
    rows = _convert.valid_boxes(boxes, "boxes", columns)
    return Advice(*_core.advise(rows, _arguments.text(algorithms, "algorithms"), tried, budget))


@_arguments.suggests
def read(
    path: str | bytes | os.PathLike[str] | os.PathLike[bytes] | Readable,
    *,
    format: str | None = None,
    boxes: str | None = None,
    columns: Columns | None = None,
    dimension: int | None = None,
    frame: int = 0,
    quarantine: bool = False,
) -> NDArray[Any]:
    """The boxes in a file: CSV, GeoJSON, .npy, PLY, OBJ, traces ..., also compressed by gzip or zstd; Parquet
    and GeoParquet, if pyarrow is installed.

    Args:
        path: The file's path, or an object with ``read()``, such as an open file or ``io.BytesIO``. Such an object is read
            from its current position to its end; its ``name``, if it has one, is used like a path. A named pipe is read
            until its writers have closed it.
        format: The format's name, such as "csv" or "parquet"; by default the file's content and name decide.
        boxes: What the boxes enclose, such as "triangles", if the format has a choice.
        columns: A list of names selects columns of a table; a layout such as "xywh" says what its numbers mean. Four or
            six names without a meaning are the minima, then the maxima. A CSV file's columns ``frame`` and ``box`` are
            read as well; if it has no names, the list gives them from left to right. A str such as "-,x,y,w,h", or a
            list with ``-``, gives them from left to right in any case; ``-`` leaves a column out.
        dimension: 2 or 3, if the format has a choice.
        frame: The frame of a recording, counted from 0.
        quarantine: Make invalid boxes absent (minima inf and maxima -inf), with a warning, instead of raising.

    Returns:
        An array of shape (n, 4) or (n, 6), of float32 or float64 as in the file. For GeoParquet, these are the bounds
        in its covering column or, if it has none, the bounds of its geometries, which needs shapely. For other Parquet,
        these are the columns of bounds, found by the names that `pairs` knows.

    Raises:
        FileNotFoundError: There is no such file.
        FileError: It cannot be read; the text says where and why. Arrays in .npz are read by ``numpy.load``, meshes of
            other formats by the program.
        ImportError: The file needs pyarrow or shapely, which is not installed.

    Cost: a file is read in place. The content of an object with ``read()`` is held in memory, and that of
    ``io.BytesIO`` is not copied.
    """
    name, content = _source_of(path)
    chosen = _columns.checked(columns, "the file")
    found: NDArray[Any]
    axes = 0 if dimension is None else _arguments.integer(dimension, "dimension", 2, 3)
    number = _arguments.integer(frame, "frame", 0, 2**32 - 1)
    wanted = _text_or_none(format, "format")
    if (content is not None or not os.path.isdir(name)) and _parquet.recognises(name, content, wanted):
        shown = os.fsdecode(name)
        if boxes is not None:
            raise ValueError(f"boxes is {boxes!r}, and '{shown}' is Parquet; expected None")
        if number != 0:
            raise ValueError(f"frame is {frame}; expected at most 0, the last one of '{shown}'")
        found, warning = _parquet.read(name, content, chosen, axes, _arguments.truth(quarantine, "quarantine"))
    else:
        try:
            found, warning = _core.read(
                name,
                content,
                wanted,
                _text_or_none(boxes, "boxes"),
                ",".join(chosen) if isinstance(chosen, list) else chosen or "",
                isinstance(chosen, list) and not isinstance(columns, str) and "-" not in chosen,
                axes,
                number,
                _arguments.truth(quarantine, "quarantine"),
            )
        except FileError as error:
            raise FileError(_in_python(str(error))) from None
    if warning:
        warnings.warn(_in_python(warning), stacklevel=2)
    return found


# The program's options in messages, and how Python says them.
_IN_PYTHON = {
    "--columns": "columns=",
    "--format csv": "format='csv'",
    "--boxes vertices": "boxes='vertices'",
    "--boxes": "boxes=",
    "--frame 0": "frame=0",
    "--skip-invalid": "quarantine=True",
}


def _in_python(text: str) -> str:
    text = re.sub(r"--columns (?:names|is) (?=')", "columns=", text)
    text = re.sub(r"--columns[= ]([\w-]+(?:[,=][\w-]+)+)", r"columns='\1'", text)
    for option, argument in _IN_PYTHON.items():
        text = text.replace(option, argument)
    return text


def _source_of(path: Any) -> tuple[bytes, _parquet.Content | None]:
    """The name of a file in errors and in the extension, and its bytes if they do not come from the file of that name."""
    if hasattr(path, "read"):
        name = getattr(path, "name", None)
        called = os.fsencode(name) if isinstance(name, (str, bytes, os.PathLike)) else b"the file object"
        return called, _content_of(path)
    if not isinstance(path, (str, bytes, os.PathLike)):
        raise TypeError(
            f"path is {_arguments.kind_of(path)}; expected the path of a file, or an object with read(). Tables and arrays "
            "need no read(): pairs() and the others take them as they are"
        )
    name = os.fsencode(path)
    mode = os.stat(os.fsdecode(name)).st_mode
    if not stat.S_ISFIFO(mode):
        return name, None
    # Unbuffered: a buffer is filled by several reads, and Python looks for Ctrl-C only before the first of them.
    with open(name, "rb", buffering=0) as pipe:
        return name, _content_of(pipe)


def _content_of(file: Any) -> _parquet.Content:
    """The rest of an open file. Ctrl-C ends Python's reading, even while it waits for a pipe."""
    if isinstance(file, io.BytesIO):
        rest = file.getbuffer()[file.tell() :]
        file.seek(0, os.SEEK_END)
        return rest
    content = bytearray()
    while True:
        piece = file.read(_BYTES_AT_ONCE)
        if isinstance(piece, str):
            piece = piece.encode()
        if not isinstance(piece, (bytes, bytearray, memoryview)):
            raise TypeError(f"read() of {type(file).__name__} gave {type(piece).__name__}; expected bytes or a str")
        if not piece:
            return content
        content += piece
        if len(content) > _most_bytes():
            raise FileError(
                f"{getattr(file, 'name', 'the file object')}: goes on after {len(content)} bytes, more than memory can hold "
                "beside its boxes; expected an end, or the path of a file, which is not copied"
            )


def _most_bytes() -> int:
    """A quarter of the memory, as the program's limit for pipes."""
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 4
    except (AttributeError, OSError, ValueError):
        return 2**32


def _text_or_none(found: str | None, name: str) -> str:
    return "" if found is None else _arguments.text(found, name)


class Drawing:
    """A picture as SVG, which notebooks show."""

    __slots__ = ("__weakref__", "svg")

    def __init__(self, svg: str) -> None:
        self.svg = svg

    def _repr_svg_(self) -> str:
        return self.svg

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the picture to a file."""
        Path(path).write_text(self.svg, encoding="utf-8")

    def __repr__(self) -> str:
        return f"broadside.Drawing({len(self.svg)} characters of SVG)"


@_arguments.suggests
def draw(
    boxes: Any, algorithms: str = "", *, most: int = 300, title: str = "boxes", columns: Columns | None = None
) -> Drawing:
    """Draws boxes, and the cells, nodes or sweep that algorithms lay over them; 3D from three sides.

    Args:
        boxes: n boxes, whatever `pairs` takes.
        algorithms: What to lay over them: a spec such as ``"quadtree:capacity=16"``, or several with commas between,
            side by side; empty: only the boxes.
        most: The maximum number of boxes drawn, up to 20,000. If there are more boxes, up to a quarter of those drawn
            are boxes far larger than most, at their own size. The others are chosen evenly and made larger, so that the
            picture looks as dense as all boxes.
        title: The title of the picture.
        columns: The names of a table's columns of bounds, or a layout such as "xywh": see `pairs`.

    Raises InvalidBoxError, InvalidAlgorithmError, ValueError.
    """
    most = _arguments.integer(most, "most", 1, 20_000)
    laid_over = _arguments.text(algorithms, "algorithms")
    return Drawing(
        _core.draw(_convert.valid_boxes(boxes, "boxes", columns), laid_over, most, _arguments.text(title, "title"))
    )
