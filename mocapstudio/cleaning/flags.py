"""From the digression map to flags: spans above the threshold, scored, named and joined."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.edges import refined
from mocapstudio.cleaning.kinds import likely_kind
from mocapstudio.cleaning.model import DigressionMap, Flag, Kind
from mocapstudio.cleaning.own_rate import OwnRate
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

_BRIDGE_SECONDS = 0.125
_SWAPPED = 2
_BENT = 3
_ALIKE = 0.5


def find_flags(
    take: Take, digression: DigressionMap, own_rate: OwnRate, threshold: float
) -> tuple[Flag, ...]:
    """Spans of the map above `threshold`, worst first.

    Spans of one row that are nearer than 1/8 s are one flag. Flags of one limb that overlap in
    time name each other in `joints`; each keeps its own span.
    """
    bridge = max(1, round(_BRIDGE_SECONDS * float(take.rate)))
    flags = []
    for column, row in enumerate(digression.rows):
        values = digression.values[:, column]
        for start, end in _spans(take, digression, column, threshold, bridge):
            peak_frame = start + int(np.argmax(values[start:end]))
            kind = likely_kind(take, digression, own_rate, column, start, end)
            peak = float(values[peak_frame])
            score = score_of(values[start:end], threshold)
            flags.append(
                Flag(f"{row}@{start}", row, (row,), start, end, peak, peak_frame, score, kind)
            )
    return tuple(sorted(_joined(take, flags), key=lambda f: (-f.score, f.start, f.joint)))


def _spans(
    take: Take, digression: DigressionMap, column: int, threshold: float, bridge: int
) -> list[tuple[int, int]]:
    """Spans of one row, their edges refined at the take's own rate where that was measured."""
    values = digression.values[:, column]
    spans = spans_above(values, threshold, bridge)
    if digression.fine is None or column >= digression.fine.shape[1]:
        return spans
    fine, rate = digression.fine[:, column], float(take.rate)
    # Where the map is 0 nothing is looked at: outside the trim, and where it was ruled out.
    closed = np.flatnonzero(np.concatenate([[True], values == 0, [True]])) - 1
    found = []
    for i, (start, end) in enumerate(spans):
        low = int(closed[np.searchsorted(closed, start) - 1]) + 1
        high = int(closed[np.searchsorted(closed, end)])
        if i > 0:
            low = max(low, (spans[i - 1][1] + start + 1) // 2)
        if i + 1 < len(spans):
            high = min(high, (end + spans[i + 1][0]) // 2)
        found.append(refined(fine, start, end, rate, (low, high)))
    return found


def score_of(values: NDArray[np.float32], threshold: float) -> float:
    """Score of a flagged span, 0..1, of the map's values (n,): its peak, and how high it stays."""
    above = values[values > threshold]
    return float(0.7 * values.max() + 0.3 * above.mean()) if len(above) else float(values.max())


def spans_above(
    values: NDArray[np.float32], threshold: float, bridge: int
) -> list[tuple[int, int]]:
    """Half-open spans where `values` exceed `threshold`, gaps of up to `bridge` frames closed.

    A gap that holds a 0 stays open: there somebody called the row normal, or protected it.

    Parameters
    ----------
    values
        (F,) one row of the map, 0..1.
    threshold
        What must be exceeded.
    bridge
        Frames.
    """
    above = np.concatenate([[False], values > threshold, [False]])
    edges = np.flatnonzero(above[1:] != above[:-1])
    spans: list[tuple[int, int]] = []
    for start, end in zip(edges[::2], edges[1::2], strict=True):
        near = bool(spans) and start - spans[-1][1] <= bridge
        if near and np.all(values[spans[-1][1] : start] > 0.0):
            spans[-1] = (spans[-1][0], int(end))
        else:
            spans.append((int(start), int(end)))
    return spans


def _joined(take: Take, flags: list[Flag]) -> Iterable[Flag]:
    """Tell flags of one limb, and of two sides exchanged, of each other."""
    parts, index, names = topology(take.skeleton), take.skeleton.index, take.skeleton.names
    limbs = {f.joint: parts.limb_of(index[f.joint]).name for f in flags if f.joint in index}
    for flag in flags:
        if flag.joint in ROOT_ROWS:
            yield flag
            continue
        mates = {
            other.joint
            for other in flags
            if limbs.get(other.joint) == limbs[flag.joint] and other.overlaps(flag.start, flag.end)
        }
        mirrored = {names[parts.mirror[index[mate]]] for mate in mates} - mates
        opposite = {o.joint for o in flags if o.joint in mirrored and _alike(o, flag)}
        kind = flag.kind
        if min(len(mates), len(opposite)) >= _SWAPPED:
            kind, mates = Kind.SWAP, mates | opposite
        elif len(mates) >= _BENT and kind in (Kind.OFFSET, Kind.SPIKE, Kind.DRIFT):
            kind = Kind.LIMB
        joints = tuple(sorted(mates, key=lambda name: index[name]))
        yield replace(flag, joints=joints, kind=kind)


def _alike(one: Flag, other: Flag) -> bool:
    """Tell whether two flags share most of their frames."""
    shared = min(one.end, other.end) - max(one.start, other.start)
    return shared > _ALIKE * (max(one.end, other.end) - min(one.start, other.start))
