"""What this package raises beside Python's own errors."""

from __future__ import annotations


class InvalidBoxError(ValueError):
    """A box with a NaN, or with a minimum greater than its maximum.

    ``row`` is the row of the first such box, and ``argument`` is the name of the argument that holds it: "boxes" or
    "other", or "velocities" if a velocity is not finite.
    """

    def __init__(self, message: str, row: int | None = None, argument: str | None = None) -> None:
        super().__init__(message)
        self.row = row
        self.argument = argument

    def __reduce__(self) -> tuple[type[InvalidBoxError], tuple[str, int | None, str | None]]:
        return type(self), (str(self), self.row, self.argument)


class InvalidQueryError(ValueError):
    """A query with a NaN, or with an infinity where none is allowed. The text names the query's row."""


class InvalidAlgorithmError(ValueError):
    """An algorithm that does not exist, or a tunable that the algorithm does not have or whose value is out of
    range."""


class InvalidHandleError(ValueError):
    """A handle that names no box of this world: never issued, removed, or another world's."""


class InvalidSnapshotError(ValueError):
    """Bytes that are not a snapshot of a world like this one."""


class FileError(ValueError):
    """A file that cannot be read. The text names the place in it, what was found and what was expected."""
