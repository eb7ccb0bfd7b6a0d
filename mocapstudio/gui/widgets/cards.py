"""Cards: a thing in a list with its title, some lines and buttons."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QToolButton, QVBoxLayout

from mocapstudio.gui import icons
from mocapstudio.gui.widgets.parts import ElidedLabel, label, panel


def make_card(title: str, lines: list[str], *, muted: bool = False) -> tuple[QFrame, QHBoxLayout]:
    """Make a card of a title and lines; returns it and the row that buttons are added to."""
    made = panel("", "card")
    row = QHBoxLayout(made)
    row.setContentsMargins(10, 7, 6, 7)
    row.setSpacing(2)
    words = QVBoxLayout()
    words.setSpacing(2)
    head = ElidedLabel()
    head.setProperty("role", "muted" if muted else "title")
    head.show_text(f"{title} (off)" if muted else title)
    words.addWidget(head)
    for line in lines:
        one: QLabel = label(line, "faint" if muted else "muted", wrap=True)
        words.addWidget(one)
    row.addLayout(words, 1)
    return made, row


def icon_button(icon: str, tip: str, name: str) -> QToolButton:
    """Make a button of an icon."""
    button = QToolButton()
    button.setObjectName(name)
    button.setIcon(icons.icon(icon))
    button.setToolTip(tip)
    button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    return button
