"""The commands as QActions: one for menu, toolbar, button and key alike."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QMenu, QMenuBar, QPushButton, QToolButton, QWidget

from mocapstudio.gui import icons
from mocapstudio.gui.commands import COMMANDS, MENUS, SEPARATOR, Command
from mocapstudio.gui.document import UiState
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.review.model import Verdict
from mocapstudio.review.state import DocumentState


class Actions(QObject):
    """All QActions of a window, by the name of their command.

    Parameters
    ----------
    window
        The window whose shortcuts they are: they work wherever its focus is, save where a text
        field claims the key for itself.
    """

    def __init__(self, window: QWidget) -> None:
        super().__init__(window)
        self._actions = {name: self._make(one, window) for name, one in COMMANDS.items()}
        window.addActions(list(self._actions.values()))
        self.recolour()

    def __getitem__(self, name: str) -> QAction:
        return self._actions[name]

    def on(self, name: str, slot: Callable[[], object]) -> None:
        """Call `slot` when the user asks for a command."""
        self._actions[name].triggered.connect(lambda _=False: slot())

    def fill(self, bar: QMenuBar) -> dict[str, QMenu]:
        """Build the menus; returns them by their title without the mnemonic."""
        menus = {}
        for title, commands in MENUS.items():
            menu = bar.addMenu(title)
            menu.setToolTipsVisible(True)
            plain = title.replace("&", "")
            menu.setObjectName(f"menu-{plain.lower()}")
            menus[plain] = menu
            for command in commands:
                if command is SEPARATOR:
                    menu.addSeparator()
                else:
                    menu.addAction(self._actions[command.name])
        return menus

    def tool_button(self, name: str, *, text: str = "") -> QToolButton:
        """Make a tool button for a command, with text beside its icon where given."""
        button = QToolButton()
        button.setObjectName(f"button-{name}")
        button.setDefaultAction(self._actions[name])
        button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        if text:
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
            button.setText(text)
            # The default action would write its menu text over the button's own.
            self._actions[name].changed.connect(lambda: button.setText(text))
        return button

    def push_button(self, name: str, text: str) -> QPushButton:
        """Make a push button for a command."""
        action = self._actions[name]
        button = QPushButton(text)
        button.setObjectName(f"button-{name}")
        button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        button.clicked.connect(action.trigger)

        def follow() -> None:
            button.setEnabled(action.isEnabled())
            button.setToolTip(action.toolTip())
            button.setIcon(action.icon())

        action.changed.connect(follow)
        follow()
        return button

    def recolour(self) -> None:
        """Draw the icons in the colours of the theme in force."""
        for name, action in self._actions.items():
            if COMMANDS[name].icon:
                action.setIcon(icons.icon(COMMANDS[name].icon))

    def follow_state(self, state: DocumentState) -> None:
        """Switch commands on and off by what the document allows."""
        take = state.take is not None
        item = state.selected
        span = state.selection.span is not None
        decided = item is not None and item.verdict is not Verdict.OPEN
        accepted = item is not None and item.verdict is Verdict.ACCEPTED
        allowed = {
            "partner": take, "export": take, "report": take, "close-take": take,
            "save": take, "save-as": take,
            "analyse": take, "play": take, "frame-back": take, "frame-on": take,
            "ten-back": take, "ten-on": take, "first": take, "last": take, "loop": take,
            "trim-in": take, "trim-out": take,
            "trim-clear": take and any(one == state.active for one, _ in state.sitting.trims),
            "next": bool(state.queue), "previous": bool(state.queue),
            "select-all": bool(state.queue),
            "deselect": bool(state.selection.joints) or span or item is not None,
            "accept": item is not None, "reject": item is not None, "defer": item is not None,
            "reopen": decided, "reject-like": item is not None, "edit": accepted,
            "protect": take and span,
            "unprotect": any(one.performer == state.active for one in state.sitting.protected),
            "frame-joint": take, "zoom-flag": item is not None or span, "whole-take": take,
            "new": take,
            "undo": state.can_undo is not None, "redo": state.can_redo is not None,
        }  # fmt: skip
        for k in range(6):
            allowed[f"neighbour-{k}"] = item is not None and item.flag.joint not in ROOT_ROWS
        for name, enabled in allowed.items():
            self._actions[name].setEnabled(enabled)
        self._label("undo", state.can_undo)
        self._label("redo", state.can_redo)
        self._actions["calibrated"].setChecked(state.mode == "calibrated")
        self._actions["paper"].setChecked(state.mode == "paper")

    def follow_ui(self, ui: UiState) -> None:
        """Show which switches are on."""
        self._actions["play"].setText("&Stop" if ui.playing else "&Play")
        self._actions["play"].setIcon(icons.icon("pause" if ui.playing else "play"))
        for name, on in {
            "loop": ui.loop,
            "ghosts": ui.ghosts,
            "follow": ui.follow,
            "trails": ui.trails,
            "theme": ui.theme == "light",
            "learning": ui.learning,
        }.items():
            self._actions[name].setChecked(on)

    def _label(self, name: str, step: str | None) -> None:
        command = COMMANDS[name]
        self._actions[name].setText(f"{command.text} {step}" if step else command.text)
        self._set_tip(self._actions[name], f"{command.tip}: {step}" if step else command.tip)

    def _make(self, command: Command, window: QWidget) -> QAction:
        action = QAction(command.text, window)
        action.setObjectName(f"action-{command.name}")
        action.setShortcuts([QKeySequence(key) for key in command.keys])
        action.setShortcutContext(Qt.ShortcutContext.WindowShortcut)
        action.setAutoRepeat(command.name in _REPEATING)
        action.setCheckable(command.checkable)
        self._set_tip(action, command.tip)
        return action

    @staticmethod
    def _set_tip(action: QAction, tip: str) -> None:
        keys = action.shortcut().toString(QKeySequence.SequenceFormat.NativeText)
        action.setToolTip(f"{tip} ({keys})" if keys else tip)
        action.setStatusTip(tip)


# A key that is held must not decide flag after flag.
_REPEATING = frozenset(
    {"frame-back", "frame-on", "ten-back", "ten-on", "next", "previous", "undo", "redo",
     "threshold-up", "threshold-down"}
)  # fmt: skip
