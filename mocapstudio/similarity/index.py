"""The index of target words: a tree over the principal components of a few of their poses.

The first stage of the neighbour search in a large context (paper 1 asks for such a bridge to the
searches of paper 2). It proposes candidates; whether they are neighbours is decided by DTW.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocapstudio.similarity.texture import MotionTexture
from mocapstudio.similarity.words import WordShape

F32 = NDArray[np.float32]
I64 = NDArray[np.int64]

STRIDE = 3
"""Every third target word is indexed: the distance is smooth over some frames."""

PACES = (1.0, 0.35, 0.5, 0.7, 1.4, 2.0)
"""A warping path may hold one word up: the source is looked up as if it were slower or faster."""

_COUNTS = (2048, 2560, 1280, 1280, 1280, 1536)
_SLACK = 0.3

_SAMPLES = 3
_DIMENSIONS = 20
_FITTED = 20_000
_BLOCK = 65_536


@dataclass(frozen=True, eq=False)
class WordFeatures:
    """A linear map from the sampled poses of a word to a few numbers, fitted to a corpus.

    Parameters
    ----------
    offsets
        (s,) sampled frames of a word.
    reference
        (m, 4) mean rotation of each joint; of the two quaternions of a rotation the one on its
        side is used.
    mean
        (s * m * 4,) mean of the sampled words.
    axes
        (s * m * 4, d) their principal components.
    """

    offsets: I64
    reference: F32
    mean: F32
    axes: F32

    @staticmethod
    def fitted(poses: F32, starts: I64, shape: WordShape) -> WordFeatures:
        """Fit to words of a corpus.

        Parameters
        ----------
        poses
            (T, m, 4) unit quaternions.
        starts
            (P,) first frames of the words.
        shape
            Lengths of the words; the samples lie within the source word's.
        """
        offsets = np.round(np.linspace(0, shape.source - 1, _SAMPLES)).astype(np.int64)
        some = starts[:: max(len(starts) // _FITTED, 1)]
        here = poses[some]
        spread = np.einsum("tmc,tmd->mcd", here, here, optimize=True)
        reference = np.ascontiguousarray(np.linalg.eigh(spread)[1][:, :, -1], dtype=np.float32)
        rows = _rows(poses, some, offsets, reference)
        mean = rows.mean(axis=0)
        rows -= mean
        axes = np.linalg.eigh(rows.T @ rows)[1][:, ::-1][:, :_DIMENSIONS]
        axes = np.ascontiguousarray(axes, dtype=np.float32)
        return WordFeatures(offsets, reference, mean.astype(np.float32), axes)

    def of(self, poses: F32, starts: I64, pace: float = 1.0) -> F32:
        """(P, d) features of the words that start at `starts` of (T, m, 4) `poses`.

        At another pace than 1 the samples lie that many times as far apart.
        """
        offsets = np.round(self.offsets * pace).astype(np.int64)
        found = np.empty((len(starts), self.axes.shape[1]), dtype=np.float32)
        for first in range(0, len(starts), _BLOCK):
            some = starts[first : first + _BLOCK]
            rows = _rows(poses, some, offsets, self.reference)
            found[first : first + _BLOCK] = (rows - self.mean) @ self.axes
        return found


def _rows(poses: F32, starts: I64, offsets: I64, reference: F32) -> F32:
    chosen = poses[np.minimum(starts[:, None] + offsets, len(poses) - 1)]
    side = np.einsum("tsmc,mc->tsm", chosen, reference)
    chosen *= np.where(side < 0, np.float32(-1), np.float32(1))[..., None]
    return np.asarray(chosen.reshape(len(starts), -1))


@dataclass(frozen=True, eq=False)
class WordIndex:
    """What is kept of a corpus between searches.

    Parameters
    ----------
    poses
        (T, m, 4) float32, all textures one after the other.
    bounds
        (B, 2) for each texture its first target word and the one behind its last.
    starts
        (P,) first frames of the indexed words.
    features
        How a word becomes a point.
    tree
        Tree of the indexed words' points.
    """

    poses: F32
    bounds: I64
    starts: I64
    features: WordFeatures
    tree: Any

    @staticmethod
    def of(textures: Sequence[MotionTexture], shape: WordShape) -> WordIndex | None:
        """Index the words of textures; None where none is as long as a target word."""
        from scipy.spatial import cKDTree

        poses = np.concatenate([texture.quaternions for texture in textures])
        ends = np.cumsum([len(texture) for texture in textures])
        firsts = ends - [len(texture) for texture in textures]
        bounds = np.stack([firsts, ends - shape.target + 1], axis=1).astype(np.int64)
        bounds = bounds[bounds[:, 1] > bounds[:, 0]]
        if len(bounds) == 0:
            return None
        starts = np.concatenate([np.arange(low, high, STRIDE) for low, high in bounds])
        features = WordFeatures.fitted(poses, starts, shape)
        points = features.of(poses, starts)
        tree = cKDTree(points, balanced_tree=False, compact_nodes=False)
        return WordIndex(poses, bounds, starts, features, tree)

    def candidates(self, source: F32, word: int) -> I64:
        """Indexed words that resemble a word of a source, at one of several paces.

        Parameters
        ----------
        source
            (S, m, 4) unit quaternions.
        word
            First frame of the word.

        Returns
        -------
        (C,) first frames, ascending, each once.
        """
        points = np.concatenate(
            [self.features.of(source, np.array([word]), pace) for pace in PACES]
        )
        found = [
            self.tree.query(point, k=min(count, len(self.starts)), eps=_SLACK)[1]
            for point, count in zip(points, _COUNTS, strict=True)
        ]
        return np.asarray(self.starts[np.unique(np.concatenate([np.atleast_1d(f) for f in found]))])
