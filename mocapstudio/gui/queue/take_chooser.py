"""Chooses the take under review among those of the scene."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import QComboBox

from mocapstudio.gui import icons
from mocapstudio.gui.document import DocumentBridge, UiState
from mocapstudio.review.model import Performer, Scene
from mocapstudio.review.state import DocumentState


class TakeChooser(QComboBox):
    """Lists the performers; partners have a sign of their own.

    Parameters
    ----------
    bridge
        The document's door.
    """

    def __init__(self, bridge: DocumentBridge) -> None:
        super().__init__()
        self.setObjectName("active-take")
        self.setToolTip("The take under review")
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)
        self.setMaximumWidth(170)
        self._bridge = bridge
        self._scene: Scene | None = None
        self.activated.connect(lambda row: bridge.document.set_active(self.itemData(row)))
        bridge.changed.connect(lambda old, new: self._show(new))
        bridge.ui_changed.connect(self._show_ui)
        self._show(bridge.state)

    def _show(self, state: DocumentState) -> None:
        if state.scene is not self._scene:
            self._scene = state.scene
            self.clear()
            for one in state.scene.performers:
                self.addItem(_sign(one), one.id, one.id)
        row = self.findData(state.active)
        if row != self.currentIndex():
            self.setCurrentIndex(row)

    def _show_ui(self, old: UiState, new: UiState) -> None:
        if old.theme != new.theme:
            for row, one in enumerate(self._bridge.state.scene.performers):
                self.setItemIcon(row, _sign(one))


def _sign(performer: Performer) -> QIcon:
    return icons.icon("partner" if performer.partner else "take")
