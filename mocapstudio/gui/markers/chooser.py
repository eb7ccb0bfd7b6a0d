"""Chooses the marker take that is shown."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox

from mocapstudio.gui.markers.bridge import MarkersBridge


class TakeChooser(QComboBox):
    """Lists the marker takes of the sitting; out of sight where there is one.

    Parameters
    ----------
    bridge
        What is shown.
    """

    def __init__(self, bridge: MarkersBridge) -> None:
        super().__init__()
        self.setObjectName("markers-take")
        self.setToolTip("The marker take that is shown")
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)
        self.setMaximumWidth(150)
        self._bridge = bridge
        self._listed: tuple[str, ...] = ()
        self.activated.connect(lambda row: bridge.show(self.itemData(row)))
        bridge.changed.connect(lambda _old, _new: self._show())
        bridge.desk.changed.connect(lambda _old, _new: self._show())
        self._show()

    def _show(self) -> None:
        ids = tuple(one.id for one in self._bridge.desk.state.markers)
        if ids != self._listed:
            self._listed = ids
            self.clear()
            for one in ids:
                self.addItem(one, one)
        self.setVisible(len(ids) > 1)
        row = self.findData(self._bridge.shown.performer)
        if row != self.currentIndex():
            self.setCurrentIndex(row)
