"""From records to a document: what was saved, what a journal adds, and the takes found again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from mocapstudio.cleaning.parameters import DetectionParameters
from mocapstudio.motion.errors import FileError, ParameterError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.review.comparing_kept import KeptComparison
from mocapstudio.review.comparing_wire import Recording, check_comparison, unpack_comparison
from mocapstudio.review.document import Document
from mocapstudio.review.history import History
from mocapstudio.review.journal_records import (
    Closed,
    Compared,
    Event,
    Found,
    Opened,
    Settled,
    Stepped,
    advanced,
    from_text,
)
from mocapstudio.review.manner import AS_THEY_ARE, Manner, unpack_manner
from mocapstudio.review.marker_model import MarkerPerformer
from mocapstudio.review.model import Performer, Scene, Selection
from mocapstudio.review.recorder import Recovered
from mocapstudio.review.records import Arrays, MalformedError
from mocapstudio.review.references import Finder, Relocate
from mocapstudio.review.references import Found as FoundTake
from mocapstudio.review.session_record import SessionRecord
from mocapstudio.review.state import SessionProblem
from mocapstudio.review.take_record import TakeRecord, absolute
from mocapstudio.review.wire import unpack, unpack_flag


def journal_path(path: Path) -> Path:
    """Where the journal of a session file lies."""
    return path.with_name(f"{path.name}.journal")


class Opening:
    """Gathers what is known of a sitting, then makes its document.

    Parameters
    ----------
    record, arrays
        Of the session file; an empty record for a sitting that was never saved.
    path
        The session file, or None.
    relocate
        As for `session_file.load`.

    Raises
    ------
    FileError
        If samples are missing or damaged.
    """

    def __init__(
        self, record: SessionRecord, arrays: Arrays, path: Path | None, relocate: Relocate | None
    ) -> None:
        self._record, self._arrays, self._path = record, arrays, path
        self._finder = Finder(None if path is None else path.parent, relocate)
        try:
            saved = unpack(record.sitting, arrays)
        except MalformedError as error:
            raise FileError(path or "-", f"is damaged: {error}") from error
        self._history = History(saved)
        self._saved = saved
        self._takes = {take.id: take for take in record.takes}
        self._settled: Settled | None = None
        self._comparison = record.comparison
        self._problems: list[SessionProblem] = []
        self._recovered: Recovered | None = None

    def tell(self, path: Path, what: str, performer: str | None = None) -> None:
        """Add a problem that the user will be told."""
        self._problems.append(SessionProblem(path, what, performer))

    def replay(self, found: Found) -> None:
        """Do again what a journal says, up to its first damaged record.

        A journal that follows another save than the one at hand was folded in already.
        """
        if found.base != self._record.save:
            return
        done = 0
        try:
            for event in found.events:
                self._one(event)
                done += isinstance(event, Stepped)
        except MalformedError as error:
            self.tell(found.path, f"cannot be recovered in full: {error}")
        if done:
            steps = f"{done} step{'' if done == 1 else 's'}"
            self.tell(found.path, f"{steps} recovered that had not been saved")
        if found.lost:
            self.tell(found.path, f"its end is torn, {found.lost} bytes were left out")
        self._recovered = Recovered(found.path, found.length)

    def _one(self, event: Event) -> None:
        match event:
            case Opened(take, samples):
                self._arrays |= from_text(samples)
                self._takes[take.id] = take
            case Closed(performer):
                self._takes.pop(performer, None)
                self._history = advanced(self._history, event)
            case Settled():
                self._settled = event
            case Compared(comparison, samples):
                self._arrays |= from_text(samples)
                check_comparison(comparison)
                self._comparison = comparison
            case _:
                self._history = advanced(self._history, event)

    def document(self, author: str | None = None) -> Document:
        """Find the takes and make the document."""
        document = Document(author)
        performers: list[Performer] = []
        markers: list[MarkerPerformer] = []
        absent: list[TakeRecord] = []
        for record in self._takes.values():
            performer = self._performer(record)
            if isinstance(performer, MarkerPerformer):
                markers.append(performer)
            elif performer is not None:
                performers.append(performer)
            else:
                absent.append(record)
        document.absent = tuple(absent)
        scene = Scene(tuple(performers))
        document.restore(
            scene,
            self._history,
            {p: tuple(map(unpack_flag, flags)) for p, flags in self._record.flags.items()},
            self._record.choices,
            context=self._context(),
            parameters=self._parameters(),
            manner=self._manner(),
            markers=tuple(markers),
            comparison=self._kept(),
            **self._view(scene),
        )
        if self._path is not None:
            document.mark_saved(self._path, self._record.save, self._saved)
            if self._comparison != self._record.comparison:
                document.mark_comparison_unsaved()
        document.recovered = self._recovered
        document.set_problems(self._problems)
        return document

    def _performer(self, record: TakeRecord) -> Performer | MarkerPerformer | None:
        found = self._find(record)
        if found.problem is not None:
            self.tell(Path(record.absolute or record.name), found.problem, record.id)
        if found.take is None:
            return None
        if isinstance(found.take, MarkerTake):
            return MarkerPerformer(record.id, found.take)
        places = {} if self._settled is None else self._settled.places
        offset, partner = places.get(record.id, (record.offset, record.partner))
        return Performer(record.id, found.take, offset, partner)

    def _find(self, record: TakeRecord) -> FoundTake:
        try:
            return self._finder.find(record, self._arrays)
        except MalformedError as error:
            raise FileError(self._path or "-", f"is damaged: {error}") from error

    def _kept(self) -> KeptComparison:
        folder = None if self._path is None else self._path.parent
        path = self._path or Path("-")
        return unpack_comparison(
            self._comparison, folder, self._compared, lambda what: self.tell(path, what)
        )

    def _compared(self, record: TakeRecord) -> Recording | None:
        found = self._find(record)
        if found.problem is not None:
            self.tell(Path(record.absolute or record.name), f"compared: {found.problem}")
        return found.take

    def _context(self) -> tuple[Path, ...]:
        if self._settled is not None:
            return tuple(Path(one) for one in self._settled.context)
        folder = None if self._path is None else self._path.parent
        paths = []
        for one in self._record.context:
            beside = None if folder is None or one.relative is None else folder / one.relative
            there = beside is not None and beside.exists()
            path = absolute(beside) if beside is not None and there else None
            paths.append(path or Path(one.absolute))
            if not paths[-1].exists():
                self.tell(paths[-1], "of the context is missing")
        return tuple(paths)

    def _parameters(self) -> DetectionParameters:
        kept: Mapping[str, Any] = (
            self._record.parameters if self._settled is None else self._settled.parameters
        )
        default = DetectionParameters()
        known = {name: value for name, value in kept.items() if hasattr(default, name)}
        try:
            return replace(default, **known)
        except (ParameterError, TypeError) as error:
            self.tell(self._path or Path("-"), f"its parameters are not used: {error}")
            return default

    def _manner(self) -> Manner:
        kept = (self._settled or self._record).manner
        try:
            return unpack_manner(kept)
        except MalformedError as error:
            self.tell(self._path or Path("-"), f"its manner of reading is not used: {error}")
            return AS_THEY_ARE

    def _view(self, scene: Scene) -> dict[str, Any]:
        record = self._record
        wanted = record.active if self._settled is None else self._settled.active
        ids = [p.id for p in scene.performers]
        if wanted not in ids:
            active = next((p.id for p in scene.performers if not p.partner), "")
            active = active or (ids[0] if ids else "")
            return {"active": active, "selection": Selection(active)}
        if wanted != record.active:
            return {"active": wanted, "selection": Selection(wanted)}
        take = scene.performer(wanted).take
        selection = Selection(wanted, frozenset(record.joints), record.span, record.flag)
        frame = min(max(record.frame, 0), take.frames - 1)
        return {"active": wanted, "selection": selection, "frame": frame}
