"""The Compare workspace: performances beside a reference."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from PySide6.QtWidgets import QVBoxLayout

from mocapstudio.gui.workspaces.workspace import Answers, Workspace

if TYPE_CHECKING:
    from mocapstudio.gui.main_window import MainWindow


class CompareWorkspace(Workspace):
    """One reference and up to eight sources.

    Parameters
    ----------
    window
        The desk.
    """

    needs_take = False

    def __init__(self, window: MainWindow) -> None:
        super().__init__()
        self.setObjectName("compare")
        self._window = window
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)

    def answers(self) -> Answers:
        """Answer the shared commands."""
        return Answers(alone=True)

    def zones(self, opened: bool) -> Sequence[str]:
        """Files are dropped as reference or as sources."""
        return ("reference", "sources")
