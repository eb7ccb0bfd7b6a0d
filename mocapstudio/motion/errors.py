"""The one family of errors that mocapstudio raises on purpose."""

from __future__ import annotations

from pathlib import Path


class MocapError(Exception):
    """Root of every error with a message meant for the user.

    It does not derive from `RuntimeError`: Qt workers swallow that one.
    """


class FileError(MocapError):
    """A file that cannot be read or written, with the place and the cause.

    Parameters
    ----------
    path
        The file.
    cause
        What is wrong, as a phrase without a full stop.
    line
        1-based line of a text file, or None where no line is to blame.
    offset
        Byte offset in a binary file, or None.
    """

    def __init__(
        self,
        path: Path | str,
        cause: str,
        *,
        line: int | None = None,
        offset: int | None = None,
    ) -> None:
        self.path = Path(path)
        self.cause = cause
        self.line = line
        self.offset = offset
        place = f"{line}" if line is not None else (f"byte {offset}" if offset is not None else "-")
        super().__init__(f"{self.path}: {place}: {cause}")

    def __reduce__(self) -> tuple[object, ...]:
        return (_rebuild_file_error, (type(self), self.path, self.cause, self.line, self.offset))


def _rebuild_file_error(
    kind: type[FileError], path: Path, cause: str, line: int | None, offset: int | None
) -> FileError:
    return kind(path, cause, line=line, offset=offset)


class NoRateError(FileError):
    """A file that states no frame rate and leaves nothing to tell it by: the user is asked."""


class MarkersOnlyError(FileError):
    """A file of markers where joints are wanted: it has to be solved to a skeleton first."""


class SkeletonMismatchError(MocapError):
    """Two takes whose joints cannot be matched by name."""


class ParameterError(MocapError):
    """A parameter outside its bounds, or of the wrong kind."""


class CancelledError(MocapError):
    """The user asked to stop; nothing was left behind."""
