"""The map of the take under review with another context, drawn in the background."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.reading import reading_context
from mocapstudio.gui.trouble import Trouble, understand
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.progress import Progress, scaled
from mocapstudio.motion.recording import without_itself
from mocapstudio.motion.take import Take
from mocapstudio.review.state import DocumentState

if TYPE_CHECKING:
    from mocapstudio.cleaning.analysis import Analysis
    from mocapstudio.cleaning.parameters import DetectionParameters

_KEY = "second map"
_READING = 0.2


@dataclass(frozen=True)
class OtherContext:
    """What the take is compared with instead; with nothing given, with itself alone.

    Parameters
    ----------
    take
        Name of the one take of the context that is kept, or "".
    folder
        A folder of takes to use instead, or None.
    """

    take: str = ""
    folder: Path | None = None

    def __str__(self) -> str:
        if self.folder is not None:
            return self.folder.name
        return f"{self.take} only" if self.take else "the take alone"


class SecondMap(QObject):
    """Analyses the take under review a second time, while somebody looks at it.

    Parameters
    ----------
    bridge
        The document's door.
    jobs
        Runs the analysis.
    parent
        Qt's parent.
    """

    changed = Signal()
    """Emitted when anything below is another."""

    def __init__(self, bridge: DocumentBridge, jobs: Jobs, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._bridge, self._jobs = bridge, jobs
        self._asked: tuple[object, ...] = ()
        self.context = OtherContext()
        self.analysis: Analysis | None = None
        self.trouble: Trouble | None = None
        self.running = False
        bridge.changed.connect(lambda _old, _new: self._follow())
        bridge.ui_changed.connect(lambda _old, _new: self._follow())

    def choose(self, context: OtherContext) -> None:
        """Compare with something else; the same again draws anew what was stopped."""
        if context == self.context and (self.running or self.analysis is not None):
            return
        self.context, self._asked = context, ()
        self._follow()

    def _follow(self) -> None:
        """Draw anew where what it depends on changed; nothing while nobody looks."""
        state, ui = self._bridge.state, self._bridge.ui
        first = state.analysis
        if ui.beside != "map":
            if self.running:
                self._asked = ()
                self._jobs.cancel(_KEY)
            return
        if first is None or ui.analysing:
            return
        # Another threshold only raises other flags.
        asked = (first.corpus, first.learnt, state.mode, self.context)
        if asked != self._asked:
            self._asked = asked
            self._start(state, first)
        elif self.analysis is not None and self.analysis.parameters.threshold != state.threshold:
            self._set(self.analysis.with_threshold(state.threshold))

    def _start(self, state: DocumentState, first: Analysis) -> None:
        document, asked = self._bridge.document, self._asked
        work = _drawn(
            first,
            self.context,
            replace(first.parameters, threshold=state.threshold),
            document.normal(state.active),
            document.protected(state.active),
        )

        def ended() -> None:
            if asked == self._asked and self.running:
                self.running = False
                self.changed.emit()

        job = self._jobs.start(
            f"Map against {self.context}",
            work,
            lambda analysis: self._set(analysis) if asked == self._asked else None,
            lambda error: self._fail(error) if asked == self._asked else None,
            key=_KEY,
        )
        self.analysis, self.trouble, self.running = None, None, True
        job.ended.connect(ended)
        self.changed.emit()

    def _set(self, analysis: Analysis) -> None:
        self.analysis = analysis
        self.changed.emit()

    def _fail(self, error: BaseException) -> None:
        self.trouble = understand(error, "The second map could not be drawn")
        self.changed.emit()


def _drawn(
    first: Analysis,
    other: OtherContext,
    parameters: DetectionParameters,
    normal: Sequence[Declared],
    protected: Sequence[Declared],
) -> Generator[Progress, None, Analysis]:
    from mocapstudio.cleaning.detection import detect
    from mocapstudio.cleaning.refined import detect_refined

    context: Sequence[Take] = ()
    if other.folder is not None:
        reading = reading_context([other.folder], "Reading the other context", first.take)
        read = yield from scaled(reading, 0.0, _READING)
        context = without_itself(read.takes, first.take)
        if not context:
            raise MocapError(f"{other.folder}: no take of this skeleton but the one under review")
    elif other.take:
        context = [one for one in first.context if one.name == other.take]
    # Both maps are made in the same way, or they could not be compared.
    detecting = detect_refined if first.learnt else detect
    work = detecting(first.take, context, parameters, normal=normal, protected=protected)
    return (yield from scaled(work, _READING if other.folder is not None else 0.0, 1.0))
