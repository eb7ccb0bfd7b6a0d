"""Why the selected flag was raised and what is proposed for it, worked out in the background."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from mocapstudio.cleaning.model import Flag, Neighbour, Proposal
from mocapstudio.gui.document import DocumentBridge, UiState
from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.trouble import Trouble, understand
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.motion.progress import Progress, scaled
from mocapstudio.review.state import DocumentState

if TYPE_CHECKING:
    from mocapstudio.cleaning.analysis import Analysis
    from mocapstudio.cleaning.contacts.keeping import Kept
    from mocapstudio.cleaning.distance_profile import DistanceProfile

_KEY = "reasons"


@dataclass(frozen=True, eq=False)
class Reason:
    """Neighbours of a flag, nearest first, and the profile they are minima of; or what is wrong."""

    neighbours: tuple[Neighbour, ...] | None = None
    profile: DistanceProfile | None = None
    trouble: Trouble | None = None


class Reasons(QObject):
    """Keeps neighbours and proposal of the selected flag up to date.

    Parameters
    ----------
    bridge
        The document's door; proposals are handed to its document.
    jobs
        Runs the search.
    parent
        Qt's parent.
    """

    changed = Signal()
    """Emitted when `current` is another."""

    def __init__(self, bridge: DocumentBridge, jobs: Jobs, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._bridge, self._jobs = bridge, jobs
        self._asked: tuple[object, ...] = ()
        self._current = Reason()
        bridge.changed.connect(self._follow)
        bridge.ui_changed.connect(self._follow_ui)

    @property
    def current(self) -> Reason:
        """The reason of the selected flag; without neighbours while they are looked for."""
        return self._current

    def choose(self, neighbour: int | None) -> None:
        """Preview a neighbour's motion as the proposal; the same again, or None: the best."""
        item = self._bridge.state.selected
        if item is None or item.flag.joint in ROOT_ROWS:
            return
        known = self._current.neighbours
        if neighbour is not None and known is not None and neighbour >= len(known):
            return
        if neighbour == self._bridge.ui.preview:
            neighbour = None
        self._bridge.set_ui(preview=neighbour)

    def _follow(self, old: DocumentState, new: DocumentState) -> None:
        if old.selection.flag != new.selection.flag or old.active != new.active:
            flag = new.selection.flag
            self._bridge.set_ui(preview=None if flag is None else new.choices.get(flag))
        self._look()

    def _follow_ui(self, old: UiState, new: UiState) -> None:
        if old.preview != new.preview:
            self._look()

    def _look(self) -> None:
        state, choice = self._bridge.state, self._bridge.ui.preview
        item, analysis = state.selected, state.analysis
        flag = None if item is None else item.flag
        asked = (flag, analysis, choice, state.keep_ends, state.sitting.contacts)
        if asked == self._asked:
            return
        same_flag = self._asked[:2] == asked[:2]
        self._asked = asked
        if not same_flag:
            self._set(Reason())
        if flag is None or analysis is None:
            self._jobs.cancel(_KEY)
            return
        if flag.id in state.proposals and state.choices.get(flag.id) == choice and same_flag:
            return
        self._jobs.start(
            f"Proposal for {flag.joint}",
            _work(analysis, flag, choice, self._bridge.document.kept(state.active)),
            lambda found: self._found(asked, found),
            lambda error: self._failed(asked, error),
            key=_KEY,
        )

    def _found(self, asked: tuple[object, ...], found: tuple[Reason, Proposal]) -> None:
        if asked != self._asked:
            return
        flag, _, choice, *_ = asked
        reason, proposal = found
        self._set(reason)
        assert isinstance(flag, Flag)
        assert choice is None or isinstance(choice, int)
        self._bridge.document.set_proposal(flag.id, choice, proposal)

    def _failed(self, asked: tuple[object, ...], error: BaseException) -> None:
        if asked == self._asked:
            trouble = understand(error, "No proposal could be made")
            self._set(replace(self._current, trouble=trouble))

    def _set(self, reason: Reason) -> None:
        self._current = reason
        self.changed.emit()


def _work(
    analysis: Analysis, flag: Flag, choice: int | None, kept: Kept
) -> Generator[Progress, None, tuple[Reason, Proposal]]:
    from mocapstudio.cleaning import distance_profile, reasons
    from mocapstudio.cleaning.contacts.keeping import propose_keeping

    yield Progress(0.0, "looking for neighbours")
    profile = yield from scaled(distance_profile.measuring(analysis, flag), 0.0, 0.6)
    neighbours = reasons.neighbours(analysis, flag)
    yield Progress(0.6, "making the proposal")
    return Reason(neighbours, profile), propose_keeping(analysis, flag, choice, kept=kept)
