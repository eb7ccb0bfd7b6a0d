"""The transport: play, step, frame and time, speed, loop."""

from __future__ import annotations

from PySide6.QtWidgets import QFrame, QHBoxLayout

from mocapstudio.gui import wording
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.document import DocumentBridge, UiState
from mocapstudio.gui.widgets.frame_field import FrameField
from mocapstudio.gui.widgets.parts import label
from mocapstudio.gui.widgets.speeds import SpeedButtons, next_speed
from mocapstudio.review.state import DocumentState


class TransportView(QFrame):
    """The bar between viewport and digression map.

    Parameters
    ----------
    bridge
        The document's door.
    actions
        The commands behind the buttons.
    """

    def __init__(self, bridge: DocumentBridge, actions: Actions) -> None:
        super().__init__()
        self.setObjectName("transport")
        self.setProperty("role", "panel")
        self.setFixedHeight(40)
        self._bridge = bridge
        self._frame = FrameField("frame")
        self._frame.wanted.connect(lambda frame: bridge.document.set_frame(frame))
        self._time = label("", "readout", "time")
        self._time.setMinimumWidth(64)
        self._time.setToolTip("Time since the take's first frame, seconds")
        self._length = label("", "muted", "length")
        self._speeds = SpeedButtons("speed")
        self._speeds.chosen.connect(lambda speed: bridge.set_ui(speed=speed))
        row = QHBoxLayout(self)
        row.setContentsMargins(10, 4, 10, 4)
        row.setSpacing(3)
        row.addStretch(1)
        for name in ("first", "frame-back", "play", "frame-on", "last"):
            row.addWidget(actions.tool_button(name))
        row.addSpacing(8)
        row.addWidget(label("Frame", "muted"))
        row.addSpacing(3)
        row.addWidget(self._frame)
        row.addSpacing(4)
        row.addWidget(self._time)
        row.addWidget(self._length)
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

    def _show(self, state: DocumentState) -> None:
        take = state.take
        self.setEnabled(take is not None)
        self._frame.show_frame(take, state.frame)
        self._time.setText("" if take is None else wording.seconds(take, state.frame))
        self._length.setText("" if take is None else f"of {wording.seconds(take, take.frames)}")

    def _show_ui(self, ui: UiState) -> None:
        self._speeds.show_speed(ui.speed)
