"""Markers that were opened: shows them, solves them, or hands them on."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from mocapstudio import formats
from mocapstudio.gui import settings
from mocapstudio.gui.dialogs.markers import MarkersDialog, Template
from mocapstudio.gui.messages import Link
from mocapstudio.gui.opening import Opening
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.take import Take

if TYPE_CHECKING:
    from mocapstudio.gui.main_window import MainWindow
    from mocapstudio.motion.solving import Solved

_DOING = "The markers could not be solved"
_CENTIMETRES = 100.0


class MarkersDesk(QObject):
    """Answers `Opening.markers_found`.

    Parameters
    ----------
    window
        The window whose dialogs they are.
    opening
        Found the markers.
    """

    def __init__(self, window: MainWindow, opening: Opening) -> None:
        super().__init__(opening)
        self._window, self._opening = window, opening
        self._bridge, self._jobs, self._messages = window.bridge, window.jobs, window.messages
        opening.markers_found.connect(lambda markers, _partner: self._open(markers))
        opening.opened.connect(self._leave)

    def ask_solve(self, markers: Sequence[MarkerTake], partner: bool = False) -> None:
        """Ask for a template, and solve markers to its skeleton; or compare them as they are."""
        state = self._bridge.state
        # The take under review is the likeliest template.
        performers = sorted(state.scene.performers, key=lambda one: one.id != state.active)
        dialog = MarkersDialog(markers, [one.take for one in performers], self._window)
        dialog.solve_wanted.connect(partial(self._solve, markers, partner))
        dialog.compare_wanted.connect(partial(self.compare, markers))
        dialog.open()

    def compare(self, markers: Sequence[MarkerTake]) -> None:
        """Set markers beside another performance, in the Compare workspace."""
        from mocapstudio.gui.workspaces.compare import CompareWorkspace

        self._window.switching.show("compare")
        workspace = self._window.switching.front
        if isinstance(workspace, CompareWorkspace):
            workspace.working.take_in(markers)

    def _leave(self) -> None:
        """Show takes of joints where they are seen."""
        if self._window.switching.name == "markers":
            self._window.switching.show("review")

    def show(self) -> None:
        """Bring the Markers workspace to the front."""
        self._window.switching.show("markers")

    def _open(self, markers: Sequence[MarkerTake]) -> None:
        """Take markers into the sitting; those that are open already are only shown."""
        from mocapstudio.gui.workspaces.markers import MarkersWorkspace

        document, first = self._bridge.document, ""
        for take in markers:
            known = next((p.id for p in self._bridge.state.markers if _same(p.take, take)), "")
            opened = known or document.open_markers(take)
            first = first or opened
            if take.source is not None:
                settings.add_recent("files", take.source.path)
        self.show()
        workspace = self._window.switching.front
        if isinstance(workspace, MarkersWorkspace):
            workspace.bridge.show(first)

    def _solve(self, markers: Sequence[MarkerTake], partner: bool, template: Template) -> None:
        manner = self._opening.manner

        def template_take() -> Take:
            if isinstance(template, Take):
                return template
            takes, _ = formats.read(template, manner.of(template))
            return takes[0]

        for one in markers:
            self._jobs.start(
                f"Solving {one.name}",
                _solving(one, template_take),
                partial(self._take_in, one, partner),
                lambda error: self._messages.complain(error, _DOING),
            )
        if isinstance(template, Path):
            settings.set_folder("template", template)

    def _take_in(self, markers: MarkerTake, partner: bool, solved: Solved) -> None:
        document = self._bridge.document
        # The markers themselves bear the plain name.
        take = replace(solved.take, name=f"{markers.name} solved")
        performer = document.open_take(take, partner=partner)
        if not partner:
            document.set_active(performer)
        if markers.source is not None:
            remarks = (_fit(solved), *solved.warnings)
            self._opening.imports.note_solved(take, markers.source.path, remarks)
            settings.add_recent("files", markers.source.path)
        self._opening.opened.emit()
        tip = "See how well the joints fit the markers"
        link = Link("Import report", tip, self._opening.report_wanted.emit)
        self._messages.tell(f"Solved {markers.name}: {_fit(solved)}.", link)


def _solving(
    markers: MarkerTake, template: Callable[[], Take]
) -> Generator[Progress, None, Solved]:
    yield Progress(0.0, f"solving {markers.name}")
    from mocapstudio.motion.solving import solving

    return (yield from solving(markers, template()))


def _fit(solved: Solved) -> str:
    mean, largest = solved.mean * _CENTIMETRES, solved.max * _CENTIMETRES
    return f"markers lie {mean:.1f} cm off the solved joints on average, {largest:.1f} cm at most"


def _same(one: MarkerTake, other: MarkerTake) -> bool:
    """Whether two takes come from the same performer of the same file, of the same content."""
    if one.source is None or other.source is None:
        return one is other
    return (
        one.source.performer == other.source.performer
        and one.source.path.resolve() == other.source.path.resolve()
        and one.source.digest == other.source.digest
        and one.source.options == other.source.options
    )
