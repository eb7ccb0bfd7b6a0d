"""What stands below the viewports in live mode: figures, timeline, curves, matrix."""

from __future__ import annotations

from PySide6.QtCore import QEvent
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QVBoxLayout, QWidget

from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.live_bridge import LiveBridge
from mocapstudio.gui.compare.live_course import CostCurve, TimingCurve
from mocapstudio.gui.compare.live_matrix import LiveMatrix
from mocapstudio.gui.compare.live_readout import LiveReadout
from mocapstudio.gui.compare.live_timeline import LiveTimeline

_LEFT = 250


class LiveView(QFrame):
    """Lays the parts of live mode out.

    Parameters
    ----------
    bridge, live
        Where state comes from.
    """

    def __init__(self, bridge: CompareBridge, live: LiveBridge) -> None:
        super().__init__()
        self.setObjectName("live-view")
        self.setProperty("role", "panel")
        self.readout = LiveReadout(bridge, live)
        self.timeline = LiveTimeline(bridge, live)
        self.timing, self.cost = TimingCurve(bridge, live), CostCurve(bridge, live)
        self.matrix = LiveMatrix(bridge, live)
        middle = QVBoxLayout()
        middle.setSpacing(0)
        middle.addWidget(_room(self.timeline))
        middle.addWidget(_room(self.timing), 3)
        middle.addWidget(_room(self.cost), 2)
        self._left, self._right = _room(self.readout), _room(self.matrix)
        self._left.setFixedWidth(_LEFT)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addWidget(self._left)
        row.addLayout(middle, 1)
        row.addWidget(self._right)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the matrix about square."""
        super().resizeEvent(event)
        self._right.setFixedWidth(min(max(self.height(), 240), round(0.32 * self.width())))

    def changeEvent(self, event: QEvent) -> None:
        """Follow the theme."""
        super().changeEvent(event)
        if event.type() in (QEvent.Type.StyleChange, QEvent.Type.PaletteChange):
            for one in (self.readout, self.timeline, self.timing, self.cost, self.matrix):
                one.update()


def _room(view: QWidget) -> QWidget:
    """A parent of its own for a view with a window of its own, which fills it."""
    parent = QWidget()
    inner = QVBoxLayout(parent)
    inner.setContentsMargins(0, 0, 0, 0)
    inner.addWidget(view)
    return parent
