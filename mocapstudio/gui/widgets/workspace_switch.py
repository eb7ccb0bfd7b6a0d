"""The segmented control that brings a workspace to the front."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QToolButton


class WorkspaceSwitch(QFrame):
    """Buttons side by side in one frame, one of them on.

    Parameters
    ----------
    buttons
        One for each workspace.
    """

    def __init__(self, buttons: Sequence[QToolButton]) -> None:
        super().__init__()
        self.setObjectName("workspace-switch")
        self.setProperty("role", "segments")
        row = QHBoxLayout(self)
        row.setContentsMargins(2, 2, 2, 2)
        row.setSpacing(1)
        for button in buttons:
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextOnly)
            row.addWidget(button)
