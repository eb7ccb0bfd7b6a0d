"""The bar of a play head: play, step, frame and time, speed, loop."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtWidgets import QFrame, QHBoxLayout

from mocapstudio.formats import Recording
from mocapstudio.gui import wording
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.widgets.frame_field import FrameField
from mocapstudio.gui.widgets.parts import label
from mocapstudio.gui.widgets.speeds import SpeedButtons


class TransportBar(QFrame):
    """Buttons, fields and read-outs of one take's play head.

    Parameters
    ----------
    actions
        The commands behind the buttons.
    go
        Is called with the 0-based frame that is wanted.
    play_at
        Is called with the share of real time that is wanted.
    prefix
        Begins the object names of its parts.
    """

    def __init__(
        self,
        actions: Actions,
        go: Callable[[int], object],
        play_at: Callable[[float], object],
        prefix: str = "",
    ) -> None:
        super().__init__()
        self.setObjectName(f"{prefix}transport")
        self.setProperty("role", "panel")
        self.setFixedHeight(40)
        self._frame = FrameField(f"{prefix}frame")
        self._frame.wanted.connect(go)
        self._time = label("", "readout", f"{prefix}time")
        self._time.setMinimumWidth(64)
        self._time.setToolTip("Time since the take's first frame, seconds")
        self._length = label("", "muted", f"{prefix}length")
        self._speeds = SpeedButtons(f"{prefix}speed")
        self._speeds.chosen.connect(play_at)
        self._lay_out(actions)

    def show_frame(self, take: Recording | None, frame: int) -> None:
        """Show a 0-based frame of a take; without one nothing can be done."""
        self.setEnabled(take is not None)
        self._frame.show_frame(take, frame)
        self._time.setText("" if take is None else wording.seconds(take, frame))
        self._length.setText("" if take is None else f"of {wording.seconds(take, take.frames)}")

    def show_speed(self, speed: float) -> None:
        """Show which share of real time is in force."""
        self._speeds.show_speed(speed)

    def _lay_out(self, actions: Actions) -> None:
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
