"""Buttons for how fast something is played."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QButtonGroup, QHBoxLayout, QToolButton, QWidget

from mocapstudio.gui.playback import SPEEDS

_FRACTIONS = {0.25: "¼×", 0.5: "½×", 1.0: "1×"}


class SpeedButtons(QWidget):
    """One button a speed, one of them down.

    Parameters
    ----------
    name
        Beginning of their object names.
    """

    chosen = Signal(float)
    """Emitted with the share of real time that was clicked."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self._buttons: dict[float, QToolButton] = {}
        group = QButtonGroup(self)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(3)
        for speed in SPEEDS:
            button = QToolButton()
            button.setObjectName(f"{name}-{speed:g}")
            button.setText(_FRACTIONS[speed])
            button.setCheckable(True)
            button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
            button.setToolTip(f"Play at {_FRACTIONS[speed]} real time ([ slower, ] faster)")
            button.clicked.connect(lambda _=False, speed=speed: self.chosen.emit(speed))
            group.addButton(button)
            row.addWidget(button)
            self._buttons[speed] = button

    def show_speed(self, speed: float) -> None:
        """Show which speed is in force."""
        for one, button in self._buttons.items():
            button.setChecked(one == speed)


def next_speed(speed: float, by: int) -> float:
    """Return the speed so many steps quicker, or slower where negative."""
    return SPEEDS[min(max(SPEEDS.index(speed) + by, 0), len(SPEEDS) - 1)]
