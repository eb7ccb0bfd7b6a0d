"""Which stretch of the reference stands below which stretch of the source, and which lines join.

No Qt.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison.model import Comparison

_STEPS = (1, 2, 5, 10, 20, 25, 50, 100, 200, 250, 500, 1000, 2000, 2500, 5000, 10000)


@dataclass(frozen=True)
class Stretch:
    """Visible frames of the reference: left and right edge, not rounded."""

    start: float
    end: float

    @property
    def length(self) -> float:
        """Frames from edge to edge."""
        return self.end - self.start


def frames_wide(comparison: Comparison, true_speed: bool) -> int:
    """Source frames that the whole picture is wide.

    At true speed the picture is as long as the longer of the two; otherwise both are stretched to
    the source's length.
    """
    source = len(comparison.source_poses)
    if not true_speed:
        return source
    scale = float(comparison.reference_rate / comparison.source_rate)
    return max(source, int(np.ceil(len(comparison.reference_poses) / scale)))


def reference_stretch(
    comparison: Comparison, start: float, end: float, true_speed: bool
) -> Stretch:
    """Reference frames that stand below the source frames from `start` to `end`.

    Seen whole, both takes lie as they are: at true speed from a common beginning, else stretched
    to one length. The nearer one looks, the more the matched frames come to lie below each other,
    so that the lines that join them stay in sight.
    """
    frames = len(comparison.source_poses)
    if true_speed:
        scale = float(comparison.reference_rate / comparison.source_rate)
    else:
        scale = len(comparison.reference_poses) / frames
    middle = 0.5 * (start + end)
    lying = (middle + 0.5) * scale - 0.5
    first = min(max(int(start), 0), frames - 1)
    matched = float(comparison.warp[first : max(int(end) + 1, first + 1)].mean())
    share = min((end - start) / frames_wide(comparison, true_speed), 1.0) ** 2
    centre = share * lying + (1.0 - share) * matched
    half = 0.5 * (end - start) * scale
    return Stretch(centre - half, centre + half)


def timing_lines(
    comparison: Comparison, start: float, end: float, width: float, apart: float = 9.0
) -> NDArray[np.int64]:
    """(L, 2) pairs of source and reference frames to be joined by a line.

    Parameters
    ----------
    start, end
        Visible source frames.
    width
        Pixels they take.
    apart
        Pixels between lines at least. Where there is room for it every step of the warping path
        is drawn, several to a frame where one performer waits.
    """
    per_frame = width / max(end - start, 1e-9)
    step = next((s for s in _STEPS if s * per_frame >= apart), _STEPS[-1])
    reference, source = comparison.path[:, 0], comparison.path[:, 1]
    seen = (source >= start - step) & (source <= end + step)
    if step == 1:
        return np.stack([source[seen], reference[seen]], axis=1).astype(np.int64)
    frames = np.arange(len(comparison.warp))[::step]
    frames = frames[(frames >= start - step) & (frames <= end + step)]
    return np.stack([frames, np.rint(comparison.warp[frames]).astype(np.int64)], axis=1)
