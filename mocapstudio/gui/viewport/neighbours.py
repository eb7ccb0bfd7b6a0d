"""What the K neighbours of a flag would make of it, worked out one after the other."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal

from mocapstudio.cleaning.model import Flag, Proposal
from mocapstudio.cleaning.proposals import propose
from mocapstudio.cleaning.reasons import neighbours
from mocapstudio.motion.errors import MocapError

if TYPE_CHECKING:
    from mocapstudio.cleaning.analysis import Analysis


class NeighbourProposals(QObject):
    """Proposals made of each neighbour of one flag, between events of the desk."""

    changed = Signal()
    """One more proposal is there."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.ready: tuple[Proposal, ...] = ()
        self._of: tuple[Analysis, Flag] | None = None
        self._left = 0
        self._timer = QTimer(self)
        self._timer.timeout.connect(self._next)

    def ask(self, analysis: Analysis | None, flag: Flag | None) -> None:
        """Begin with the neighbours of a flag, unless it is the same one; None stops."""
        wanted = None if analysis is None or flag is None else (analysis, flag)
        if wanted is not None and self._of is not None:
            same = wanted[0] is self._of[0] and wanted[1] == self._of[1]
            if same:
                return
        self._of, self.ready = wanted, ()
        self._left = -1 if wanted else 0
        if wanted is None:
            self._timer.stop()
        else:
            self._timer.start(0)

    def _next(self) -> None:
        assert self._of is not None
        analysis, flag = self._of
        if self._left < 0:
            self._left = len(neighbours(analysis, flag))
        if len(self.ready) < self._left:
            try:
                made = propose(analysis, flag, choice=len(self.ready))
            except MocapError:
                # A neighbour that cannot serve (protected, too short) is simply not drawn.
                self._left = len(self.ready)
            else:
                self.ready = (*self.ready, made)
                self.changed.emit()
        if len(self.ready) >= self._left:
            self._timer.stop()
