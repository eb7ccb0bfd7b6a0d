"""In the corner above the names: what a plot shows, and against which context."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QMenu, QToolButton, QWidget

from mocapstudio.gui.dialogs.files import ask_for_folder
from mocapstudio.gui.plots.axes import TIME_AXIS_HEIGHT
from mocapstudio.gui.plots.time_plot import LEFT_GUTTER
from mocapstudio.gui.second_map import OtherContext, SecondMap

if TYPE_CHECKING:
    from mocapstudio.cleaning.analysis import Analysis

_MOST = 40


class CornerButton(QToolButton):
    """A button with a menu in the corner between names and time axis."""

    def __init__(self, parent: QWidget, name: str) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setProperty("role", "corner")
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.setGeometry(2, 0, LEFT_GUTTER - 6, TIME_AXIS_HEIGHT)

    def say(self, text: str) -> None:
        """Show words, shortened to the room there is."""
        room = self.width() - 22
        shown = self.fontMetrics().elidedText(text, Qt.TextElideMode.ElideMiddle, room)
        self.setText(f"{shown} ▾" if self.menu() is not None else shown)


class ContextChoice(CornerButton):
    """Names the context of the second map, and chooses another.

    Parameters
    ----------
    second
        The second map.
    parent
        What it lies on.
    """

    def __init__(self, second: SecondMap, parent: QWidget) -> None:
        super().__init__(parent, "beside-context")
        self._second = second
        self._contexts: tuple[str, ...] = ()
        self._menu = QMenu(self)
        self._menu.setObjectName("beside-context-menu")
        self._menu.aboutToShow.connect(self._fill)
        self.setMenu(self._menu)
        self.setToolTip("What the take is compared with for this map; click to choose")

    def show_choice(self, analysis: Analysis | None) -> None:
        """Offer the context of an analysis, and name what is chosen."""
        self._contexts = () if analysis is None else tuple(one.name for one in analysis.context)
        self.say(f"against {self._second.context}")

    def _fill(self) -> None:
        self._menu.clear()
        chosen = self._second.context
        offered = [OtherContext(), *(OtherContext(take=name) for name in self._contexts[:_MOST])]
        if chosen.folder is not None:
            offered.append(chosen)
        for number, one in enumerate(offered):
            entry = self._menu.addAction(str(one))
            entry.setCheckable(True)
            entry.setChecked(one == chosen)
            entry.triggered.connect(partial(self._choose, one))
            if number == 0:
                self._menu.addSeparator()
        self._menu.addSeparator()
        self._menu.addAction("Another Folder…").triggered.connect(self._ask)

    def _choose(self, context: OtherContext, _checked: bool = False) -> None:
        self._second.choose(context)

    def _ask(self) -> None:
        def take(folder: Path) -> None:
            self._second.choose(OtherContext(folder=folder))

        ask_for_folder(self.window(), "Compare with the takes of a folder", "context", take)
