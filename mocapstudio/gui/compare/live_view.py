"""What stands below the viewports in live mode: figures, timeline, curves, matrix."""

from __future__ import annotations

from PySide6.QtCore import QEvent
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout

from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.live_bridge import LiveBridge
from mocapstudio.gui.compare.live_course import CostCurve, TimingCurve
from mocapstudio.gui.compare.live_matrix import LiveMatrix
from mocapstudio.gui.compare.live_readout import LiveReadout
from mocapstudio.gui.compare.live_timeline import LiveTimeline
from mocapstudio.gui.widgets.native import NativeView

_LEFT = 250


class LiveView(NativeView):
    """Lays the parts of live mode out, in one window of their own.

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
        middle.addWidget(self.timeline)
        middle.addWidget(self.timing, 3)
        middle.addWidget(self.cost, 2)
        self.readout.setFixedWidth(_LEFT)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addWidget(self.readout)
        row.addLayout(middle, 1)
        row.addWidget(self.matrix)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Keep the matrix about square."""
        super().resizeEvent(event)
        self.matrix.setFixedWidth(min(max(self.height(), 240), round(0.32 * self.width())))

    def changeEvent(self, event: QEvent) -> None:
        """Follow the theme."""
        super().changeEvent(event)
        if event.type() in (QEvent.Type.StyleChange, QEvent.Type.PaletteChange):
            for one in (self.readout, self.timeline, self.timing, self.cost, self.matrix):
                one.update()
