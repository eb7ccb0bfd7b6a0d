"""The transport of the workspace: play, step, frame and time, how fast."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QButtonGroup, QFrame, QHBoxLayout, QToolButton, QWidget

from mocapstudio.gui import wording
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.markers.bridge import MarkersBridge, MarkersShown
from mocapstudio.gui.playback import SPEEDS
from mocapstudio.gui.widgets.fields import NumberField
from mocapstudio.gui.widgets.parts import label

_FRACTIONS = {0.25: "¼×", 0.5: "½×", 1.0: "1×"}


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
        self._frame = self._make_field()
        self._time = label("", "readout", "markers-time")
        self._time.setMinimumWidth(64)
        self._time.setToolTip("Time since the take's first frame, seconds")
        self._length = label("", "muted")
        self._speeds = QButtonGroup(self)
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
        for speed in SPEEDS:
            row.addWidget(self._make_speed(speed))
        row.addSpacing(4)
        row.addWidget(actions.tool_button("loop"))
        bridge.changed.connect(self._follow)
        self._follow(MarkersShown(), bridge.shown)

    def _make_field(self) -> NumberField:
        field = NumberField()
        field.setObjectName("markers-frame")
        field.setToolTip("Frame, by the file's own numbers; type one and press Enter")
        field.setKeyboardTracking(False)
        field.setFixedWidth(76)
        field.setAlignment(Qt.AlignmentFlag.AlignRight)
        field.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        field.valueChanged.connect(self._go)
        return field

    def _make_speed(self, speed: float) -> QWidget:
        button = QToolButton()
        button.setObjectName(f"markers-speed-{speed:g}")
        button.setText(_FRACTIONS[speed])
        button.setCheckable(True)
        button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        button.setToolTip(f"Play at {_FRACTIONS[speed]} real time ([ slower, ] faster)")
        button.clicked.connect(lambda: self._bridge.set(speed=speed))
        self._speeds.addButton(button)
        return button

    def _go(self, number: int) -> None:
        take = self._bridge.shown.result
        if take is not None:
            self._bridge.go(number - take.first_frame)

    def _follow(self, old: MarkersShown, new: MarkersShown) -> None:
        take = new.result
        self.setEnabled(take is not None)
        if take is not None:
            if old.source is not new.source:
                self._frame.setRange(take.first_frame, take.first_frame + take.frames - 1)
            self._frame.setValue(wording.number(take, new.frame))
            self._time.setText(wording.seconds(take, new.frame))
            self._length.setText(f"of {wording.seconds(take, take.frames)}")
        for button in self._speeds.buttons():
            button.setChecked(button.objectName() == f"markers-speed-{new.speed:g}")
