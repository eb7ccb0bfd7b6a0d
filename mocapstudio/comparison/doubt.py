"""How far an alignment can be trusted, in figures and in words."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mocapstudio.comparison.pose_alignment import PoseAlignment
from mocapstudio.similarity.alignment.costs import Costs, KnownCosts
from mocapstudio.similarity.alignment.dtw import Path, align

_COARSE = 300
"""Frames at most to which both are thinned out for the test."""

_ORDERS = (3, 4, 5, 6, 7, 8, 9)
"""Into how many parts the source is cut for each wrong order."""

_LIKELY_WRONG = 0.93
_HARDLY_NEARER = 0.85
_TEMPO = 3.0
_LONG_SECONDS = 1.0
_LONG_SHARE = 0.05
_AT_THE_EDGE = 0.1


@dataclass(frozen=True)
class Doubt:
    """What speaks against an alignment.

    Parameters
    ----------
    disorder
        Mean cost of the path over that with the source's parts in wrong orders: near 0 where only
        the right order fits, 1 where any does.
    nearness
        Mean cost of the path over that of any pair of frames.
    warnings
        What makes it doubtful, as phrases; empty where nothing does.
    """

    disorder: float
    nearness: float
    warnings: tuple[str, ...]


def doubt(
    aligned: PoseAlignment,
    reference_seconds: float,
    source_seconds: float,
    band: int | None = None,
) -> Doubt:
    """Test an alignment against wrong ones, and look at its path.

    A path can always be found, between two katas as between two performances of one. But of two
    performances only the right order fits: with the source's parts exchanged, or played
    backwards, the cost must rise.
    """
    disorder, nearness = _against_chance(aligned.costs)
    path = aligned.alignment.path
    shape = aligned.costs.shape
    seconds = reference_seconds / max(shape[0] - 1, 1), source_seconds / max(shape[1] - 1, 1)
    warnings = (
        *_chance_warnings(disorder, nearness),
        *_tempo_warnings(path, seconds),
        *_run_warnings(path, shape, seconds),
        *_band_warnings(path, shape, band),
    )
    return Doubt(disorder, nearness, warnings)


def _against_chance(costs: Costs) -> tuple[float, float]:
    rows, columns = (np.arange(0, n, max(1, -(-n // _COARSE))) for n in costs.shape)
    matrix = np.empty((len(rows), len(columns)), np.float32)
    costs.part(rows, columns).fill(0, len(matrix), matrix)
    thin = KnownCosts(matrix)
    anywhere = float(matrix.mean())
    found = align(thin).mean_cost
    if anywhere < 1e-6:
        return 1.0, 1.0
    wrong = [
        align(thin.part(slice(None), order)).mean_cost for order in _wrong_orders(len(columns))
    ]
    typical = float(np.median(wrong))
    return (found / typical if typical > 1e-9 else 1.0), found / anywhere


def _wrong_orders(frames: int) -> list[np.ndarray[tuple[int], np.dtype[np.intp]]]:
    """Return the frames backwards, and in parts exchanged; always the same orders."""
    rng = np.random.default_rng(0)
    orders = [np.arange(frames)[::-1]]
    for count in _ORDERS:
        parts = np.array_split(np.arange(frames), count)
        order = rng.permutation(count)
        while (order == np.arange(count)).any():
            order = rng.permutation(count)
        orders.append(np.concatenate([parts[i] for i in order]))
    return orders


def _chance_warnings(disorder: float, nearness: float) -> list[str]:
    if nearness > _HARDLY_NEARER:
        return [
            f"doubtful: matched poses are {nearness:.0%} as far apart as any two;"
            " these may be different movements"
        ]
    if disorder > _LIKELY_WRONG:
        return [
            f"doubtful: with its parts in another order the source fits as well ({disorder:.0%} of"
            " that cost); the movement repeats itself, or is another"
        ]
    return []


def _tempo_warnings(path: Path, seconds: tuple[float, float]) -> list[str]:
    """Compare how long what answers to each other lasts; open ends may leave the rest out."""
    lasting = (path[-1] - path[0]) * np.array(seconds)
    ratio = float(max(lasting[1], seconds[1]) / max(lasting[0], seconds[0]))
    if ratio > _TEMPO:
        return [f"the source lasts {ratio:.1f} times as long as the reference"]
    if ratio < 1 / _TEMPO:
        return [f"the reference lasts {1 / ratio:.1f} times as long as the source"]
    return []


def _band_warnings(path: Path, shape: tuple[int, int], band: int | None) -> list[str]:
    """Say where a band of so many source frames kept the path from where it would have gone."""
    if band is None:
        return []
    line = path[:, 0] * ((shape[1] - 1) / max(shape[0] - 1, 1))
    share = float(np.mean(np.abs(path[:, 1] - line) > band - 1))
    if share <= _AT_THE_EDGE:
        return []
    return [f"doubtful: the path keeps to the edge of the band for {share:.0%} of its length"]


def _run_warnings(path: Path, shape: tuple[int, int], seconds: tuple[float, float]) -> list[str]:
    """Name stretches of one that answer to a single frame of the other."""
    said = []
    sides = ("reference", "source")
    for still, moving in ((0, 1), (1, 0)):
        count = np.bincount(path[:, still], minlength=shape[still])
        least = max(_LONG_SECONDS, _LONG_SHARE * shape[moving] * seconds[moving])
        for frame in np.flatnonzero(count * seconds[moving] > least):
            lasts, at = count[frame] * seconds[moving], frame * seconds[still]
            place = _place(int(frame), shape[still], float(at))
            said.append(
                f"{lasts:.1f} s of the {sides[moving]} answer to {place} of the {sides[still]}"
            )
    return said


def _place(frame: int, frames: int, seconds: float) -> str:
    if frame == 0:
        return "the first frame"
    return "the last frame" if frame == frames - 1 else f"one frame, at {seconds:.1f} s,"
