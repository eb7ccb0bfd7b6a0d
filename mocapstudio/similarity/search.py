"""Which search finds the neighbours: exact over everything, or an index first.

Indexed, the take itself is still searched exactly if it is short; of the rest only the candidates
of the index and what lies around them go through DTW, so that what is found is a true local
minimum with its true distance. What the index does not propose is missed.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Generator, Sequence

import numpy as np
from numpy.typing import NDArray

from mocapstudio.similarity import kernels, words
from mocapstudio.similarity.choices import AUTOMATIC, EXACT
from mocapstudio.similarity.index import STRIDE, WordIndex
from mocapstudio.similarity.parallel import for_blocks
from mocapstudio.similarity.texture import MotionTexture
from mocapstudio.similarity.words import Corpus, WordNeighbours, WordShape

F32 = NDArray[np.float32]
I64 = NDArray[np.int64]

WORTH_INDEXING = 100_000
"""Frames at 24 fps from which on the index pays, even for a single search: for 95 words 5.9 s of
processor time, of which 2.0 s are the index, instead of 7.3 s for the exact search."""

_REACH = STRIDE
_LOOKED_AROUND = 40
_KEPT = 2
_WORDS_A_STEP = 24
_kept: OrderedDict[object, WordIndex | None] = OrderedDict()
_lock = threading.Lock()


def searching(
    source: MotionTexture,
    corpus: Corpus,
    keep: int,
    trim: int,
    shape: WordShape,
    search: str = AUTOMATIC,
) -> Generator[float, None, WordNeighbours]:
    """Find the K nearest words of every source word, yielding the share done now and then.

    Parameters
    ----------
    source, corpus, keep, trim, shape
        As in `words.find_neighbours`.
    search
        One of `SEARCHES`; automatic is indexed where the corpus has `WORTH_INDEXING` frames.
    """
    if search == EXACT or (search == AUTOMATIC and corpus.frames < WORTH_INDEXING):
        return (yield from words.searching(source, corpus, keep, trim, shape))
    own = corpus.textures[0] is source
    parts = [corpus.textures[:1], corpus.textures[1:]] if own else [corpus.textures]
    starts = words.word_starts(len(source), shape)
    results, offset = [], 0
    for i, textures in enumerate(part for part in parts if part):
        yield i / len(parts)
        frames = sum(map(len, textures))
        if search == AUTOMATIC and frames < WORTH_INDEXING:
            some = words.find_neighbours(source, Corpus.of(textures), keep, trim, shape)
            results.append((some, offset))
        else:
            index = index_of(textures, shape)
            barred = own and i == 0
            found = []
            for first in range(0, len(starts), _WORDS_A_STEP):
                yield (i + first / len(starts)) / len(parts)
                block = starts[first : first + _WORDS_A_STEP]
                found.append(find_indexed(source, index, block, keep, trim, shape, own=barred))
            results.append((_joined(starts, found, keep), offset))
        offset += frames
    return _nearest(starts, results, keep)


def index_of(textures: Sequence[MotionTexture], shape: WordShape) -> WordIndex | None:
    """Index of some textures, kept for the next analysis by their content."""
    key = (shape, *(texture.digest for texture in textures))
    with _lock:
        if key not in _kept:
            _kept[key] = WordIndex.of(textures, shape)
            while len(_kept) > _KEPT:
                _kept.popitem(last=False)
        _kept.move_to_end(key)
        return _kept[key]


def find_indexed(
    source: MotionTexture,
    index: WordIndex | None,
    starts: I64,
    keep: int,
    trim: int,
    shape: WordShape,
    *,
    own: bool = False,
) -> WordNeighbours:
    """Find the K nearest of the words that an index proposes and of those around them.

    Parameters
    ----------
    source, keep, trim, shape
        As in `words.find_neighbours`.
    index
        Of what is searched; None where it holds no word.
    starts
        (W,) first frames of the source words.
    own
        Whether the index is of the source itself: neighbours nearer than half a source word are
        barred.
    """
    result = WordNeighbours.none(starts, keep)
    if index is None:
        return result

    def search(first: int, last: int) -> None:
        for w in range(first, last):
            word = int(starts[w])
            poses = source.quaternions[word : word + shape.source]
            barred = words.barred(word, shape) if own else np.zeros(2, dtype=np.int64)
            around = index.candidates(source.quaternions, word)
            values, _ = _warped(index, poses, around, trim, shape)
            best = np.argsort(values, kind="stable")[: _LOOKED_AROUND * keep]
            around = _around(index, around[best])
            while True:
                values, ends = _warped(index, poses, around, trim, shape)
                at = _minima(around, values, keep, barred)
                further = _further(index, around, at)
                if len(further) == 0:
                    break
                around = np.union1d(around, further)
            n = len(at)
            result.found[w, :n] = around[at]
            result.distances[w, :n] = values[at]
            result.spans[w, :n] = ends[:, at].T

    for_blocks(len(starts), search, at_least=4)
    return result


def _around(index: WordIndex, candidates: I64) -> I64:
    """Candidates and the target words up to `_REACH` frames from them, ascending."""
    wide = (candidates[:, None] + np.arange(-_REACH, _REACH + 1)).ravel()
    wide = np.unique(wide)
    low = np.searchsorted(index.bounds[:, 0], wide, side="right") - 1
    inside = (low >= 0) & (wide < index.bounds[np.maximum(low, 0), 1])
    return np.asarray(wide[inside])


def _warped(
    index: WordIndex, poses: F32, around: I64, trim: int, shape: WordShape
) -> tuple[F32, NDArray[np.int16]]:
    """DTW of the source word to the target words that start `around`: distances, path ends."""
    # Words that overlap share their frames: what lies between two runs is not gathered.
    cuts = np.flatnonzero(np.diff(around) > shape.target) + 1
    first, last = np.concatenate([[0], cuts]), np.concatenate([cuts, [len(around)]]) - 1
    runs = np.stack([around[first], around[last] + shape.target], axis=1)
    lengths = runs[:, 1] - runs[:, 0]
    planes = np.empty((poses.shape[1], 4, int(lengths.sum())), dtype=np.float32)
    kernels.gather(index.poses, runs, planes)
    distances = np.empty((shape.source, planes.shape[2]), dtype=np.float32)
    kernels.pose_distances(poses, planes, trim, distances)
    shift = np.concatenate([[0], np.cumsum(lengths)[:-1]]) - runs[:, 0]
    places = around + np.repeat(shift, last - first + 1)
    row = np.empty(len(around), dtype=np.float32)
    ends = np.empty((2, len(around)), dtype=np.int16)
    kernels.dtw_listed(distances, shape.target, places, row, ends)
    return row, ends


def _minima(around: I64, values: F32, keep: int, barred: I64) -> I64:
    """Positions in `around` of the smallest local minima of its runs without a gap."""
    breaks = np.concatenate([[0], np.flatnonzero(np.diff(around) > 1) + 1]).astype(np.int64)
    found = np.full(keep, -1, dtype=np.int64)
    near = np.searchsorted(around, barred).astype(np.int64)
    count = kernels.smallest_minima(values, breaks, keep, near, found)
    return found[:count]


def _further(index: WordIndex, around: I64, at: I64) -> I64:
    """Target words beyond the ends of runs where a minimum lies: it may go down further there."""
    here = around[at]
    take = np.searchsorted(index.bounds[:, 0], here, side="right") - 1
    missing = []
    for step in (-1, 1):
        beyond = here + step
        place = np.clip(np.searchsorted(around, beyond), 0, len(around) - 1)
        inside = (beyond >= index.bounds[take, 0]) & (beyond < index.bounds[take, 1])
        open_end = inside & (around[place] != beyond)
        for reach in range(1, _REACH + 2):
            wide = here + step * reach
            there = (wide >= index.bounds[take, 0]) & (wide < index.bounds[take, 1])
            missing.append(wide[open_end & there])
    return np.unique(np.concatenate(missing))


def _joined(starts: I64, parts: Sequence[WordNeighbours], keep: int) -> WordNeighbours:
    if not parts:
        return WordNeighbours.none(starts, keep)
    return WordNeighbours(
        starts,
        np.concatenate([part.found for part in parts]),
        np.concatenate([part.spans for part in parts]),
        np.concatenate([part.distances for part in parts]),
    )


def _nearest(starts: I64, parts: Sequence[tuple[WordNeighbours, int]], keep: int) -> WordNeighbours:
    """Merge what was found in several parts of a corpus, each with its first frame there."""
    found = np.concatenate(
        [np.where(part.found >= 0, part.found + offset, -1) for part, offset in parts], axis=1
    )
    spans = np.concatenate([part.spans for part, _ in parts], axis=1)
    distances = np.concatenate([part.distances for part, _ in parts], axis=1)
    order = np.argsort(distances, axis=1, kind="stable")[:, :keep]
    return WordNeighbours(
        starts,
        np.take_along_axis(found, order, axis=1),
        np.take_along_axis(spans, order[..., None], axis=1),
        np.take_along_axis(distances, order, axis=1),
    )
