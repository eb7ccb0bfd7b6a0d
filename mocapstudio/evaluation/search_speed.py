"""How fast the neighbour search is in a large context, and what the index misses."""

from __future__ import annotations

import math
from collections.abc import Generator, Sequence
from pathlib import Path

import numpy as np

from mocapstudio.evaluation.corpora import available, entries, read_some
from mocapstudio.evaluation.large_context import large_context
from mocapstudio.evaluation.speed_benchmark import SpeedRow, best_of, lasting
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.progress import Progress
from mocapstudio.similarity.index import WordIndex
from mocapstudio.similarity.search import find_indexed, index_of
from mocapstudio.similarity.texture import MotionTexture, comparable_joints, motion_texture
from mocapstudio.similarity.words import (
    Corpus,
    WordNeighbours,
    WordShape,
    find_neighbours,
    trim_count,
    word_starts,
)

_KEEP = 5
_NEAR = 2
_SIZES = (125_000, 250_000, 500_000, 1_000_000)
_SHAPE = WordShape()


def search_timing(
    data: Sequence[Path], *, seed: int = 0, long: bool = True
) -> Generator[Progress, None, list[SpeedRow]]:
    """Measure the search of 20 s in contexts of up to a million frames, and 600 s in themselves.

    The takes of the source are not in the context. The index is warm; building it is a row of its
    own.

    Parameters
    ----------
    data
        Folders or files.
    seed
        Of the choice of takes and of the variations.
    long
        Whether it is measured at all but for the smallest context.

    Raises
    ------
    MocapError
        If fewer than two takes can be read.
    """
    found = entries(tuple(data), available(tuple(data))[0])
    order = np.random.default_rng(seed).permutation(len(found))
    takes = read_some([found[i] for i in order], 60)
    if len(takes) < 2:
        raise MocapError("two takes at least are needed to measure the search")
    cut = max(len(takes) // 5, 1)
    joints = comparable_joints(takes[0], takes[1:])
    source = motion_texture(lasting(takes[:cut], 20.0), joints)
    others = [motion_texture(take, joints) for take in takes[cut:]]
    rows = list[SpeedRow]()
    for i, frames in enumerate(_SIZES if long else _SIZES[:1]):
        yield Progress(i / (len(_SIZES) + 1), f"20 s against {frames:,} frames")
        context = large_context(others, frames, seed)
        last = long and frames == _SIZES[-1]
        rows += _against(source, context, frames, with_recall=last or not long)
    if long:
        yield Progress(len(_SIZES) / (len(_SIZES) + 1), "600 s against itself, indexed")
        whole = motion_texture(lasting(takes, 600.0), joints)
        rows.append(_alone(whole))
    return rows


def recall(found: WordNeighbours, exact: WordNeighbours) -> float:
    """Share of the exact neighbours that were found within two frames."""
    near = np.abs(found.found[:, None] - exact.found[:, :, None]) <= _NEAR
    there = exact.found >= 0
    return float(near.any(axis=2)[there].mean()) if there.any() else math.nan


def _against(
    source: MotionTexture, context: Sequence[MotionTexture], frames: int, *, with_recall: bool
) -> list[SpeedRow]:
    trim = trim_count(len(source.joints), whole_body=True)
    starts = word_starts(len(source), _SHAPE)
    rows = list[SpeedRow]()
    clock, cpu = best_of(lambda: index_of(context, _SHAPE), 1)
    rows.append(SpeedRow(f"index of {frames:,} frames, once", clock, cpu))
    index = index_of(context, _SHAPE)
    results = list[WordNeighbours]()

    def indexed() -> None:
        results.append(find_indexed(source, index, starts, _KEEP, trim, _SHAPE))

    clock, cpu = best_of(indexed, 2)
    name = f"20 s against {frames:,} frames, indexed"
    reach = 1.5 if frames == _SIZES[-1] else math.nan
    series, size = "context, indexed", frames / 24.0
    if with_recall:
        exact = list[WordNeighbours]()
        corpus = Corpus.of(context)
        slow = best_of(
            lambda: exact.append(find_neighbours(source, corpus, _KEEP, trim, _SHAPE)), 1
        )
        rows.append(SpeedRow(f"20 s against {frames:,} frames, exact", *slow))
        name += f" (recall {recall(results[0], exact[0]):.3f})"
    rows.append(SpeedRow(name, clock, cpu, reach, series=series, size=size))
    return rows


def _alone(whole: MotionTexture) -> SpeedRow:
    trim, starts = trim_count(len(whole.joints), whole_body=True), word_starts(len(whole), _SHAPE)

    def indexed() -> None:
        index = WordIndex.of([whole], _SHAPE)
        find_indexed(whole, index, starts, _KEEP, trim, _SHAPE, own=True)

    clock, cpu = best_of(indexed, 1)
    return SpeedRow("600 s against itself, indexed, index built anew", clock, cpu, 5.0)
