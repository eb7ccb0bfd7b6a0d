"""The transport of the workspace: play, step, frame and time, how fast."""

from __future__ import annotations

from PySide6.QtWidgets import QFrame, QHBoxLayout

from mocapstudio.gui import wording
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.markers.bridge import MarkersBridge, MarkersShown
from mocapstudio.gui.widgets.frame_field import FrameField
from mocapstudio.gui.widgets.parts import label
from mocapstudio.gui.widgets.speeds import SpeedButtons


class MarkersTransport(QFrame):
    """The bar below the viewport.

    Parameters
    ----------
    bridge
        What is shown.
    actions
        The commands behind the buttons.
    """

    def __init__(self, bridge: MarkersBridge, actions: Actions) -> None:
        super().__init__()
        self.setObjectName("markers-transport")
        self.setProperty("role", "panel")
        self.setFixedHeight(40)
        self._bridge = bridge
        self._frame = FrameField("markers-frame")
        self._frame.wanted.connect(bridge.go)
        self._time = label("", "readout", "markers-time")
        self._time.setMinimumWidth(64)
        self._time.setToolTip("Time since the take's first frame, seconds")
        self._length = label("", "muted")
        self._speeds = SpeedButtons("markers-speed")
        self._speeds.chosen.connect(lambda speed: bridge.set(speed=speed))
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
        bridge.changed.connect(lambda _old, new: self._show(new))
        self._show(bridge.shown)

    def _show(self, new: MarkersShown) -> None:
        take = new.result
        self.setEnabled(take is not None)
        self._frame.show_frame(take, new.frame)
        self._speeds.show_speed(new.speed)
        if take is not None:
            self._time.setText(wording.seconds(take, new.frame))
            self._length.setText(f"of {wording.seconds(take, take.frames)}")
