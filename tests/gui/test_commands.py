"""Every command does something, has its key shown, and shares it with no other."""

from __future__ import annotations

from collections import Counter

import pytest
from PySide6.QtCore import SIGNAL
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import (
    QAbstractButton,
    QComboBox,
    QDialogButtonBox,
    QLineEdit,
    QSlider,
    QTabBar,
)

from mocapstudio.gui.commands import COMMANDS, HOMES, MENUS, SEPARATOR
from mocapstudio.gui.workspaces.registry import WORKSPACES


@pytest.mark.parametrize("workspace", [one.name for one in WORKSPACES])
def test_no_key_has_two_commands_in_one_workspace(workspace):
    keys = Counter(
        QKeySequence(key).toString()
        for menu, commands in MENUS.items()
        if workspace in HOMES.get(menu, (workspace,))
        for command in commands
        for key in command.keys
    )
    assert [key for key, count in keys.items() if count > 1] == []


def test_the_keys_of_the_desk_are_the_agreed_ones():
    agreed = {
        "play": "Space", "frame-back": "Left", "frame-on": "Right", "ten-back": "Shift+Left",
        "ten-on": "Shift+Right", "loop": "L", "next": "N", "previous": "P", "accept": "A",
        "reject": "R", "defer": "D", "neighbour-1": "1", "neighbour-5": "5", "ghosts": "G",
        "frame-joint": "F", "trim-in": "I", "trim-out": "O", "undo": "Ctrl+Z", "redo": "Ctrl+Y",
        "save": "Ctrl+S", "open": "Ctrl+O", "export": "Ctrl+E",
    }  # fmt: skip
    assert {name: COMMANDS[name].keys[0] for name in agreed} == agreed


def test_mnemonics_of_a_menu_are_unique():
    for menu, commands in MENUS.items():
        letters = [
            one.text[one.text.index("&") + 1].lower()
            for one in commands
            if one is not SEPARATOR and "&" in one.text
        ]
        doubled = [letter for letter, count in Counter(letters).items() if count > 1]
        assert doubled == [], menu


def test_every_command_does_something(desk):
    idle = []
    for name in COMMANDS:
        action = desk.actions_[name]
        heard = action.receivers(SIGNAL("triggered(bool)"))
        heard += action.receivers(SIGNAL("toggled(bool)"))
        if not heard and action.menu() is None:
            idle.append(name)
    assert idle == []


def test_tooltips_name_the_key(desk):
    for name, command in COMMANDS.items():
        action = desk.actions_[name]
        shown = QKeySequence(command.keys[0]).toString() if command.keys else ""
        assert action.toolTip().endswith(f"({shown})" if shown else ""), name


def test_every_control_of_the_desk_says_what_it_is_for(desk):
    silent = [
        widget.objectName() or f"{type(widget).__name__} in {widget.parent().objectName()}"
        for kind in (QAbstractButton, QComboBox, QSlider)
        for widget in desk.findChildren(kind)
        if not widget.toolTip()
        and not widget.objectName().startswith("qt_")
        and not isinstance(widget.parent(), QDialogButtonBox | QComboBox | QLineEdit | QTabBar)
        and type(widget).__name__ not in {"QTableCornerButton", "QToolBarExtension"}
    ]
    assert silent == []


def test_nothing_can_be_decided_before_a_take_is_open(desk):
    for name in ("accept", "reject", "defer", "export", "save", "play", "next", "analyse"):
        assert not desk.actions_[name].isEnabled(), name
    for name in ("open", "context", "quit", "shortcuts"):
        assert desk.actions_[name].isEnabled(), name
