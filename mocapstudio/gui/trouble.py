"""What an exception means to the user: file, line, cause, and the details for a report."""

from __future__ import annotations

import traceback
from dataclasses import dataclass

from mocapstudio.motion.errors import FileError, MocapError


@dataclass(frozen=True)
class Trouble:
    """One problem, ready to be shown.

    Parameters
    ----------
    title
        What could not be done.
    cause
        Why, in the words of the error.
    file, place
        Where, or "".
    details
        Traceback of an internal fault, or "" where the user's input is to blame.
    """

    title: str
    cause: str
    file: str = ""
    place: str = ""
    details: str = ""

    @property
    def line(self) -> str:
        """The whole on one line, as the command line prints it."""
        parts = (self.file, self.place, self.cause)
        return ": ".join(part for part in parts if part)


def understand(error: BaseException, doing: str) -> Trouble:
    """Say what an exception means.

    Parameters
    ----------
    error
        What was raised.
    doing
        What was being attempted, such as "The take could not be opened".
    """
    if isinstance(error, FileError):
        place = ""
        if error.line is not None:
            place = f"line {error.line}"
        elif error.offset is not None:
            place = f"byte {error.offset}"
        return Trouble(doing, error.cause, str(error.path), place)
    if isinstance(error, OSError) and error.filename is not None:
        return Trouble(doing, error.strerror or str(error), str(error.filename))
    if isinstance(error, MocapError):
        return Trouble(doing, str(error))
    if isinstance(error, MemoryError):
        return Trouble(doing, "there is not enough memory")
    cause = f"internal fault: {type(error).__name__}: {error}"
    return Trouble(doing, cause, details="".join(traceback.format_exception(error)))
