"""Detection with the learnt decision: prepare the context, then detect."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from typing import TypeVar

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.decision.model import Decision
from mocapstudio.cleaning.decision.store import prepare
from mocapstudio.cleaning.decision.training import TooLittleToLearnError
from mocapstudio.cleaning.detection import DEFAULTS, detect
from mocapstudio.cleaning.parameters import PAPER, DetectionParameters
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import comparable_joints

Result = TypeVar("Result")

_PREPARING = 0.9


def detect_refined(
    take: Take,
    context: Sequence[Take] = (),
    parameters: DetectionParameters = DEFAULTS,
    *,
    known: Sequence[Take] = (),
    normal: Sequence[Declared] = (),
    protected: Sequence[Declared] = (),
) -> Generator[Progress, None, Analysis]:
    """Do what `detect` does, with a decision learnt from the context.

    The first time learning takes some ten seconds; what was learnt is kept by the content of the
    context. Where there is too little to learn from, and in the paper's mode, the plain map is
    drawn.

    Parameters
    ----------
    take, context, parameters, normal, protected
        As in `detection.detect`.
    known
        Takes to learn from, where they are others than `context`: several takes of one folder
        share one decision. The take itself where there is no context at all.

    Raises
    ------
    SkeletonMismatchError, MocapError
        As in `detection.detect`.
    """
    # A context of another skeleton is refused before anything is learnt from it.
    comparable_joints(take, context)
    decision: Decision | None = None
    if parameters.mode != PAPER:
        try:
            learning = prepare(tuple(known) or tuple(context) or (take,))
            decision = yield from _scaled(learning, 0.0, _PREPARING)
        except TooLittleToLearnError:
            decision = None
    detecting = detect(
        take, context, parameters, decision=decision, normal=normal, protected=protected
    )
    return (yield from _scaled(detecting, _PREPARING, 1.0))


def _scaled(
    work: Generator[Progress, None, Result], low: float, high: float
) -> Generator[Progress, None, Result]:
    """Pass progress on as a part of a larger piece of work."""
    try:
        while True:
            progress = next(work)
            yield Progress(low + (high - low) * progress.done, progress.what)
    except StopIteration as stop:
        result: Result = stop.value
        return result
    finally:
        work.close()
