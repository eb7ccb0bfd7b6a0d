"""What every workspace is to the desk."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QWidget


@dataclass(frozen=True)
class Answers:
    """What a workspace makes of the commands while it is in front.

    Parameters
    ----------
    slots
        What it does itself, by command; all others go where they go in the Review workspace.
    allowed
        Which of those can be done now; what is not named can.
    checked
        Which of its switches are on.
    playing
        Whether its play head runs, or None where the document's play head is meant.
    undo, redo
        What Undo and Redo would do, or None for nothing; only where `slots` holds them.
    alone
        Whether commands about the take under review have no place here.
    """

    slots: Mapping[str, Callable[[], object]] = field(default_factory=dict)
    allowed: Mapping[str, bool] = field(default_factory=dict)
    checked: Mapping[str, bool] = field(default_factory=dict)
    playing: bool | None = None
    undo: str | None = None
    redo: str | None = None
    alone: bool = False


class Workspace(QWidget):
    """One kind of work; it fills the window below the toolbar."""

    answers_changed = Signal()
    """Emitted when `answers` would say something else."""

    needs_take = True
    """Whether it has nothing to show before a take is open for review."""

    def answers(self) -> Answers:
        """Say which commands it answers, and which of them can be done now."""
        return Answers()

    def tools(self) -> Sequence[QWidget]:
        """Return what it adds to the toolbar; asked once."""
        return ()

    def zones(self, opened: bool) -> Sequence[str]:
        """Return where files may be dropped, as names of `drop_zones.ZONES`.

        Parameters
        ----------
        opened
            Whether a take is open for review.
        """
        return ("open", "partner", "context") if opened else ("open",)

    def drop(self, zone: str, paths: Sequence[Path]) -> bool:
        """Take dropped files; False leaves them to the desk."""
        return False

    def open_paths(self, paths: Sequence[Path]) -> bool:
        """Take files that were chosen from the recent ones; False leaves them to the desk."""
        return False

    def enter(self) -> None:
        """Come to the front."""

    def leave(self) -> None:
        """Go out of sight: stop what runs."""

    def hold_back(self, close: Callable[[], object]) -> bool:
        """Ask before the window closes over what is not saved, and call `close` if it may.

        False where there is nothing to ask.
        """
        return False

    def remember(self) -> None:
        """Remember the layout."""
