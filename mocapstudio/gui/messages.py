"""What the desk has to tell the user, from wherever it comes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from mocapstudio.gui.trouble import Trouble, understand


@dataclass(frozen=True)
class Link:
    """Where a note leads on.

    Parameters
    ----------
    text, tip
        What it says, and what it does.
    go
        Goes there.
    """

    text: str
    tip: str
    go: Callable[[], object]


class Messages(QObject):
    """Notes for the status bar, and troubles for a dialog."""

    told = Signal(str, object)
    """A note, and the file it is about, a `Link`, or None."""

    troubled = Signal(object)
    """A tuple of `Trouble`."""

    def tell(self, text: str, about: Path | Link | None = None) -> None:
        """Tell something that needs no answer."""
        self.told.emit(text, about)

    def complain(self, error: BaseException, doing: str) -> None:
        """Tell what went wrong."""
        self.troubled.emit((understand(error, doing),))

    def complain_of(self, troubles: Sequence[Trouble]) -> None:
        """Tell several things that went wrong at once."""
        if troubles:
            self.troubled.emit(tuple(troubles))
