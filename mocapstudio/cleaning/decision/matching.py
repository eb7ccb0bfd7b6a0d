"""Neighbours for the decision: rigid windows, matched every time without one limb.

An error does not choose its own neighbours, because its limb is left out of the search.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.decision import kernels
from mocapstudio.similarity.parallel import for_blocks
from mocapstudio.similarity.texture import MotionTexture

F32 = NDArray[np.float32]
I64 = NDArray[np.int64]
I32 = NDArray[np.int32]

KEEP, KEEP_OWN = 8, 4
HOP = 3
APART = 12
LEAST_FRAMES = 2 * kernels.HALF + 2


@dataclass(frozen=True, eq=False)
class Matches:
    """Neighbours of every centre frame, without one limb at a time.

    Parameters
    ----------
    planes
        (m, 4, T) the take itself, then its context.
    starts
        (B,) first frame of each of these.
    centres, centre_of
        (C,) source frames that were matched; (S,) which of them each source frame goes by.
    found, distance
        (C, L + 1, K) frames of the context, -1 where there are fewer, and their distances; the
        last of the middle axis leaves out no limb.
    own_found, own_distance
        The same in the take itself.
    """

    planes: F32
    starts: I64
    centres: I64
    centre_of: I64
    found: I32
    distance: F32
    own_found: I32
    own_distance: F32


def match(
    texture: MotionTexture,
    others: Sequence[MotionTexture],
    limb: I64,
    barred: Sequence[int] = (),
) -> Matches:
    """Match all windows of a take against itself and others.

    Parameters
    ----------
    texture
        S frames, at least LEAST_FRAMES.
    others
        The context without the take itself.
    limb
        (m,) which limb each joint belongs to.
    barred
        Indices into `others` that must not be used.
    """
    half, frames = kernels.HALF, len(texture)
    parts = [texture.planes, *(one.planes for one in others)]
    planes = np.ascontiguousarray(np.concatenate(parts, axis=2), dtype=np.float32)
    lengths = [part.shape[2] for part in parts]
    starts = np.concatenate([[0], np.cumsum(lengths)[:-1]]).astype(np.int64)
    usable = np.zeros(planes.shape[2], dtype=np.uint8)
    for i, (start, length) in enumerate(zip(starts, lengths, strict=True)):
        if i - 1 not in barred:
            usable[start + half : start + max(length - half, half)] = 1
    centres = np.unique(np.append(np.arange(half, frames - half, HOP), frames - half - 1))
    shape = (len(centres), int(limb.max()) + 2)
    result = Matches(
        planes,
        starts,
        centres.astype(np.int64),
        np.abs(np.arange(frames)[:, None] - centres[None]).argmin(axis=1).astype(np.int64),
        np.full((*shape, KEEP), -1, dtype=np.int32),
        np.full((*shape, KEEP), np.nan, dtype=np.float32),
        np.full((*shape, KEEP_OWN), -1, dtype=np.int32),
        np.full((*shape, KEEP_OWN), np.nan, dtype=np.float32),
    )
    own = np.array([0, frames, APART], dtype=np.int64)

    def work(first: int, last: int) -> None:
        part = slice(first, last)
        kernels.match_windows(
            texture.quaternions, result.centres[part], planes, limb, shape[1], usable, own,
            result.found[part], result.distance[part],
            result.own_found[part], result.own_distance[part],
        )  # fmt: skip

    for_blocks(len(centres), work, at_least=24)
    return result


def nearest_takes(matches: Matches) -> I64:
    """Indices (N,) of the N takes of the context, those that gave most neighbours first."""
    frames = matches.found[matches.found >= 0]
    which = np.searchsorted(matches.starts, frames, side="right") - 2
    return np.argsort(-np.bincount(which[which >= 0], minlength=len(matches.starts) - 1))
