"""Motion-words and the search for their neighbours (paper 1, sections 3.2 and 3.3)."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from mocapstudio.similarity import kernels
from mocapstudio.similarity.parallel import for_blocks
from mocapstudio.similarity.texture import MotionTexture

F32 = NDArray[np.float32]
I64 = NDArray[np.int64]

_FAR = np.float32(1e30)
# About a quarter of a second of search on two cores.
_TARGETS_A_STEP, _LEAST_WORDS = 2_000_000, 12


@dataclass(frozen=True)
class WordShape:
    """Lengths in texture frames: source word, hop between source words, target word."""

    source: int = 15
    hop: int = 5
    target: int = 20


@dataclass(frozen=True, eq=False)
class Corpus:
    """Several textures laid end to end; words never straddle two of them.

    Parameters
    ----------
    textures
        The first is the analysed take itself if it is searched at all.
    planes
        (m, 4, T) float32, all textures one after the other.
    starts
        (B,) first frame of each texture in `planes`.
    """

    textures: tuple[MotionTexture, ...]
    planes: F32
    starts: I64

    @staticmethod
    def of(textures: Sequence[MotionTexture]) -> Corpus:
        """Lay textures with the same joints end to end."""
        lengths = [len(texture) for texture in textures]
        planes = np.concatenate([texture.planes for texture in textures], axis=2)
        starts = np.concatenate([[0], np.cumsum(lengths)[:-1]]).astype(np.int64)
        return Corpus(tuple(textures), np.ascontiguousarray(planes), starts)

    @property
    def frames(self) -> int:
        """Total number of texture frames."""
        return int(self.planes.shape[2])

    def locate(self, frame: int) -> tuple[int, int]:
        """Which texture a frame of the corpus lies in, and at which of its frames."""
        which = int(np.searchsorted(self.starts, frame, side="right")) - 1
        return which, int(frame - self.starts[which])


@dataclass(frozen=True, eq=False)
class WordNeighbours:
    """The K nearest words of every source word.

    Parameters
    ----------
    words
        (W,) first texture frame of each source word.
    found
        (W, K) first corpus frame of each neighbour, -1 where fewer were found.
    spans
        (W, K, 2) how many source and target frames its warping path covers.
    distances
        (W, K) mean squared pose distance a matched pair, rad^2 of half angles.
    """

    words: I64
    found: I64
    spans: NDArray[np.int16]
    distances: F32

    @staticmethod
    def none(words: I64, keep: int) -> WordNeighbours:
        """No neighbours yet of source words that begin at `words` (W,), with room for `keep`."""
        return WordNeighbours(
            words,
            np.full((len(words), keep), -1, dtype=np.int64),
            np.zeros((len(words), keep, 2), dtype=np.int16),
            np.full((len(words), keep), np.inf, dtype=np.float32),
        )


def word_starts(frames: int, shape: WordShape) -> I64:
    """(W,) first frames of the source words: every hop, and one that reaches the last frame."""
    if frames < shape.source:
        return np.zeros(0, dtype=np.int64)
    starts = list(range(0, frames - shape.source + 1, shape.hop))
    if starts[-1] != frames - shape.source:
        starts.append(frames - shape.source)
    return np.array(starts, dtype=np.int64)


def trim_count(joints: int, whole_body: bool) -> int:
    """How many joints a pose distance leaves out: three of 24 for the body, one for a group."""
    return -(-joints // 8) if whole_body else min(1, joints - 1)


def find_neighbours(
    source: MotionTexture,
    corpus: Corpus,
    keep: int,
    trim: int,
    shape: WordShape = WordShape(),
    joints: I64 | None = None,
    words: I64 | None = None,
) -> WordNeighbours:
    """Find the K nearest words of every source word by exact constrained DTW.

    Parameters
    ----------
    source
        The analysed take's texture. Where it is `corpus.textures[0]`, neighbours nearer than
        half a source word are barred.
    corpus
        What is searched.
    keep
        K.
    trim
        How many joints each pose distance leaves out.
    joints
        Indices of the joint group, or None for all.
    words
        First frames of the source words, or None for all of them.
    """
    words = word_starts(len(source), shape) if words is None else words
    count = max(corpus.frames - shape.target + 1, 0)
    result = WordNeighbours.none(words, keep)
    found, spans, distances = result.found, result.spans, result.distances
    if count == 0 or len(words) == 0:
        return result
    quaternions, planes = source.quaternions, corpus.planes
    if joints is not None:
        quaternions = np.ascontiguousarray(quaternions[:, joints])
        planes = np.ascontiguousarray(planes[joints])
    straddling = _straddling(corpus, count, shape)
    own = corpus.textures[0] is source

    def search(first: int, last: int) -> None:
        low, high = int(words[first]), int(words[last - 1]) + shape.source
        poses = np.empty((high - low, corpus.frames), dtype=np.float32)
        kernels.pose_distances(quaternions[low:high], planes, trim, poses)
        row = np.empty(count, dtype=np.float32)
        ends = np.empty((2, count), dtype=np.int16)
        for w in range(first, last):
            at = int(words[w])
            kernels.dtw_word(poses[at - low : at - low + shape.source], shape.target, row, ends)
            row[straddling] = _FAR
            near = barred(at, shape) if own else np.zeros(2, dtype=np.int64)
            n = kernels.smallest_minima(row, corpus.starts, keep, near, found[w])
            distances[w, :n] = row[found[w, :n]]
            spans[w, :n] = ends[:, found[w, :n]].T

    # Small blocks keep the pose distances of one block within a few megabytes.
    for_blocks(len(words), search, at_least=12)
    return result


def searching(
    source: MotionTexture, corpus: Corpus, keep: int, trim: int, shape: WordShape = WordShape()
) -> Generator[float, None, WordNeighbours]:
    """Do what `find_neighbours` does for all words, yielding the share done a few times a second.

    Parameters
    ----------
    source, corpus, keep, trim, shape
        As in `find_neighbours`.
    """
    words = word_starts(len(source), shape)
    size = int(np.clip(_TARGETS_A_STEP // max(corpus.frames, 1), _LEAST_WORDS, len(words) or 1))
    parts = []
    for first in range(0, len(words), size):
        yield first / len(words)
        some = words[first : first + size]
        parts.append(find_neighbours(source, corpus, keep, trim, shape, words=some))
    if not parts:
        return find_neighbours(source, corpus, keep, trim, shape, words=words)
    return WordNeighbours(
        words,
        np.concatenate([part.found for part in parts]),
        np.concatenate([part.spans for part in parts]),
        np.concatenate([part.distances for part in parts]),
    )


def _straddling(corpus: Corpus, count: int, shape: WordShape) -> NDArray[np.bool_]:
    bad = np.zeros(count, dtype=bool)
    for start in corpus.starts[1:]:
        bad[max(int(start) - shape.target + 1, 0) : int(start)] = True
    return bad


def barred(word: int, shape: WordShape) -> I64:
    """(2,) half-open target words whose centre is within N/2 frames of the source word's centre."""
    centre = word + shape.source // 2 - shape.target // 2
    return np.array([centre - shape.source // 2, centre + shape.source // 2 + 1], dtype=np.int64)


@lru_cache(maxsize=256)
def resampling_matrix(length: int, to: int) -> F32:
    """(to, length) weights that resample a span, ends on ends, with a polyphase filter.

    A windowed sinc evaluated at each output's own phase; samples beyond an end repeat the end.
    """
    if length == 1:
        return np.ones((to, 1), dtype=np.float32)
    at = np.linspace(0.0, length - 1.0, to)
    half_width = 3
    cutoff = min(1.0, (to - 1) / (length - 1)) if to > 1 else 1.0
    reach = int(np.ceil(half_width / cutoff))
    weights = np.zeros((to, length))
    for i, centre in enumerate(at):
        for tap in range(int(np.floor(centre)) - reach, int(np.ceil(centre)) + reach + 1):
            offset = (tap - centre) * cutoff
            if abs(offset) < half_width:
                window = np.cos(0.5 * np.pi * offset / half_width) ** 2
                weights[i, min(max(tap, 0), length - 1)] += np.sinc(offset) * window
    weights /= weights.sum(axis=1, keepdims=True)
    return weights.astype(np.float32)


def warped_word(corpus: Corpus, start: int, span: int, to: int) -> F32:
    """(to, m, 4) unit quaternions: the matched span of a target word, resampled to `to` frames."""
    # Signs run on in a texture; to align them anew would break a turn of more than half a circle.
    motion = corpus.planes[:, :, start : start + span]
    resampled = np.einsum("nl,mcl->nmc", resampling_matrix(span, to), motion)
    norm = np.linalg.norm(resampled, axis=-1, keepdims=True)
    return np.asarray(resampled / np.maximum(norm, 1e-12), dtype=np.float32)
