"""The two root rows: where the body is and where it faces.

Both are removed before words are compared, so they get residuals of their own: the height of the
hips against that of the neighbours, and the heading against its own median over a few seconds,
which a flip does not move and a real turn passes through.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.facing import split_heading
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import TEXTURE_RATE, TRAVEL, MotionTexture
from mocapstudio.similarity.words import Corpus, WordNeighbours, WordShape, resampling_matrix

F32 = NDArray[np.float32]

_HEADING_WINDOW_SECONDS = 2.4


def height_departure(
    texture: MotionTexture, corpus: Corpus, neighbours: WordNeighbours, shape: WordShape
) -> F32:
    """Centimetres by which the hips' height departs from the neighbours' mean height, (T,).

    Another floor or body height is no error: of the departures from the take itself, and of those
    from its context, their own median is taken off.
    """
    height = TRAVEL.index("height")
    heights = np.concatenate([one.travel[:, height] for one in corpus.textures])
    total, count = np.zeros((2, len(texture))), np.zeros((2, len(texture)))
    for word, found, spans in zip(
        neighbours.words, neighbours.found, neighbours.spans[..., 1], strict=True
    ):
        frames = slice(int(word), int(word) + shape.source)
        for start, span in zip(found[found >= 0], spans[found >= 0], strict=True):
            weights = resampling_matrix(int(span), shape.source)
            other = int(start >= len(texture))
            away = texture.travel[frames, height] - weights @ heights[start : start + span]
            total[other, frames] += away
            count[other, frames] += 1
    for away, among in zip(total, count, strict=True):
        there = among > 0
        away -= among * (np.median(away[there] / among[there]) if there.any() else 0.0)
    mean = total.sum(axis=0) / np.maximum(count.sum(axis=0), 1)
    return np.asarray(100.0 * np.abs(mean), dtype=np.float32)


def heading_departure(take: Take) -> F32:
    """Degrees by which the heading leaves its own running median, at the take's own rate, (F,).

    Frames outside the trimmed span are 0.
    """
    first, last = take.span
    heading, _ = split_heading(take, first, last)
    step = max(1, round(float(take.rate) / TEXTURE_RATE))
    sampled = heading[::step]
    half = min(round(_HEADING_WINDOW_SECONDS * float(take.rate) / step / 2), len(sampled) - 1)
    padded = np.pad(sampled, half, mode="edge")
    median = np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * half + 1), axis=1)
    smooth = np.interp(np.arange(last - first), np.arange(len(sampled)) * step, median)
    away = np.zeros(take.frames, dtype=np.float32)
    away[first:last] = np.rad2deg(np.abs(heading - smooth))
    return away
