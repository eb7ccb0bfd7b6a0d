"""Detectors that are nothing but a map of values and a threshold."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import TypeVar

from mocapstudio.cleaning.model import Flag, Kind
from mocapstudio.evaluation.cases import Case
from mocapstudio.evaluation.detection_benchmark import Detection, Detector, evaluate_detector
from mocapstudio.evaluation.scoring import THRESHOLDS
from mocapstudio.evaluation.truth import Array, Mask
from mocapstudio.motion.runs import runs
from mocapstudio.motion.take import Take

ValueMap = Callable[[Take, Sequence[Take]], tuple[tuple[str, ...], Array]]
"""From a take and its context to R rows and (F, R) values in 0..1; above 0.5 is flagged."""

Key = TypeVar("Key", bound=Hashable)

_BRIDGE_SECONDS = 0.125


def detector_of(values_of: ValueMap, *, curve: bool = True) -> Detector:
    """Flag where a map exceeds 0.5; for a curve also at all other thresholds."""

    def detector(take: Take, context: Sequence[Take]) -> Detection:
        rows, values = values_of(take, context)
        rate = float(take.rate)
        thresholds = THRESHOLDS if curve else (0.5,)
        sweep = {t: flags_above(values, rows, t, rate) for t in thresholds}
        return Detection(sweep[0.5], sweep)

    return detector


def flags_above(
    values: Array, rows: Sequence[str], threshold: float, rate: float
) -> tuple[Flag, ...]:
    """Spans of rows of a map (F, R) above the threshold, those nearer than 1/8 s taken as one."""
    flags = []
    for column, row in enumerate(rows):
        for start, end in _bridged(values[:, column] > threshold, round(_BRIDGE_SECONDS * rate)):
            span = values[start:end, column]
            at, peak = start + int(span.argmax()), float(span.max())
            flags.append(
                Flag(f"{row}@{start}", row, (row,), start, end, peak, at, peak, Kind.OFFSET)
            )
    return tuple(flags)


def _bridged(above: Mask, bridge: int) -> list[tuple[int, int]]:
    spans: list[tuple[int, int]] = []
    for start, end in runs(above):
        if spans and start - spans[-1][1] <= bridge:
            spans[-1] = (spans[-1][0], end)
        else:
            spans.append((start, end))
    return spans


def tuned(candidates: Mapping[Key, ValueMap], training: Sequence[Case]) -> Key:
    """Return the key of the candidate with the best word-level F1 on the training cases.

    Ties, and candidates that find nothing, go to the one that comes first.
    """

    def worth(key: Key) -> float:
        detector = detector_of(candidates[key], curve=False)
        f1 = evaluate_detector(detector, training).scores.words.f1
        return f1 if f1 == f1 else 0.0

    return max(candidates, key=worth)
