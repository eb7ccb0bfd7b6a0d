"""The transport: play, step, frame and time, speed, loop."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QButtonGroup,
    QFrame,
    QHBoxLayout,
    QToolButton,
    QWidget,
)

from mocapstudio.gui import wording
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.document import DocumentBridge, UiState
from mocapstudio.gui.playback import SPEEDS
from mocapstudio.gui.widgets.fields import NumberField
from mocapstudio.gui.widgets.parts import label
from mocapstudio.motion.take import Take
from mocapstudio.review.state import DocumentState

_FRACTIONS = {0.25: "¼×", 0.5: "½×", 1.0: "1×"}


class _FrameBox(NumberField):
    """The file's own frame number."""

    def __init__(self, bridge: DocumentBridge) -> None:
        super().__init__()
        self.setObjectName("frame")
        self.setToolTip("Frame, by the file's own numbers; type one and press Enter")
        self.setKeyboardTracking(False)
        self.setFixedWidth(76)
        self.setAlignment(Qt.AlignmentFlag.AlignRight)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self._bridge = bridge
        self._take: Take | None = None
        self.editingFinished.connect(self._go)

    def show_frame(self, take: Take | None, frame: int) -> None:
        """Show a frame of a take."""
        if take is not self._take:
            self._take = take
            first = 0 if take is None else take.first_frame
            self.setRange(first, first if take is None else first + take.frames - 1)
        if take is not None:
            self.setValue(wording.number(take, frame))

    def stepBy(self, steps: int) -> None:
        """Step by arrow or wheel."""
        super().stepBy(steps)
        self._go()

    def _go(self) -> None:
        if self._take is not None:
            self._bridge.document.set_frame(self.value() - self._take.first_frame)


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
        self._frame = _FrameBox(bridge)
        self._time = label("", "readout", "time")
        self._time.setMinimumWidth(64)
        self._time.setToolTip("Time since the take's first frame, seconds")
        self._length = label("", "muted", "length")
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
        bridge.changed.connect(lambda old, new: self._show(new))
        bridge.ui_changed.connect(lambda old, new: self._show_ui(new))
        self._show(bridge.state)
        self._show_ui(bridge.ui)

    def step_speed(self, by: int) -> None:
        """Play slower or faster."""
        at = SPEEDS.index(self._bridge.ui.speed) + by
        self._bridge.set_ui(speed=SPEEDS[min(max(at, 0), len(SPEEDS) - 1)])

    def _make_speed(self, speed: float) -> QWidget:
        button = QToolButton()
        button.setObjectName(f"speed-{speed:g}")
        button.setText(_FRACTIONS[speed])
        button.setCheckable(True)
        button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        button.setToolTip(f"Play at {_FRACTIONS[speed]} real time ([ slower, ] faster)")
        button.clicked.connect(lambda: self._bridge.set_ui(speed=speed))
        self._speeds.addButton(button)
        return button

    def _show(self, state: DocumentState) -> None:
        take = state.take
        self.setEnabled(take is not None)
        self._frame.show_frame(take, state.frame)
        self._time.setText("" if take is None else wording.seconds(take, state.frame))
        self._length.setText("" if take is None else f"of {wording.seconds(take, take.frames)}")

    def _show_ui(self, ui: UiState) -> None:
        for button in self._speeds.buttons():
            button.setChecked(button.objectName() == f"speed-{ui.speed:g}")
