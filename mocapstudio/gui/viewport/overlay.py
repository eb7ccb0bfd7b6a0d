"""What lies over the picture: take and time, legend, and a slim bar of views. Qt, not VTK."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QToolButton, QVBoxLayout, QWidget

from mocapstudio.gui import theme
from mocapstudio.gui.viewport.palette import Colour

_ICON = QSize(18, 18)


class Caption(QWidget):
    """Name of the take, and below it the frame and time."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._name, self._time = QLabel(self), QLabel(self)
        self._whole, self._room = "", 10_000
        self._name.setTextFormat(Qt.TextFormat.PlainText)
        self._time.setFont(theme.numbers_font())
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 10, 12, 8)
        column.setSpacing(1)
        column.addWidget(self._name)
        column.addWidget(self._time)
        self.restyle()

    def restyle(self) -> None:
        """Take on the theme in force."""
        now = theme.current()
        clear = "background: transparent;"
        self._name.setStyleSheet(f"{clear} color: {now.text}; font-weight: 600;")
        self._time.setStyleSheet(f"{clear} color: {now.muted};")

    def tell(self, name: str, time: str) -> None:
        """Show another name or time."""
        if name != self._whole:
            self._whole = name
            self.fit(self._room)
        self._time.setText(time)
        # Only ever wider: no new layout for every frame.
        if self._time.sizeHint().width() > self._time.minimumWidth():
            self._time.setMinimumWidth(self._time.sizeHint().width())

    def fit(self, width: int) -> None:
        """Shorten the name, in its middle, to so many pixels."""
        self._room = width
        # The type in force is the style sheet's, which comes with the polish.
        self._name.ensurePolished()
        metrics = self._name.fontMetrics()
        self._name.setText(
            metrics.elidedText(self._whole, Qt.TextElideMode.ElideMiddle, max(width - 24, 60))
        )


class Legend(QLabel):
    """Which colour stands for what, of what is on stage."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setTextFormat(Qt.TextFormat.RichText)
        self.setContentsMargins(12, 6, 12, 9)

    def tell(self, lines: Sequence[tuple[str, Colour]], scale: str) -> None:
        """Show names with their colours, and the size of the floor's squares."""
        now = theme.current()
        parts = [
            f'<span style="color: rgb{colour};">●</span>&nbsp;{escape(name)}'
            for name, colour in lines
        ]
        parts.append(f'<span style="color: {now.faint};">▦</span>&nbsp;{escape(scale)}')
        self.setStyleSheet(f"background: transparent; color: {now.muted};")
        self.setText("&nbsp;&nbsp;&nbsp;".join(parts))


class Bar(QFrame):
    """A slim row of buttons, one an action; None makes a gap."""

    def __init__(self, parent: QWidget, actions: Sequence[QAction | None]) -> None:
        super().__init__(parent)
        row = QHBoxLayout(self)
        row.setContentsMargins(3, 3, 3, 3)
        row.setSpacing(1)
        for action in actions:
            if action is None:
                row.addSpacing(6)
                continue
            button = QToolButton(self)
            button.setDefaultAction(action)
            button.setIconSize(_ICON)
            button.setAutoRaise(True)
            button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
            row.addWidget(button)
        self.restyle()

    def restyle(self) -> None:
        """Take on the theme in force."""
        now = theme.current()
        self.setStyleSheet(
            f"Bar {{ background: {now.panel}; border: 1px solid {now.border};"
            " border-radius: 7px; }"
            " QToolButton { border: none; border-radius: 5px; padding: 3px; }"
            f" QToolButton:hover {{ background: {now.raised}; }}"
            f" QToolButton:checked {{ background: {now.selection}; }}"
        )
