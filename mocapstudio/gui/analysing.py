"""Keeps the analysis of the take under review up to date, in the background."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from mocapstudio.cleaning.parameters import CALIBRATED, DetectionParameters
from mocapstudio.gui import settings
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.messages import Messages
from mocapstudio.gui.worker import Worker
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import SkeletonMismatchError
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.recording import same_recording, without_itself
from mocapstudio.motion.take import Take
from mocapstudio.review.state import DocumentState

if TYPE_CHECKING:
    from mocapstudio.cleaning.analysis import Analysis

_KEY = "analysis"


class Analysing(Worker):
    """Analyses a take when it comes under review, and again when what it depends on changes.

    Parameters
    ----------
    bridge
        The document's door.
    jobs
        Runs the analysis.
    messages
        Is told what went wrong.
    parent
        Qt's parent.
    """

    def __init__(
        self,
        bridge: DocumentBridge,
        jobs: Jobs,
        messages: Messages,
        parent: QObject | None = None,
    ) -> None:
        super().__init__(bridge, jobs, messages, parent)
        self._done: dict[str, tuple[object, ...]] = {}
        bridge.changed.connect(self._follow)

    def again(self) -> None:
        """Analyse the take under review, whether or not anything changed."""
        active = self._bridge.state.active
        if active:
            self._start(active)

    def _follow(self, old: DocumentState, new: DocumentState) -> None:
        for gone in set(self._done) - {one.id for one in new.scene.performers}:
            del self._done[gone]
        if not new.active:
            self._jobs.cancel(_KEY)
        elif self._done.get(new.active) != self._wants(new.active):
            self._start(new.active)

    def _wants(self, performer: str) -> tuple[object, ...]:
        """Return what the analysis depends on, save the threshold: that re-flags at once."""
        state, document = self._bridge.state, self._bridge.document
        return (
            state.scene.performer(performer).take,
            document.context_takes,
            state.mode,
            dict(state.sitting.trims).get(performer),
        )

    def _start(self, performer: str) -> None:
        state, document = self._bridge.state, self._bridge.document
        # Noted before the end, so that a failure or a cancel is not tried over and over.
        self._done[performer] = self._wants(performer)
        generation = document.begin_analysis(performer)
        parameters = state.parameters or DetectionParameters()
        parameters = replace(parameters, mode=state.mode, threshold=state.threshold)
        take = document.source(performer)
        context = without_itself(document.context_takes, take)
        work = _analysis(
            take,
            context,
            parameters,
            document.normal(performer),
            document.protected(performer),
        )

        def finished(analysis: Analysis) -> None:
            if self._bridge.document is not document:
                return
            document.finish_analysis(performer, generation, analysis)
            count = len(analysis.flags)
            words = f"{take.name}: {count} flags" if count != 1 else f"{take.name}: 1 flag"
            unused = len(context) - len(analysis.context)
            if unused:
                words += f"; {unused} takes of the context have another skeleton and were not used"
            self._messages.tell(f"{words}.")
            if parameters.mode == CALIBRATED and self._bridge.ui.learning:
                self._refine(performer, parameters, analysis.context)

        title, failed = f"Analysing {take.name}", f"{take.name} could not be analysed"
        self._analyse(title, work, finished, failed)

    def toggle_learning(self) -> None:
        """Learn from the context, or leave the map as it is first drawn."""
        learning = not self._bridge.ui.learning
        settings.set_flag("learning", learning)
        self._bridge.set_ui(learning=learning)
        self.again()

    def _refine(
        self, performer: str, parameters: DetectionParameters, context: tuple[Take, ...]
    ) -> None:
        """Learn from the context behind the first map, then draw the map anew."""
        document = self._bridge.document
        generation = document.begin_analysis(performer)
        take = document.source(performer)
        alike = [t for t in document.context_takes if t in context or same_recording(t, take)]
        work = _refined(
            take,
            tuple(alike),
            parameters,
            document.normal(performer),
            document.protected(performer),
        )

        def finished(analysis: Analysis) -> None:
            if self._bridge.document is not document:
                return
            # The threshold may have moved while this was learning.
            current = analysis.with_threshold(self._bridge.state.threshold)
            document.finish_analysis(performer, generation, current)
            self._messages.tell(f"{take.name}: map refined, {len(current.flags)} flags.")

        self._analyse("Learning from the context", work, finished, "Nothing could be learnt")

    def _analyse(
        self,
        title: str,
        work: Generator[Progress, None, Analysis],
        finished: Callable[[Analysis], None],
        failed: str,
    ) -> None:
        job = self._have_done(title, work, finished, failed, _KEY)
        job.ended.connect(self._tell)
        self._tell()

    def _tell(self) -> None:
        running = any(job.key == _KEY for job in self._jobs.running)
        self._bridge.set_ui(analysing=running)


def _analysis(
    take: Take,
    context: tuple[Take, ...],
    parameters: DetectionParameters,
    normal: Sequence[Declared],
    protected: Sequence[Declared],
) -> Generator[Progress, None, Analysis]:
    # The first import compiles or loads the kernels: that belongs in the thread too.
    yield Progress(0.0, "loading the engine")
    from mocapstudio.cleaning.detection import detect
    from mocapstudio.similarity.texture import comparable_joints

    def usable(other: Take) -> bool:
        try:
            comparable_joints(take, [other])
        except SkeletonMismatchError:
            return False
        return True

    alike = tuple(other for other in context if usable(other))
    return (yield from detect(take, alike, parameters, normal=normal, protected=protected))


def _refined(
    take: Take,
    context: tuple[Take, ...],
    parameters: DetectionParameters,
    normal: Sequence[Declared],
    protected: Sequence[Declared],
) -> Generator[Progress, None, Analysis]:
    from mocapstudio.cleaning.refined import detect_refined

    others = without_itself(context, take)
    return (
        yield from detect_refined(
            take, others, parameters, known=context, normal=normal, protected=protected
        )
    )
