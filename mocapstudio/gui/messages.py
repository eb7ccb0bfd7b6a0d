"""What the desk has to tell the user, from wherever it comes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from mocapstudio.gui.trouble import Trouble, understand


class Messages(QObject):
    """Notes for the status bar, and troubles for a dialog."""

    told = Signal(str, object)
    """A note, and the file it is about or None."""

    troubled = Signal(object)
    """A tuple of `Trouble`."""

    def tell(self, text: str, file: Path | None = None) -> None:
        """Tell something that needs no answer."""
        self.told.emit(text, file)

    def complain(self, error: BaseException, doing: str) -> None:
        """Tell what went wrong."""
        self.troubled.emit((understand(error, doing),))

    def complain_of(self, troubles: Sequence[Trouble]) -> None:
        """Tell several things that went wrong at once."""
        if troubles:
            self.troubled.emit(tuple(troubles))
