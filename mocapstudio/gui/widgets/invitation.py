"""The area in the middle of an empty workspace: what is done there, and how to begin."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from mocapstudio.gui import icons, theme
from mocapstudio.gui.widgets.parts import label


class Invitation(QWidget):
    """A framed picture, title, words and buttons; drops are taken by the window.

    Parameters
    ----------
    name
        Of the workspace: that of its icon, and the beginning of the object names.
    width
        Of the frame, pixels.
    lines
        Lines of words that there is room for.
    buttons
        What there is to begin with.
    """

    def __init__(self, name: str, width: int, lines: int, buttons: Sequence[QPushButton]) -> None:
        super().__init__()
        self.setObjectName(f"{name}-empty")
        self._name = name
        self._picture = QLabel()
        self._area = QFrame()
        self._area.setObjectName(f"{name}-drop")
        self._area.setFixedWidth(width)
        self._title = label("", "heading", f"{name}-hint")
        self._words = label("", "muted", f"{name}-words", wrap=True)
        # A layout that is aligned in another one does not ask for the height of wrapped words.
        self._words.setMinimumHeight(lines * self._words.fontMetrics().lineSpacing() + 6)
        self._lay_out(buttons)
        self.restyle()

    def say(self, title: str, words: str) -> None:
        """Show a title and the words below it."""
        self._title.setText(title)
        self._words.setText(words)

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        now = theme.current()
        self._picture.setPixmap(icons.pixmap(self._name, 56, now.accent))
        self._area.setStyleSheet(
            f"#{self._area.objectName()} {{ border: 2px dashed {now.border};"
            f" border-radius: 14px; background: {now.panel}; }}"
        )

    def _lay_out(self, buttons: Sequence[QPushButton]) -> None:
        column = QVBoxLayout(self._area)
        column.setContentsMargins(40, 34, 40, 30)
        column.setSpacing(10)
        for one in (self._picture, self._title, self._words):
            one.setAlignment(Qt.AlignmentFlag.AlignCenter)
            column.addWidget(one)
        column.addSpacing(10)
        row = QHBoxLayout()
        row.setSpacing(8)
        row.addStretch(1)
        for button in buttons:
            row.addWidget(button)
        row.addStretch(1)
        column.addLayout(row)
        whole = QVBoxLayout(self)
        whole.addStretch(2)
        whole.addWidget(self._area, 0, Qt.AlignmentFlag.AlignHCenter)
        whole.addStretch(3)
