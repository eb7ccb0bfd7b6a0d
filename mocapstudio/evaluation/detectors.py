"""The engine's own modes, in the form that the benchmark runs."""

from __future__ import annotations

from collections.abc import Sequence

from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.parameters import CALIBRATED, PAPER, DetectionParameters
from mocapstudio.cleaning.refined import detect_refined
from mocapstudio.evaluation.detection_benchmark import Detection, Detector
from mocapstudio.evaluation.scoring import THRESHOLDS
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take


def engine(
    parameters: DetectionParameters, *, curve: bool = True, learnt: bool = False
) -> Detector:
    """Detection with these parameters, re-flagged at every threshold where a curve is asked for.

    `learnt` asks for the decision learnt from the context, or from the take itself without one.
    """
    find = detect_refined if learnt else detect

    def detector(take: Take, context: Sequence[Take]) -> Detection:
        analysis = run(find(take, context, parameters))
        sweep = {t: analysis.with_threshold(t).flags for t in THRESHOLDS} if curve else {}
        return Detection(analysis.flags, sweep)

    return detector


def ours() -> Detector:
    """Return the default engine."""
    return engine(DetectionParameters(mode=CALIBRATED), learnt=True)


def plain() -> Detector:
    """Return the default engine before it has learnt anything: the first map."""
    return engine(DetectionParameters(mode=CALIBRATED))


def literal() -> Detector:
    """Return paper 1's method as it is printed."""
    return engine(DetectionParameters(mode=PAPER))
