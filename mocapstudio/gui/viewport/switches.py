"""The commands of the 3-D view: preset views, framing, and what is shown."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PySide6.QtCore import QObject, Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QWidget

from mocapstudio.gui import icons

# Name, key, what it shows: keys that the desk leaves free, and the same on the number pad.
_VIEWS = (
    ("front", "6", "The performer from the front"),
    ("side", "7", "The performer from their left side"),
    ("top", "8", "The performer from above"),
    ("three-quarter", "9", "The performer from the front left, slightly above"),
)


class Switches(QObject):
    """QActions of the view; the desk may put them into its menus.

    Parameters
    ----------
    owner
        The view, in whose window the keys work.
    look
        Called with the name of a preset view.
    frame
        Called to frame the selected joint, or the body.
    follow, ghosts, onion, neighbours
        Called with True or False.
    """

    def __init__(
        self,
        owner: QWidget,
        *,
        look: Callable[[str], None],
        frame: Callable[[], None],
        follow: Callable[[bool], None],
        ghosts: Callable[[bool], None],
        onion: Callable[[bool], None],
        neighbours: Callable[[bool], None],
    ) -> None:
        super().__init__(owner)
        self._icons: dict[QAction, str] = {}
        self.views = tuple(
            self._make(f"view-{name}", tip, key, partial(look, name)) for name, key, tip in _VIEWS
        )
        # These have keys of their own in the desk's menus.
        self.frame = self._make("frame", "Frame the selected joint, or the body (F)", "", frame)
        self.follow = self._switch("follow", "Follow the performer (C)", "", follow)
        self.ghosts = self._switch("ghost", "Show proposal and original as ghosts (G)", "", ghosts)
        self.onion = self._switch(
            "onion", "Show the selected limb, or the body, before and after (Shift+G)", "", onion
        )
        self.neighbours = self._switch(
            "neighbours", "Show what each neighbour would do here", "K", neighbours
        )
        owner.addActions([*self.views, self.neighbours])

    def recolour(self) -> None:
        """Draw the icons in the colours of the theme in force."""
        for action, name in self._icons.items():
            action.setIcon(icons.icon(name))

    def _make(self, icon: str, tip: str, key: str, do: Callable[[], None]) -> QAction:
        action = self._action(icon, tip, key)
        action.triggered.connect(lambda _=False: do())
        return action

    def _switch(self, icon: str, tip: str, key: str, do: Callable[[bool], None]) -> QAction:
        action = self._action(icon, tip, key)
        action.setCheckable(True)
        action.triggered.connect(do)
        return action

    def _action(self, icon: str, tip: str, key: str) -> QAction:
        action = QAction(icons.icon(icon), tip, self)
        action.setObjectName(f"viewport-{icon}")
        action.setShortcut(QKeySequence(key))
        action.setShortcutContext(Qt.ShortcutContext.WindowShortcut)
        action.setToolTip(f"{tip} ({key})" if key else tip)
        self._icons[action] = icon
        return action
