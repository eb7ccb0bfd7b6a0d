"""Online alignment of performances whose true timing is known."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mocapstudio import formats
from mocapstudio.comparison.live import LiveAlignment, played
from mocapstudio.comparison.online import OnlineAligner, Variant
from mocapstudio.comparison.online_features import F64
from mocapstudio.comparison.online_reference import reference_of
from mocapstudio.evaluation.corpora import long_takes
from mocapstudio.evaluation.kata_warps import Disturbance, perform_again
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.take import Take

RATE = 25
"""Frames a second at which is aligned and in which errors are counted."""

DISTURBANCES = {
    "pace and pauses": Disturbance(noise_degrees=0, style_degrees=0),
    "5° of noise, 10° of style": Disturbance(),
    "the same, 10° of sway, pace up to 2 ×": Disturbance(pace=2.0, sway_degrees=10),
}
METHODS: dict[str, tuple[Variant, bool]] = {
    "plain open-end": (Variant.PLAIN, False),
    "diagonal penalty": (Variant.DIAGONAL, False),
    "path length": (Variant.PATH_LENGTH, False),
    "with motion": (Variant.PLAIN, True),
}

_LEAST_SECONDS = 4.0
_SETTLING_SECONDS = 1.0


@dataclass(frozen=True)
class OnlineWarpRow:
    """How well one method follows one kind of performance.

    Parameters
    ----------
    method, disturbance
        Their names.
    takes
        Performances measured.
    median, high
        Median and 90 % quantile of the distance from the true frame, in frames at `RATE`.
    near
        Share of frames within half a second of the truth.
    """

    method: str
    disturbance: str
    takes: int
    median: float
    high: float
    near: float

    def to_json(self) -> dict[str, Any]:
        """Plain objects for JSON."""
        return asdict(self)


def following_warps(
    data: Sequence[Path], *, seed: int, limit: int
) -> Generator[Progress, None, list[OnlineWarpRow]]:
    """Follow takes that are performed again at another pace, frame by frame.

    Parameters
    ----------
    data
        Takes or folders; of those of joints that last four seconds `limit` are used, the longest
        of them always.
    """
    takes = _takes(data, seed, limit)
    errors: dict[tuple[str, str], list[F64]] = {}
    for i, take in enumerate(takes):
        for kind, how in DISTURBANCES.items():
            yield Progress(i / len(takes), f"following {take.name}")
            again = perform_again(take, how, seed + i)
            for method, (variant, motion) in METHODS.items():
                found = _followed(take, again.take, variant, motion)
                off = np.abs(found - again.truth) / float(take.rate) * RATE
                settled = round(_SETTLING_SECONDS * float(take.rate))
                errors.setdefault((kind, method), []).append(off[settled:])
    rows = []
    for (kind, method), found_errors in errors.items():
        every = np.concatenate(found_errors)
        median, high = np.quantile(every, [0.5, 0.9])
        near = float(np.mean(every <= RATE / 2))
        rows.append(
            OnlineWarpRow(method, kind, len(found_errors), float(median), float(high), near)
        )
    return rows


def _followed(take: Take, again: Take, variant: Variant, motion: bool) -> F64:
    """(F,) reference frame at each frame of the performance."""
    reference = reference_of(take, (again,), min(RATE, float(take.rate)), motion=motion)
    live = LiveAlignment(OnlineAligner(reference, variant=variant))
    every = max(1, round(float(again.rate) / RATE))
    found, last = [], 0
    for i, state in enumerate(played(live, again, every)):
        last = state.step.reference_frame if state.step else last
        found += [last] * min(every, again.frames - i * every)
    return np.array(found, dtype=np.float64)


def _takes(data: Sequence[Path], seed: int, limit: int) -> list[Take]:
    found = list(long_takes(formats.find_takes(list(data)), _LEAST_SECONDS))
    if not found:
        return []
    longest = max(range(len(found)), key=lambda i: found[i].duration)
    order = [int(i) for i in np.random.default_rng(seed).permutation(len(found)) if i != longest]
    return [found[i] for i in [longest, *order][:limit]]
