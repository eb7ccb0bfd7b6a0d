"""The document of a sitting: the one place where its state changes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

from mocapstudio.cleaning.model import Flag
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.take import Take
from mocapstudio.review import replay
from mocapstudio.review.contacts import Contacting
from mocapstudio.review.core import lasting
from mocapstudio.review.deciding import Deciding
from mocapstudio.review.history import History
from mocapstudio.review.marker_model import MarkerPerformer
from mocapstudio.review.marking import Marking
from mocapstudio.review.model import Scene, Sitting, Verdict
from mocapstudio.review.recorder import Recovered
from mocapstudio.review.rows import rows_of, union
from mocapstudio.review.state import DocumentState, SessionProblem
from mocapstudio.review.viewing import Viewing

__all__ = ["Document", "DocumentState", "SessionProblem"]


class Document(Viewing, Deciding, Contacting, Marking):
    """State of a sitting, the intents that change it, and the listeners that are told.

    Intents act on the active performer unless they name one. An intent that cannot be done raises
    `MocapError` and changes nothing. Listeners hear once of each intent that changed the state.

    Parameters
    ----------
    author
        Who decides; by default the name of the user who is logged in.
    clock
        Returns the present time, for tests.
    """

    save: str = ""
    """Id of the last save, "" while unsaved."""

    recovered: Recovered | None = None
    """The journal this document was recovered from, if any."""

    @property
    def context_takes(self) -> tuple[Take, ...]:
        """The takes searched for neighbours, as last set."""
        return self._context

    def source(self, performer: str) -> Take:
        """Return the source take with the sitting's trim: what detection works on."""
        return self._sources.of(performer, self._take(performer), (), self._trim(performer))

    def declared(self, performer: str) -> tuple[Declared, ...]:
        """Rows × spans that unmuted edits of a performer may change."""
        self._take(performer)
        return replay.declared(e for e in self._state.sitting.edits if e.performer == performer)

    def flags(self, performer: str) -> tuple[Flag, ...]:
        """Flags of a performer's latest analysis, or those that its session file had kept."""
        return self._analyses.flags(performer)

    def choices(self, performer: str) -> Mapping[str, int | None]:
        """Neighbour chosen for each of a performer's flags, by flag id."""
        return self._analyses.choices(performer)

    def normal(self, performer: str) -> tuple[Declared, ...]:
        """Rejected rows × spans: normal for the next analysis."""
        return union(
            Declared(d.flag.joint, d.flag.start, d.flag.end)
            for d in self._state.sitting.decisions
            if d.performer == performer and d.verdict is Verdict.REJECTED
        )

    def protected(self, performer: str) -> tuple[Declared, ...]:
        """Protected rows × spans of a performer."""
        every = rows_of(self._take(performer))
        return union(
            Declared(row, p.start, p.end)
            for p in self._state.sitting.protected
            if p.performer == performer
            for row in (p.joints or every)
        )

    def restore(
        self,
        scene: Scene,
        history: History,
        flags: Mapping[str, Sequence[Flag]],
        choices: Mapping[str, Mapping[str, int | None]],
        **view: Any,
    ) -> None:
        """Put a saved sitting in the place of an empty one.

        Parameters
        ----------
        flags, choices
            By performer id.
        view
            Other fields of `DocumentState`.
        """
        self._history = history
        for performer, kept in flags.items():
            self._analyses.restore(performer, kept, choices.get(performer, {}))
        self._put(scene=scene, **view)

    def mark_saved(self, path: Path, save: str, sitting: Sitting | None = None) -> None:
        """Note what stands in the session file: the document, or that sitting of it.

        Parameters
        ----------
        save
            Id of that save.
        """
        self.save = save
        state = self._state if sitting is None else replace(self._state, sitting=sitting)
        self._saved = lasting(state)
        self._put(path=Path(path))

    def mark_comparison_unsaved(self) -> None:
        """Note that the session file holds another comparison."""
        self._saved = self._saved | {"comparison": ()}
        self._put()

    def set_problems(self, problems: Iterable[SessionProblem]) -> None:
        """Say what was wrong when the session was opened; nothing once the user has seen it."""
        self._put(problems=tuple(problems))

    @property
    def saved_sitting(self) -> Sitting:
        """The sitting that stands in the session file; an empty one without a file."""
        return cast("Sitting", self._saved["sitting"])

    @property
    def saved_ids(self) -> frozenset[str]:
        """Ids of all whose takes stand in the session file; none without a file."""
        scene = cast("Scene", self._saved["scene"])
        markers = cast("tuple[MarkerPerformer, ...]", self._saved["markers"])
        return frozenset({one.id for one in scene.performers} | {one.id for one in markers})
