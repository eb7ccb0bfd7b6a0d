"""The engine's own modes, in the form that the benchmark runs."""

from __future__ import annotations

from collections.abc import Sequence

from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.parameters import CALIBRATED, PAPER, DetectionParameters
from mocapstudio.evaluation.detection_benchmark import Detection, Detector
from mocapstudio.evaluation.scoring import THRESHOLDS
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take


def engine(parameters: DetectionParameters, *, curve: bool = True) -> Detector:
    """Detection with these parameters, re-flagged at every threshold where a curve is asked for."""

    def detector(take: Take, context: Sequence[Take]) -> Detection:
        analysis = run(detect(take, context, parameters))
        sweep = {t: analysis.with_threshold(t).flags for t in THRESHOLDS} if curve else {}
        return Detection(analysis.flags, sweep)

    return detector


def ours() -> Detector:
    """Return the default engine."""
    return engine(DetectionParameters(mode=CALIBRATED))


def literal() -> Detector:
    """Return paper 1's method as it is printed."""
    return engine(DetectionParameters(mode=PAPER))
