"""What changed in a marker take against its source, measured against what was declared."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.markers import MarkerTake

# Metres: what turning there and back leaves.
_SAME = 1e-9


def marker_changes(
    take: MarkerTake, labels: tuple[str, ...], original: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """(F, M) samples of `take` that differ from what was read.

    Parameters
    ----------
    labels, original
        Labels and positions (F, M, 3) as they were read.

    Raises
    ------
    MocapError
        If markers or frames do not correspond, so that samples cannot be compared.
    """
    if take.labels != labels or take.positions.shape != original.shape:
        raise MocapError(
            f"{take.name} has other markers or frames than its source: it must be written anew"
        )
    gone, was_gone = take.missing, np.isnan(original).any(axis=2)
    apart = np.abs(take.positions - original).max(axis=2, initial=0.0)
    changed: NDArray[np.bool_] = (gone != was_gone) | (~gone & ~was_gone & ~(apart <= _SAME))
    return changed


def check_declared(
    take: MarkerTake, changed: NDArray[np.bool_], declared: Sequence[Declared]
) -> None:
    """See to it that nothing but what was declared has changed; a marker's row is its label.

    Raises
    ------
    MocapError
        If a row is not one of the take's, or a sample outside the declared ones changed.
    """
    allowed = np.zeros_like(changed)
    for one in declared:
        if one.row not in take.index:
            raise MocapError(f"declared row {one.row} is none of {take.name}'s")
        allowed[max(one.start, 0) : max(one.end, 0), take.index[one.row]] = True
    frames, markers = np.nonzero(changed & ~allowed)
    if len(frames):
        many = f" and {len(frames) - 1} more" if len(frames) > 1 else ""
        what = f"marker {take.labels[int(markers[0])]} at frame {int(frames[0])}{many}"
        raise MocapError(f"{take.name}: changed without being declared: {what}")
