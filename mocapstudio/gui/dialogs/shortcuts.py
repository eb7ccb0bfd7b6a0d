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

from mocapstudio.gui.allowed import GENERAL
from mocapstudio.gui.commands import HOMES, MENUS, Command
from mocapstudio.gui.widgets.parts import label, panel
from mocapstudio.gui.workspaces.workspace import Answers

_COLUMNS = 3
_VIEWPORT = "Viewport: drag turns, Shift-drag pans, the wheel zooms, a click selects a joint."
_HINTS = {
    "review": "Map: a click goes there, Shift-drag selects joints and span, the wheel zooms.",
    "compare": "Pictures: a click goes there, the wheel zooms, a drag in the lane names a part.",
}


class ShortcutsDialog(QDialog):
    """Lists the keys of the commands of one workspace, by menu.

    Parameters
    ----------
    workspace, answers
        Its name, and what it makes of the commands.
    parent
        Qt's parent.
    """

    def __init__(self, workspace: str, answers: Answers, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("shortcuts-dialog")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle("Keyboard shortcuts")
        column = QVBoxLayout(self)
        column.setContentsMargins(22, 18, 22, 14)
        column.setSpacing(14)
        row = QHBoxLayout()
        row.setSpacing(34)
        commands = _commands(workspace, answers)
        for menus in _columns(commands):
            stack = QVBoxLayout()
            stack.setSpacing(12)
            for menu in menus:
                stack.addWidget(_group(menu, commands[menu]))
            stack.addStretch(1)
            row.addLayout(stack)
        column.addLayout(row)
        hints = [_VIEWPORT] + [_HINTS[workspace]] * (workspace in _HINTS)
        column.addWidget(label("\n".join(hints), "muted"))
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        buttons.rejected.connect(self.reject)
        column.addWidget(buttons)


def _commands(workspace: str, answers: Answers) -> dict[str, list[Command]]:
    """Commands with keys that have a place in a workspace, by menu, its own menus first."""

    def has_place(name: str) -> bool:
        return name in answers.slots or name in GENERAL or name.startswith("workspace-")

    found = {}
    for menu in sorted(MENUS, key=lambda menu: menu not in HOMES):
        if workspace in HOMES.get(menu, (workspace,)):
            keyed = [one for one in MENUS[menu] if one.keys]
            found[menu] = [one for one in keyed if not answers.alone or has_place(one.name)]
    return {menu: commands for menu, commands in found.items() if commands}


def _columns(commands: dict[str, list[Command]]) -> list[list[str]]:
    """Menus in columns of about one length."""
    rows = {menu: 2 + len(keyed) for menu, keyed in commands.items()}
    least = max(max(rows.values()), -(-sum(rows.values()) // _COLUMNS))
    while len(columns := _filled(rows, least)) > _COLUMNS:
        least += 1
    return columns


def _filled(rows: dict[str, int], most: int) -> list[list[str]]:
    columns: list[list[str]] = [[]]
    for menu in rows:
        if columns[-1] and sum(rows[one] for one in columns[-1]) + rows[menu] > most:
            columns.append([])
        columns[-1].append(menu)
    return columns


def _group(menu: str, commands: list[Command]) -> QFrame:
    group = panel("", "")
    grid = QGridLayout(group)
    grid.setContentsMargins(0, 0, 0, 0)
    grid.setHorizontalSpacing(18)
    grid.setVerticalSpacing(4)
    grid.addWidget(label(menu.replace("&", "").upper(), "section"), 0, 0, 1, 2)
    for row, command in enumerate(commands, start=1):
        grid.addWidget(label(command.text.replace("&", "").rstrip("…")), row, 0)
        keys = label(_keys(command), "muted")
        grid.addWidget(keys, row, 1, Qt.AlignmentFlag.AlignRight)
    return group


def _keys(command: Command) -> str:
    style = QKeySequence.SequenceFormat.NativeText
    return ", ".join(QKeySequence(key).toString(style) for key in command.keys)
