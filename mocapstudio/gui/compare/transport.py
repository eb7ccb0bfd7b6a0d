"""The transport of the comparison: play, step, where both are, how fast, in which way."""

from __future__ import annotations

from PySide6.QtWidgets import QFrame, QHBoxLayout

from mocapstudio.gui.actions import Actions
from mocapstudio.gui.compare.bridge import CompareBridge, CompareUi
from mocapstudio.gui.widgets.parts import label
from mocapstudio.gui.widgets.speeds import SpeedButtons, next_speed
from mocapstudio.review.comparing import ComparingState


class CompareTransport(QFrame):
    """The bar below the viewports.

    Parameters
    ----------
    bridge
        Where state comes from and intents go.
    actions
        The commands behind the buttons.
    """

    def __init__(self, bridge: CompareBridge, actions: Actions) -> None:
        super().__init__()
        self.setObjectName("compare-transport")
        self.setProperty("role", "panel")
        self.setFixedHeight(40)
        self._bridge = bridge
        self._reference = label("", "readout", "reference-time")
        self._reference.setToolTip("Time of the reference, seconds since its first frame")
        self._source = label("", "readout", "source-time")
        self._source.setToolTip("Time of the chosen source, seconds since its first frame")
        for one in (self._reference, self._source):
            one.setMinimumWidth(62)
        self._speeds = SpeedButtons("compare-speed")
        self._speeds.chosen.connect(lambda speed: bridge.set_ui(speed=speed))
        row = QHBoxLayout(self)
        row.setContentsMargins(10, 4, 10, 4)
        row.setSpacing(3)
        row.addWidget(actions.tool_button("compare-path", text="Path"))
        row.addWidget(actions.tool_button("compare-live"))
        row.addStretch(1)
        for name in ("first", "frame-back", "play", "frame-on", "last"):
            row.addWidget(actions.tool_button(name))
        row.addSpacing(8)
        row.addWidget(label("Reference", "muted"))
        row.addWidget(self._reference)
        row.addWidget(label("Source", "muted"))
        row.addWidget(self._source)
        row.addStretch(1)
        row.addWidget(self._speeds)
        row.addSpacing(4)
        row.addWidget(actions.tool_button("loop"))
        bridge.changed.connect(lambda old, new: self._show(new))
        bridge.ui_changed.connect(lambda old, new: self._show_ui(new))
        self._show(bridge.state)
        self._show_ui(bridge.ui)

    def step_speed(self, by: int) -> None:
        """Play slower or faster."""
        self._bridge.set_ui(speed=next_speed(self._bridge.ui.speed, by))

    def _show(self, state: ComparingState) -> None:
        reference, source = state.reference, state.source
        self._reference.setText(
            "" if reference is None else f"{reference.seconds(state.frame):.2f} s"
        )
        self._source.setText(
            "" if source is None else f"{source.take.seconds(state.source_frame):.2f} s"
        )

    def _show_ui(self, ui: CompareUi) -> None:
        self._speeds.show_speed(ui.speed)
