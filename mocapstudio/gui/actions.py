"""The commands as QActions: one for menu, toolbar, button and key alike."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QObject, Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QCheckBox, QMenu, QMenuBar, QPushButton, QToolButton, QWidget

from mocapstudio.gui import icons
from mocapstudio.gui.allowed import GENERAL, allowed, checked
from mocapstudio.gui.commands import COMMANDS, HOMES, MENUS, SEPARATOR, Command
from mocapstudio.gui.document import UiState
from mocapstudio.gui.workspaces.workspace import Answers
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
        self._slots: dict[str, Callable[[], object]] = {}
        self._menus: dict[str, QMenu] = {}
        self._state, self._ui = DocumentState(), UiState()
        self._workspace, self._answers = "review", Answers()
        self._actions = {name: self._make(one, window) for name, one in COMMANDS.items()}
        window.addActions(list(self._actions.values()))
        self.recolour()

    def __getitem__(self, name: str) -> QAction:
        return self._actions[name]

    def on(self, name: str, slot: Callable[[], object]) -> None:
        """Call `slot` when the user asks for a command, unless the workspace answers it."""
        self._slots[name] = slot

    def fill(self, bar: QMenuBar) -> dict[str, QMenu]:
        """Build the menus; returns them by their title without the mnemonic."""
        menus = {}
        for title, commands in MENUS.items():
            menu = bar.addMenu(title)
            menu.setToolTipsVisible(True)
            plain = title.replace("&", "")
            menu.setObjectName(f"menu-{plain.lower()}")
            menus[plain] = self._menus[title] = menu
            for command in commands:
                if command is SEPARATOR:
                    menu.addSeparator()
                else:
                    menu.addAction(self._actions[command.name])
        self._apply()
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

    def check_box(self, name: str, text: str) -> QCheckBox:
        """Make a check box for a switch, its key behind the text."""
        action = self._actions[name]
        box = QCheckBox(f"{text}  ({action.shortcut().toString()})")
        box.setObjectName(f"check-{name}")
        box.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        box.clicked.connect(action.trigger)

        def follow() -> None:
            box.setEnabled(action.isEnabled())
            box.setChecked(action.isChecked())
            box.setToolTip(action.toolTip())

        action.changed.connect(follow)
        follow()
        return box

    def recolour(self) -> None:
        """Draw the icons in the colours of the theme in force."""
        for name, action in self._actions.items():
            if COMMANDS[name].icon:
                action.setIcon(icons.icon(COMMANDS[name].icon))

    def follow_state(self, state: DocumentState) -> None:
        """Switch commands on and off by what the document allows."""
        self._state = state
        self._apply()

    def follow_ui(self, ui: UiState) -> None:
        """Show which switches are on."""
        self._ui = ui
        self._show_switches()

    def follow_workspace(self, name: str, answers: Answers) -> None:
        """Let the workspace in front answer what it answers itself."""
        self._workspace, self._answers = name, answers
        self._apply()

    def _call(self, name: str) -> None:
        slot = self._answers.slots.get(name) or self._slots.get(name)
        if slot is not None:
            slot()
        if self._actions[name].isCheckable():
            # A click checks the button, whatever became of what it asked for.
            self._show_switches()

    def _apply(self) -> None:
        by_document, own = allowed(self._state), self._answers
        away = set()
        for title, menu in self._menus.items():
            here = self._workspace in HOMES.get(title, (self._workspace,))
            menu.menuAction().setVisible(here)
            if not here:
                away |= {one.name for one in MENUS[title]}
        for name, action in self._actions.items():
            able = by_document.get(name, True)
            if name in own.slots:
                able = own.allowed.get(name, True)
            elif own.alone and name not in GENERAL and not name.startswith("workspace-"):
                able = False
            action.setEnabled(able and (name not in away or name in GENERAL))
        self._label("undo", own.undo if "undo" in own.slots else self._state.can_undo)
        self._label("redo", own.redo if "redo" in own.slots else self._state.can_redo)
        self._show_switches()

    def _show_switches(self) -> None:
        own = self._answers
        playing = self._ui.playing if own.playing is None else own.playing
        self._actions["play"].setText("&Stop" if playing else "&Play")
        self._actions["play"].setIcon(icons.icon("pause" if playing else "play"))
        here = {f"workspace-{self._workspace}": True}
        others = {n: False for n in COMMANDS if n.startswith("workspace-")}
        switches = others | here | checked(self._state, self._ui) | dict(own.checked)
        for name, on in switches.items():
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
        action.triggered.connect(lambda _=False: self._call(command.name))
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
