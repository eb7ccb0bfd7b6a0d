"""The mean-motion-texture and the departure from it (paper 1, section 3.4)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.similarity.texture import MotionTexture
from mocapstudio.similarity.words import Corpus, WordNeighbours, WordShape, warped_word

F32 = NDArray[np.float32]


def mean_word(corpus: Corpus, starts: NDArray[np.int64], spans: NDArray[np.int16], to: int) -> F32:
    """Rotation mean of one word's warped neighbours: (to, m, 4), signs aligned to the nearest."""
    warped = np.stack(
        [warped_word(corpus, int(s), int(n), to) for s, n in zip(starts, spans, strict=True)]
    )
    same = np.sum(warped * warped[:1], axis=-1, keepdims=True) >= 0
    total = np.sum(np.where(same, warped, -warped), axis=0)
    return np.asarray(total / np.linalg.norm(total, axis=-1, keepdims=True), dtype=np.float32)


def mean_texture(
    source: MotionTexture, corpus: Corpus, neighbours: WordNeighbours, shape: WordShape
) -> F32:
    """Average all mean-words that cover a frame.

    Returns
    -------
    (T, m, 4) float32 unit quaternions; frames that no word with a neighbour covers are NaN.
    """
    total = np.zeros(source.quaternions.shape, dtype=np.float64)
    for word, found, spans in zip(
        neighbours.words, neighbours.found, neighbours.spans, strict=True
    ):
        there = found >= 0
        if not np.any(there):
            continue
        mean = mean_word(corpus, found[there], spans[there, 1], shape.source)
        frames = slice(int(word), int(word) + shape.source)
        own = source.quaternions[frames]
        same = np.sum(mean * own, axis=-1, keepdims=True) >= 0
        total[frames] += np.where(same, mean, -mean)
    norm = np.linalg.norm(total, axis=-1, keepdims=True)
    with np.errstate(invalid="ignore"):
        return np.asarray(np.where(norm > 1e-9, total / norm, np.nan), dtype=np.float32)


def departure(source: MotionTexture, mean: F32) -> F32:
    """Geodesic angle between texture and mean texture, (T, m) float32 radians; 0 where no mean."""
    same = np.sum(source.quaternions * mean, axis=-1, keepdims=True) >= 0
    # By the chord: the arc cosine of a float32 product cannot tell 0.05 degrees from none.
    chord = np.linalg.norm(source.quaternions - np.where(same, mean, -mean), axis=-1)
    angle = 4.0 * np.arcsin(np.clip(0.5 * chord, 0.0, 1.0))
    return np.asarray(np.nan_to_num(angle), dtype=np.float32)


def paper_map(departures: F32) -> F32:
    """Turn departures into the paper's literal map: ``1 - exp(-(M / row mean)^2)``, (T, m)."""
    mean = departures.mean(axis=0, keepdims=True)
    scaled = departures / np.where(mean > 0, mean, 1.0)
    return np.asarray(1.0 - np.exp(-(scaled**2)), dtype=np.float32)
