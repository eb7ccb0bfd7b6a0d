"""Reading a file that is open once more, in another way."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject

from mocapstudio.formats import ImportReport, ReadOptions, Recording, read_any
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.imports import Imports, imported
from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.messages import Messages
from mocapstudio.gui.opening import Opening
from mocapstudio.gui.worker import Worker
from mocapstudio.motion.errors import NoRateError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.take import Take
from mocapstudio.review.marker_model import MarkerPerformer
from mocapstudio.review.model import Performer, Sitting

Reading = tuple[list[Recording], ImportReport, ReadOptions]


class Rereading(Worker):
    """Puts other readings of files in the place of those that are open.

    Parameters
    ----------
    bridge
        The document's door.
    jobs
        Runs the reading.
    messages
        Is told what went wrong.
    opening
        Remembers how files are read.
    parent
        Qt's parent.
    """

    def __init__(
        self,
        bridge: DocumentBridge,
        jobs: Jobs,
        messages: Messages,
        opening: Opening,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(bridge, jobs, messages, parent)
        self._opening = opening

    @property
    def _imports(self) -> Imports:
        return self._opening.imports

    def touched(self, path: Path) -> tuple[str, ...]:
        """Return the performers of a file about whom something was decided: it would be lost."""
        sitting = self._bridge.state.sitting
        edited = tuple(one.id for one in self._markers(path) if _touched(sitting, one.id))
        if self._imports.solved(path):
            # What was solved from markers stays.
            return edited
        own = tuple(one.id for one in self._performers(path) if _touched(sitting, one.id))
        return (*own, *edited)

    def look(self, path: Path) -> None:
        """Find out what is odd about a file that came with a session."""
        takes: list[Recording] = [one.take for one in self._performers(path)]
        takes += [one.take for one in self._markers(path)]
        rates = [one.rate for one in takes]
        known = next((one.source.options for one in takes if one.source is not None), None)

        def work() -> Reading:
            # As the session has kept it; one from an earlier version may not have.
            options = known or self._opening.manner.of(path)
            try:
                return (*read_any(path, options), options)
            except NoRateError:
                # It was told when the file was first opened, and the session kept it.
                options = replace(options, fps=rates[0] if rates else None)
                return (*read_any(path, options), options)

        self._start(path, work, self._note)

    def read(self, path: Path, options: ReadOptions) -> None:
        """Read a file anew; what was decided about its performers is forgotten.

        Where it cannot be read so, all stays as it was.
        """
        self._start(path, lambda: (*read_any(path, options), options), partial(self._replace, path))

    def _start(
        self, path: Path, read: Callable[[], Reading], done: Callable[[Reading], None]
    ) -> None:
        def work() -> Generator[Progress, None, Reading]:
            yield Progress(0.0, f"reading {path.name}")
            return read()

        self._have_done(
            f"Reading {path.name}",
            work(),
            done,
            f"{path.name} could not be read like this",
            f"read {path}",
        )

    def _note(self, reading: Reading) -> None:
        self._imports.note(imported(*reading))

    def _replace(self, path: Path, reading: Reading) -> None:
        found, report, options = reading
        takes = [one for one in found if isinstance(one, Take)]
        self._opening.read_otherwise(path, options)
        self._note((list(takes or found), report, options))
        if not takes:
            # What was solved from them stays; they have to be solved again.
            self._put_markers([one for one in found if isinstance(one, MarkerTake)])
            return
        self._put(self._performers(path), takes)
        self._messages.tell(f"{path.name} was read again.")

    def _put(self, performers: Sequence[Performer], takes: Sequence[Take]) -> None:
        document = self._bridge.document
        left = {one.source.performer if one.source else 0: one for one in takes}
        for old in performers:
            number = old.take.source.performer if old.take.source else 0
            new = left.pop(number, None)
            if new is None:
                document.close_performer(old.id)
            else:
                document.replace_take(old.id, new)
        for take in left.values():
            document.open_take(take, partner=all(one.partner for one in performers))

    def _put_markers(self, takes: Sequence[MarkerTake]) -> None:
        document, left = self._bridge.document, list(takes)
        for old in self._bridge.state.markers:
            for take in takes:
                if _same_performer(old.take, take):
                    document.replace_markers(old.id, take)
                    left.remove(take)
        if left:
            self._opening.markers_found.emit(tuple(left), False)

    def _markers(self, path: Path) -> list[MarkerPerformer]:
        wanted, markers = path.resolve(), self._bridge.state.markers
        return [one for one in markers if self._imports.file_of(one.take) == wanted]

    def _performers(self, path: Path) -> list[Performer]:
        wanted, scene = path.resolve(), self._bridge.state.scene
        return [one for one in scene.performers if self._imports.file_of(one.take) == wanted]


def _touched(sitting: Sitting, performer: str) -> bool:
    named = {name for name, _ in sitting.trims}
    named |= {one.performer for one in sitting.edits}
    named |= {one.performer for one in sitting.decisions}
    named |= {one.performer for one in sitting.protected}
    named |= {one.performer for one in sitting.contacts}
    named |= {one.performer for one in sitting.points}
    named |= {one.performer for one in sitting.marker_edits}
    return performer in named


def _same_performer(one: MarkerTake, other: MarkerTake) -> bool:
    if one.source is None or other.source is None:
        return False
    same_file = one.source.path.resolve() == other.source.path.resolve()
    return same_file and one.source.performer == other.source.performer
