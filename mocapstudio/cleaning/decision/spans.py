"""The second decision: candidate spans judged as a whole, by length, shape and company."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.decision.features import COLUMN
from mocapstudio.cleaning.decision.forest import Forest

F32 = NDArray[np.float32]

CANDIDATE = 0.15
RARER = 4.5
"""How many times rarer errors are taken to be than in the examples: measured, not counted."""
_BRIDGE = 2
_WATCHED = (
    "context mean usual", "given others usual", "given limbs usual", "context mean onset",
    "own mean onset", "context velocity", "own nearest", "pop", "jitter",
)  # fmt: skip
_SURROUNDING = ("context distance", "context spread", "own distance", "body others", "speed")
NAMES = (
    "length", "highest", "mean", "total", "before", "after", "from start", "to end",
    *(f"{name} highest" for name in _WATCHED),
    *(f"{name} mean" for name in _SURROUNDING),
    "velocity at start", "velocity at end", "limb highest", "limb rows", "other rows",
    "share of take", "take usual",
)  # fmt: skip


@dataclass(frozen=True)
class Candidate:
    """Half-open span of texture frames of one row."""

    row: int
    start: int
    end: int


def candidates(probability: F32) -> list[Candidate]:
    """Spans of (S, m) above CANDIDATE, gaps of up to two frames closed."""
    found = []
    for row in range(probability.shape[1]):
        above = np.concatenate([[False], probability[:, row] > CANDIDATE, [False]])
        edges = np.flatnonzero(above[1:] != above[:-1])
        spans: list[tuple[int, int]] = []
        for start, end in zip(edges[::2], edges[1::2], strict=True):
            if spans and start - spans[-1][1] <= _BRIDGE:
                spans[-1] = (spans[-1][0], int(end))
            else:
                spans.append((int(start), int(end)))
        found += [Candidate(row, *span) for span in spans]
    return found


def span_features(
    probability: F32, joints: F32, limb: NDArray[np.int64], spans: Sequence[Candidate]
) -> F32:
    """Describe candidate spans of joints.

    Parameters
    ----------
    probability
        (S, m) of the first decision.
    joints
        (S, m, .) features.
    limb
        (m,) which limb each joint belongs to.
    spans
        n candidates.

    Returns
    -------
    (n, len(NAMES)) float32.
    """
    out = np.full((len(spans), len(NAMES)), np.nan, dtype=np.float32)
    above: NDArray[np.bool_] = np.asarray(np.greater(probability, CANDIDATE))
    frames = len(probability)
    usual = float(np.nanquantile(joints[..., COLUMN["context mean usual"]], 0.9))
    for i, span in enumerate(spans):
        inside = slice(span.start, span.end)
        p = probability[inside, span.row]
        rows = np.any(above[inside], axis=0)
        mates = np.flatnonzero((limb == limb[span.row]) & (np.arange(len(limb)) != span.row))
        values: list[float] = [
            span.end - span.start, p.max(), p.mean(), p.sum(),
            probability[max(span.start - 2, 0), span.row],
            probability[min(span.end + 1, frames - 1), span.row],
            span.start, frames - span.end,
            *_of_joint(joints, span),
            probability[inside][:, mates].max() if len(mates) else 0.0,
            rows[mates].sum(), rows.sum() - rows[mates].sum() - 1,
            above.mean(), usual,
        ]  # fmt: skip
        out[i] = values
    return out


def _of_joint(joints: F32, span: Candidate) -> list[float]:
    f = joints[span.start : span.end, span.row]
    velocity = joints[:, span.row, COLUMN["context velocity"]]
    return [
        *np.nan_to_num(f[:, [COLUMN[name] for name in _WATCHED]], nan=-1.0).max(axis=0),
        *f[:, [COLUMN[name] for name in _SURROUNDING]].mean(axis=0),
        velocity[max(span.start - 1, 0) : span.start + 2].max(),
        velocity[max(span.end - 2, 0) : span.end + 1].max(),
    ]


def judged(probability: F32, joints: F32, limb: NDArray[np.int64], forest: Forest) -> F32:
    """Let the second decision weigh the first: a span's peak becomes the span's probability.

    Only joints are weighed; of the root's rows the first decision tells enough. Errors are rarer
    in real takes than in the examples; the odds are corrected for that.

    Parameters
    ----------
    probability
        (S, m + 2) of the first decision.
    joints, limb
        As in `span_features`.
    forest
        The second decision.
    """
    m = len(limb)
    result = as_rare(probability)
    spans = candidates(probability[:, :m])
    if not spans:
        return result
    verdicts = as_rare(forest.probability(span_features(probability[:, :m], joints, limb, spans)))
    for span, verdict in zip(spans, verdicts, strict=True):
        inside = slice(span.start, span.end)
        p = probability[inside, span.row]
        # The shape stays; half of the peak marks the edges.
        result[inside, span.row] = verdict * np.sqrt(p / p.max())
    return result


def as_rare(probability: F32) -> F32:
    """Correct probabilities, of any shape, for how much rarer errors are than in the examples."""
    return np.asarray(probability / (probability + RARER * (1.0 - probability)))


def labels_of(labels: NDArray[np.int8], spans: Sequence[Candidate]) -> NDArray[np.int8]:
    """(n,) 1 for spans that hold an error, 0 for spans without, -1 for doubtful ones."""
    verdicts = []
    for span in spans:
        inside = labels[max(span.start - 1, 0) : span.end + 1, span.row]
        wrong, unsure = (inside == 1).mean(), (inside != 0).any()
        verdicts.append(1 if wrong >= 0.2 else (-1 if unsure else 0))
    return np.array(verdicts, dtype=np.int8)
