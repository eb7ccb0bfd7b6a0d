"""Detection with the learnt decision: prepare the context, then detect."""

from __future__ import annotations

from collections.abc import Generator, Sequence

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.decision.examples import TooLittleToLearnError
from mocapstudio.cleaning.decision.model import Decision
from mocapstudio.cleaning.decision.store import prepare
from mocapstudio.cleaning.detection import DEFAULTS, detect
from mocapstudio.cleaning.parameters import PAPER, DetectionParameters
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.progress import Progress, scaled
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import comparable_joints

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

    The first time learning takes a while, from a small context some 14 to 50 s on two cores; what
    was learnt is kept by the content of the context. Where there is too little to learn from, and
    in the paper's mode, the plain map is drawn.

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
            decision = yield from scaled(learning, 0.0, _PREPARING)
        except TooLittleToLearnError:
            decision = None
    detecting = detect(
        take, context, parameters, decision=decision, normal=normal, protected=protected
    )
    return (yield from scaled(detecting, _PREPARING, 1.0))
