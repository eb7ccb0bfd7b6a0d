"""What does a part of the work of the Compare workspace for its commands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

if TYPE_CHECKING:
    from mocapstudio.gui.main_window import MainWindow
    from mocapstudio.gui.workspaces.compare import CompareWorkspace


class WorkspacePart(QObject):
    """Knows window and workspace.

    Parameters
    ----------
    window
        Whose dialogs are asked.
    workspace
        The workspace.
    """

    def __init__(self, window: MainWindow, workspace: CompareWorkspace) -> None:
        super().__init__(workspace)
        self._window, self._workspace = window, workspace
        self._bridge, self._messages = workspace.bridge, window.messages
