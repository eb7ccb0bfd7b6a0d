"""The File menu: which dialogs are asked before something is opened, saved or written."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import platformdirs
from PySide6.QtCore import QObject

from mocapstudio.gui import settings
from mocapstudio.gui.dialogs.context import ContextDialog
from mocapstudio.gui.dialogs.files import (
    FileRequest,
    ask_for_files,
    ask_where_to_write,
    takes_filter,
)
from mocapstudio.gui.dialogs.import_report import ImportReportDialog
from mocapstudio.gui.dialogs.question import ask_to_save, confirm
from mocapstudio.gui.dialogs.rate import ask_rate
from mocapstudio.gui.handing_over import HandingOver
from mocapstudio.gui.markers_desk import MarkersDesk
from mocapstudio.gui.opening import Opening, is_session
from mocapstudio.gui.rereading import Rereading
from mocapstudio.motion.progress import Progress
from mocapstudio.review.document import Document
from mocapstudio.review.journal import recover
from mocapstudio.review.lock import LockedError
from mocapstudio.review.session_file import SUFFIX

if TYPE_CHECKING:
    from mocapstudio.evaluation.demo import DemoFiles
    from mocapstudio.gui.main_window import MainWindow

_SESSIONS = f"Sessions (*{SUFFIX})"


class FilesDesk(QObject):
    """Opens, saves and writes, with the questions that belong to it.

    Parameters
    ----------
    window
        The window whose dialogs they are.
    """

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._bridge, self._jobs = window.bridge, window.jobs
        self._messages, self._journalling = window.messages, window.journalling
        self.opening = Opening(window.bridge, window.jobs, window.messages, self)
        self.opening.session_read.connect(self._swap)
        self.opening.rate_wanted.connect(partial(ask_rate, window))
        self.opening.report_wanted.connect(self.show_import_report)
        self.rereading = Rereading(window.bridge, window.jobs, window.messages, self.opening, self)
        self.markers = MarkersDesk(window, self.opening)
        self._import_report: ImportReportDialog | None = None
        self.handing_over = HandingOver(window.bridge, window.jobs, window.messages, self)

    def ask_open(self) -> None:
        """Ask for takes or a session."""
        everything = takes_filter().replace("Takes (", f"Takes and sessions (*{SUFFIX} ")
        filters = f"{everything};;{_SESSIONS}"
        request = FileRequest("Open takes or a session", "open", several=True, filters=filters)
        ask_for_files(self._window, request, self.open_paths)

    def ask_partner(self) -> None:
        """Ask for a partner's take."""
        request = FileRequest("Add a partner to the scene", "open", several=True)
        ask_for_files(self._window, request, self.opening.add_partners)

    def ask_context(self) -> None:
        """Ask for the context."""
        dialog = ContextDialog(map(Path, self._bridge.state.context), self._window)
        dialog.chosen.connect(self.opening.set_context)
        dialog.open()

    def open_paths(self, paths: Sequence[Path], partners: Sequence[Path] = ()) -> None:
        """Open takes beside what is open, or a session in its place."""
        sessions = [path for path in paths if is_session(path)]
        takes = [path for path in paths if not is_session(path)]
        if sessions:
            self._unless_dirty(partial(self.opening.open_session, sessions[0]))
        if takes or partners:
            self.opening.open(takes, partners)

    def show_import_report(self, path: Path | None = None) -> None:
        """Show what was odd about the files that are open, beside the desk; one of them first."""
        if self._import_report is None:
            self._import_report = ImportReportDialog(
                self.opening.imports, self.rereading, self._window
            )
            self._import_report.closed.connect(self._forget_import_report)
        self._import_report.show_file(path or self.opening.imports.active)
        self._import_report.show()
        self._import_report.raise_()
        self._import_report.activateWindow()

    def _forget_import_report(self) -> None:
        self._import_report = None

    def drop(self, zone: str, paths: Sequence[Path]) -> None:
        """Do with dropped files what their zone says."""
        if zone == "partner":
            self.opening.add_partners(paths)
        elif zone == "context":
            known = [Path(path) for path in self._bridge.state.context]
            self.opening.set_context([*known, *(path for path in paths if path not in known)])
        else:
            self.open_paths(paths)

    def open_demo(self) -> None:
        """Generate the demo take and put it under review."""

        def work() -> Generator[Progress, None, DemoFiles]:
            yield Progress(0.0, "generating the demo take")
            from mocapstudio.evaluation.demo import write_demo

            return write_demo(platformdirs.user_data_path("mocapstudio") / "demo")

        def done(files: DemoFiles) -> None:
            self.opening.set_context(files.context)
            self.opening.open([files.take])

        self._jobs.start(
            "Generating the demo take",
            work(),
            done,
            lambda error: self._messages.complain(error, "The demo take could not be made"),
            key="demo",
        )

    def recover(self, journal: Path) -> None:
        """Put what a crash left on the desk."""

        def work() -> Generator[Progress, None, Document]:
            yield Progress(0.0, "reading the journal")
            return recover(journal)

        self._jobs.start(
            "Recovering",
            work(),
            self._swap,
            lambda error: self._messages.complain(error, "The session could not be recovered"),
        )

    def begin_anew(self) -> None:
        """Close everything."""
        self._unless_dirty(lambda: self._swap(Document()))

    def close_take(self) -> None:
        """Remove the take under review, with its decisions."""
        state, document = self._bridge.state, self._bridge.document
        active = state.active
        decided = any(one.performer == active for one in state.sitting.decisions)
        if decided:
            words = "Its decisions and repairs go with it; this cannot be undone."
            confirm(
                self._window,
                f"Close {active}?",
                words,
                "Close Take",
                lambda: document.close_performer(active),
            )
        elif active:
            document.close_performer(active)

    def save(self, then: Callable[[], object] | None = None) -> None:
        """Save, asking for a name where there is none."""
        path = self._bridge.state.path
        if path is None:
            self.save_as(then)
        elif self.handing_over.save(path) and then is not None:
            then()

    def save_as(self, then: Callable[[], object] | None = None) -> None:
        """Ask for a name and save."""

        def write(path: Path) -> None:
            if self.handing_over.save(path) and then is not None:
                then()

        start = self.handing_over.session_path()
        ask_where_to_write(self._window, "Save the session", start, _SESSIONS, write)

    def save_first(self, then: Callable[[], object]) -> None:
        """Ask whether to save, then go on unless the user cancels."""
        ask_to_save(self._window, lambda: self.save(then), then)

    def export(self) -> None:
        """Ask for a name and write the clean take."""
        hand = self.handing_over
        start = hand.clean_path()
        remembered = settings.text("folder/export")
        if remembered and Path(remembered).is_dir():
            start = Path(remembered) / start.name
        ask_where_to_write(
            self._window, "Export the clean take", start, takes_filter(), hand.export
        )

    def report(self) -> None:
        """Ask for a name and write the report."""
        hand = self.handing_over
        page = "Web pages (*.html)"
        ask_where_to_write(self._window, "Write the report", hand.report_path(), page, hand.report)

    def _unless_dirty(self, do: Callable[[], object]) -> None:
        if self._bridge.state.dirty:
            self.save_first(do)
        else:
            do()

    def _swap(self, document: Document) -> None:
        def ask(error: LockedError) -> None:
            confirm(
                self._window,
                "Open it all the same?",
                f"{error}. Whoever saves last wins.",
                "Open",
                lambda: self._swapped(document, force=True),
            )

        self._jobs.cancel()
        self._journalling.swap(document, ask)
        if self._bridge.document is document:
            self._swapped(document, force=False)

    def _swapped(self, document: Document, *, force: bool) -> None:
        if force:
            self._journalling.swap_by_force(document)
        self.opening.greet(document)
        state = document.state
        if state.markers and not state.scene.performers:
            self.markers.show()
        elif state.comparison.reference is not None and not state.everyone:
            self._window.switching.show("compare")
