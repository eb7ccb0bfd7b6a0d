"""Which workspace is in front, and what that means for menus, toolbar and drops."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QStackedWidget

from mocapstudio.gui import settings
from mocapstudio.gui.document import only_frame_differs
from mocapstudio.gui.workspaces.registry import WORKSPACES
from mocapstudio.gui.workspaces.workspace import Workspace
from mocapstudio.review.state import DocumentState

if TYPE_CHECKING:
    from mocapstudio.gui.main_window import MainWindow


class Switching(QObject):
    """Holds the pages of the window; a workspace is built when it is first entered.

    One page is shown at a time, and a page out of sight gives back what OpenGL holds, so there
    are never more viewports in the window than one workspace has.

    Parameters
    ----------
    window
        The window whose pages they are.
    """

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._made: dict[str, Workspace] = {}
        self.pages = QStackedWidget()
        self.pages.setObjectName("pages")
        self.pages.addWidget(window.welcome)
        self.name = WORKSPACES[0].name
        self._front: Workspace = self._get(self.name)
        for one in WORKSPACES:
            window.actions_.on(f"workspace-{one.name}", partial(self.show, one.name))
        window.bridge.changed.connect(self._follow)
        window.drops.dropped.connect(self._drop)

    @property
    def front(self) -> Workspace:
        """The workspace that is shown."""
        return self._front

    def show(self, name: str) -> None:
        """Bring a workspace to the front."""
        if name == self.name:
            return
        self._window.bridge.set_ui(playing=False)
        self._front.leave()
        self.name, self._front = name, self._get(name)
        self._show_page()
        self._front.enter()
        self._window.toolbar.follow_workspace(name)
        self._answer()

    def open_paths(self, paths: Sequence[Path]) -> None:
        """Open what was chosen from a list where it belongs."""
        if not self._front.open_paths(paths):
            self._window.files.open_paths(paths)

    def restore(self) -> None:
        """Show what the window begins with."""
        self._show_page()
        self._answer()

    def remember(self) -> None:
        """Remember the layout of all workspaces, and end what runs in them."""
        self._front.leave()
        for one in self._made.values():
            one.remember()
        settings.set_text("workspace", self.name)

    def hold_back(self, close: Callable[[], object]) -> bool:
        """Let workspaces ask before the window closes; True where one of them does."""
        return any(one.hold_back(close) for one in self._made.values())

    def _get(self, name: str) -> Workspace:
        if name not in self._made:
            made = self._make(next(one.made_by for one in WORKSPACES if one.name == name))
            self._made[name] = made
            self.pages.addWidget(made)
            self._window.toolbar.add_tools(name, made.tools())
            made.answers_changed.connect(partial(self._answer_of, made))
        return self._made[name]

    def _make(self, made_by: str) -> Workspace:
        if not made_by:
            return self._window.workspace
        module, _, name = made_by.partition(":")
        workspace: Workspace = getattr(import_module(module), name)(self._window)
        return workspace

    def _answer_of(self, workspace: Workspace) -> None:
        if workspace is self._front:
            self._answer()

    def _answer(self) -> None:
        self._window.actions_.follow_workspace(self.name, self._front.answers())
        self._window.drops.offer(self._front.zones(self._opened))

    @property
    def _opened(self) -> bool:
        return bool(self._window.bridge.state.scene.performers)

    def _show_page(self) -> None:
        waits = self._front.needs_take and not self._opened
        page = self._window.welcome if waits else self._front
        if self.pages.currentWidget() is not page:
            self._window.welcome.refresh()
            self.pages.setCurrentWidget(page)

    def _follow(self, old: DocumentState, new: DocumentState) -> None:
        if old is not new and only_frame_differs(old, new):
            return
        self._show_page()
        self._answer()

    def _drop(self, zone: str, paths: Sequence[Path]) -> None:
        if not self._front.drop(zone, paths):
            self._window.files.drop(zone, paths)
