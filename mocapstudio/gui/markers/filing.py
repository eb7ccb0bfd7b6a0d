"""Writing mended markers, solving and comparing them."""

from __future__ import annotations

import copy
from collections.abc import Generator
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from mocapstudio.gui import settings
from mocapstudio.gui.dialogs.exchange import ExchangeDialog
from mocapstudio.gui.dialogs.files import ask_where_to_write
from mocapstudio.gui.dialogs.question import confirm
from mocapstudio.gui.markers.bridge import MarkersBridge, MarkersShown
from mocapstudio.gui.markers.nearness import nearest_markers
from mocapstudio.gui.markers.working import Working
from mocapstudio.motion.progress import Progress
from mocapstudio.review.performances import marker_performance

if TYPE_CHECKING:
    from mocapstudio.gui.main_window import MainWindow

_FILTER = "Markers (*.c3d *.trc *.csv *.tsv)"
_WRITTEN = (".c3d", ".trc", ".csv", ".tsv")


class Filing(QObject):
    """Asks what has to be asked before something is written, closed or exchanged.

    Parameters
    ----------
    window
        Parent of the dialogs.
    bridge
        What is shown and chosen.
    working
        Does what was answered.
    """

    def __init__(self, window: MainWindow, bridge: MarkersBridge, working: Working) -> None:
        super().__init__(bridge)
        self._window, self._bridge, self._working = window, bridge, working

    def ask_export(self) -> None:
        """Ask for a name and write the mended markers."""
        take = self._bridge.shown.source
        if take is None:
            return
        source = None if take.source is None else take.source.path
        suffix = ".c3d" if source is None else source.suffix
        name = f"{take.name}_clean{suffix if suffix.lower() in _WRITTEN else '.c3d'}"
        remembered = settings.text("folder/export")
        known = bool(remembered) and Path(remembered).is_dir()
        folder = Path(settings.folder("export")) if known or source is None else source.parent
        ask_where_to_write(self._window, "Export the markers", folder / name, _FILTER, self.export)

    def export(self, path: Path) -> None:
        """Write the markers with their edits."""
        # A shallow copy holds the frozen state of now, whatever is edited meanwhile.
        document, performer = copy.copy(self._bridge.desk.document), self._bridge.shown.performer

        def work() -> Generator[Progress, None, int]:
            yield Progress(0.0, f"writing {path.name}")
            from mocapstudio.review.marker_export import export_markers

            export_markers(document, performer, path)
            return len(document.marker_declared(performer))

        def done(count: int) -> None:
            many = f"{count} changed spans" if count > 1 else "1 changed span"
            words = many if count else "nothing was changed"
            self._window.messages.tell(f"Exported {path.name}: {words}.", path)

        doing = f"{path.name} could not be exported"
        self._window.jobs.start(
            f"Exporting {path.name}",
            work(),
            done,
            lambda error: self._window.messages.complain(error, doing),
        )

    def ask_exchange(self) -> None:
        """Ask with which marker, and over which frames."""
        shown = self._bridge.shown
        if shown.result is None or shown.marker is None:
            return
        others = nearest_markers(shown.result, shown.marker, shown.frame)
        dialog = ExchangeDialog(shown.marker, others, _spans(shown), self._window)
        dialog.answered.connect(self._working.exchange)
        dialog.open()

    def ask_solve(self) -> None:
        """Ask for a template and solve the markers to a skeleton."""
        if self._bridge.shown.result is not None:
            self._window.files.markers.ask_solve([self._bridge.shown.result])

    def ask_report(self) -> None:
        """Ask for a name and write the report of the sitting."""
        self._window.files.report()

    def show_import_report(self) -> None:
        """Show what was odd about the file of the markers."""
        files, source = self._window.files, self._bridge.shown.source
        files.show_import_report(None if source is None else files.opening.imports.file_of(source))

    def compare(self) -> None:
        """Set the markers beside another performance."""
        shown, document = self._bridge.shown, self._bridge.desk.document
        if shown.result is not None:
            self._window.files.markers.compare([marker_performance(document, shown.performer)])

    def close(self) -> None:
        """Take the marker take out of the sitting."""
        name, document = self._bridge.shown.performer, self._bridge.desk.document
        if self._bridge.shown.edits:
            words = "Its edits go with it; this cannot be undone."
            confirm(
                self._window,
                f"Close {name}?",
                words,
                "Close Take",
                lambda: document.close_markers(name),
            )
        elif name:
            document.close_markers(name)


def _spans(shown: MarkersShown) -> list[tuple[str, tuple[int, int]]]:
    take = shown.result
    assert take is not None
    first, frame = take.first_frame, shown.frame
    found = [
        (f"from frame {first + frame} to the end", (frame, take.frames)),
        ("in the whole take", (0, take.frames)),
    ]
    if shown.span is not None:
        start, end = shown.span
        words = f"in the chosen span, frames {first + start}–{first + end - 1}"
        found.insert(0, (words, (start, end)))
    return found
