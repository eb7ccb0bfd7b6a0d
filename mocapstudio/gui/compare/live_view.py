"""What stands below the viewports in live mode: figures, timeline, curves, matrix."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QHBoxLayout, QVBoxLayout

from mocapstudio.gui.actions import Actions
from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.live_bridge import LiveBridge
from mocapstudio.gui.compare.live_course import CostCurve, TimingCurve
from mocapstudio.gui.compare.live_matrix import LiveMatrix
from mocapstudio.gui.compare.live_readout import LiveReadout
from mocapstudio.gui.compare.live_timeline import LiveTimeline
from mocapstudio.gui.widgets.native import NativeView
from mocapstudio.gui.widgets.parts import panel

_LEFT = 250


class LiveView(NativeView):
    """Lays the parts of live mode out, in one window of their own.

    Parameters
    ----------
    bridge, live
        Where state comes from.
    actions
        The commands behind the buttons.
    """

    asked = Signal(float)
    """Second of the action that the user wants to see."""

    def __init__(self, bridge: CompareBridge, live: LiveBridge, actions: Actions) -> None:
        super().__init__()
        self.setObjectName("live-view")
        self.setProperty("role", "panel")
        self.readout = LiveReadout(bridge, live)
        self.timeline = LiveTimeline(bridge, live)
        self.timing, self.cost = TimingCurve(bridge, live), CostCurve(bridge, live)
        self.matrix = LiveMatrix(bridge, live)
        for plot in (self.timing, self.cost, self.matrix):
            plot.asked.connect(self.asked)
        middle = QVBoxLayout()
        middle.setSpacing(0)
        middle.addWidget(self.timeline)
        middle.addWidget(self.timing, 3)
        middle.addWidget(self.cost, 2)
        foot = panel("live-buttons")
        buttons = QHBoxLayout(foot)
        buttons.setContentsMargins(12, 4, 12, 8)
        buttons.setSpacing(4)
        for name, text in (("live-restart", "Restart"), ("live-wait", "Wait")):
            buttons.addWidget(actions.tool_button(name, text=text))
        buttons.addStretch(1)
        self.readout.setFixedWidth(_LEFT)
        left = QVBoxLayout()
        left.setSpacing(0)
        left.addWidget(self.readout, 1)
        left.addWidget(foot)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addLayout(left)
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
