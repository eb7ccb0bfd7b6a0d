"""All keys on one page."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QVBoxLayout,
    QWidget,
)

from mocapstudio.gui.commands import MENUS, Command
from mocapstudio.gui.widgets.parts import label, panel

_COLUMNS = (("Fla&g", "&Neighbour"), ("&Play", "&Analysis", "&Help"), ("&File", "&Edit", "&View"))


class ShortcutsDialog(QDialog):
    """Lists the keys of all commands, by menu."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("shortcuts-dialog")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle("Keyboard shortcuts")
        column = QVBoxLayout(self)
        column.setContentsMargins(22, 18, 22, 14)
        column.setSpacing(14)
        row = QHBoxLayout()
        row.setSpacing(34)
        for menus in _COLUMNS:
            stack = QVBoxLayout()
            stack.setSpacing(12)
            for menu in menus:
                stack.addWidget(_group(menu))
            stack.addStretch(1)
            row.addLayout(stack)
        column.addLayout(row)
        column.addWidget(
            label(
                "Viewport: drag turns, Shift-drag pans, the wheel zooms, a click selects a joint.\n"
                "Map: a click goes there, Shift-drag selects joints and span, the wheel zooms.",
                "muted",
            )
        )
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        buttons.rejected.connect(self.reject)
        column.addWidget(buttons)


def _group(menu: str) -> QFrame:
    group = panel("", "")
    grid = QGridLayout(group)
    grid.setContentsMargins(0, 0, 0, 0)
    grid.setHorizontalSpacing(18)
    grid.setVerticalSpacing(4)
    grid.addWidget(label(menu.replace("&", "").upper(), "section"), 0, 0, 1, 2)
    keyed = [one for one in MENUS[menu] if one.keys]
    for row, command in enumerate(keyed, start=1):
        grid.addWidget(label(command.text.replace("&", "").rstrip("…")), row, 0)
        keys = label(_keys(command), "muted")
        grid.addWidget(keys, row, 1, Qt.AlignmentFlag.AlignRight)
    return group


def _keys(command: Command) -> str:
    style = QKeySequence.SequenceFormat.NativeText
    return ", ".join(QKeySequence(key).toString(style) for key in command.keys)
