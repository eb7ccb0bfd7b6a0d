"""Reading takes, partners, contexts and sessions in the background."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from mocapstudio.gui import settings
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.imports import Imports
from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.messages import Link, Messages
from mocapstudio.gui.reading import Read, reading, reading_context
from mocapstudio.gui.trouble import Trouble
from mocapstudio.gui.worker import Worker
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.recording import same_recording
from mocapstudio.motion.take import Take
from mocapstudio.review.manner import AS_THEY_ARE, Manner
from mocapstudio.review.session_file import SUFFIX, load

if TYPE_CHECKING:
    from fractions import Fraction

    from mocapstudio.formats import ReadOptions
    from mocapstudio.review.document import Document


class Opening(Worker):
    """Opens what the user names.

    Parameters
    ----------
    bridge
        The document's door.
    jobs
        Runs the reading.
    messages
        Is told what went wrong.
    parent
        Qt's parent.
    """

    opened = Signal()
    """Emitted when takes came into the scene."""

    session_read = Signal(object)
    """Emitted with the document of a session that was read."""

    markers_found = Signal(object, bool)
    """Emitted with a tuple of marker takes, and whether they were meant as partners."""

    rate_wanted = Signal(object, object)
    """Emitted with files that state no frame rate, and what to call with one (a Fraction)."""

    report_wanted = Signal()
    """Emitted when the user wants to see what was odd about the files."""

    def __init__(
        self,
        bridge: DocumentBridge,
        jobs: Jobs,
        messages: Messages,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(bridge, jobs, messages, parent)
        self._asked = AS_THEY_ARE
        self.imports = Imports(bridge, self)

    @property
    def manner(self) -> Manner:
        """How files are read in this sitting."""
        return self._bridge.state.manner

    def ask_for(self, manner: Manner) -> None:
        """Read as the command line asks, in every sitting that does not say otherwise."""
        self._asked = manner
        self._bridge.document.set_manner(manner)

    def read_otherwise(self, path: Path, options: ReadOptions) -> None:
        """Remember a way of its own for a file."""
        self._bridge.document.set_manner(self.manner.with_own(path, options))

    def open(self, paths: Iterable[Path], partners: Iterable[Path] = ()) -> None:
        """Open takes beside those that are open; the first becomes the one under review."""
        wanted, beside = list(paths), list(partners)
        doing = "This could not be opened"
        if not wanted:
            self.add_partners(beside)
            return

        def done(read: Read) -> None:
            self._take_in(read, wanted, partner=False)
            if beside and self._bridge.state.active:
                self.add_partners(beside)

        self._read(wanted, f"Opening {_names(wanted)}", doing, done)

    def add_partners(self, paths: Iterable[Path]) -> None:
        """Show other performers in the same scene."""
        wanted = list(paths)
        if wanted:
            self._read(
                wanted,
                f"Adding {_names(wanted)}",
                "This partner could not be added",
                lambda read: self._take_in(read, wanted, partner=True),
            )

    def set_context(self, paths: Iterable[Path]) -> None:
        """Search other takes for neighbours; none means the take itself only."""
        wanted = list(paths)
        if not wanted:
            self._bridge.document.set_context((), ())
            return
        doing = "This could not be used as context"

        def done(read: Read) -> None:
            self._use_context(read, wanted)
            self._ask_rate(read.rateless, lambda: self.set_context(wanted))

        self._have_done(
            "Reading the context",
            reading_context(wanted, doing, self._bridge.state.take, self.manner),
            done,
            doing,
            "context",
        )

    def open_session(self, path: Path) -> None:
        """Read a session; see `session_read`."""

        def work() -> Generator[Progress, None, Document]:
            yield Progress(0.0, f"opening {path.name}")
            return load(path)

        self._have_done(
            f"Opening {path.name}",
            work(),
            self.session_read.emit,
            "The session could not be opened",
            "session",
        )

    def greet(self, document: Document) -> None:
        """Tell what was odd about a session that is on the desk now, and read its context."""
        if document.state.manner == AS_THEY_ARE:
            document.set_manner(self._asked)
        state = document.state
        if state.path is not None:
            settings.add_recent("files", state.path)
            settings.set_folder("open", state.path)
        doing = "The session was opened, but not all is as it was"
        self._messages.complain_of([Trouble(doing, p.what, str(p.path)) for p in state.problems])
        wanted = [Path(path) for path in state.context]
        if wanted and not document.context_takes:
            self.set_context(wanted)

    def _read(
        self,
        paths: list[Path],
        title: str,
        doing: str,
        done: Callable[[Read], None],
    ) -> None:
        def arrived(read: Read) -> None:
            done(read)
            self._ask_rate(read.rateless, lambda: self._read(read.rateless, title, doing, done))

        self._have_done(title, reading(paths, doing, self.manner), arrived, doing)

    def _ask_rate(self, files: Sequence[Path], again: Callable[[], object]) -> None:
        """Ask for the rate that files do not state, remember it for them, and go on."""

        def answered(rate: Fraction) -> None:
            for path in files:
                self.read_otherwise(path, replace(self.manner.of(path), fps=rate))
            again()

        if files:
            self.rate_wanted.emit(tuple(files), answered)

    def _take_in(self, read: Read, paths: list[Path], *, partner: bool) -> None:
        document = self._bridge.document
        first = ""
        for one in read.files:
            self.imports.note(one)
        for take in read.takes:
            known = self._known(take)
            opened = known or document.open_take(take, partner=partner)
            first = first or opened
        if first and not partner:
            document.set_active(first)
        if first:
            purpose = "partner" if partner else "open"
            settings.set_folder(purpose, paths[0])
            for path in paths:
                if path.is_file() and not partner:
                    settings.add_recent("files", path)
            self.opened.emit()
            self._tell_repairs(read)
        self._messages.complain_of(read.troubles)
        if read.markers:
            self.markers_found.emit(tuple(read.markers), partner)

    def _known(self, take: Take) -> str:
        for performer in self._bridge.state.scene.performers:
            if same_recording(performer.take, take):
                return performer.id
        return ""

    def _use_context(self, read: Read, paths: list[Path]) -> None:
        if read.takes:
            for path in paths:
                settings.add_recent("contexts", path)
            settings.set_folder("context", paths[0])
            self._bridge.document.set_context(paths, read.takes)
            count = len(read.takes)
            words = f"{count} takes" if count > 1 else "1 take"
            self._messages.tell(f"The context holds {words}.")
        self._messages.complain_of(read.troubles)

    def _tell_repairs(self, read: Read) -> None:
        odd = [
            (one.path.name, problem)
            for one in read.files
            for problem in one.report.problems
            if not problem.guess
        ]
        if odd:
            name, problem = odd[0]
            place = "" if problem.line is None else f" line {problem.line}:"
            more = f" (and {len(odd) - 1} more)" if len(odd) > 1 else ""
            words = f"{name}:{place} {problem.what}; {problem.done}{more}"
            tip = "See what was odd, and read the file otherwise"
            self._messages.tell(words, Link("Import report", tip, self.report_wanted.emit))


def is_session(path: Path) -> bool:
    """Tell whether a path names a session file."""
    return path.suffix.lower() == SUFFIX


def _names(paths: Sequence[Path]) -> str:
    return paths[0].name if len(paths) == 1 else f"{len(paths)} takes"
