"""The indexed search against the exact one."""

from __future__ import annotations

import numpy as np
import pytest
from made_takes import walking

from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.parameters import DetectionParameters
from mocapstudio.motion.errors import ParameterError
from mocapstudio.motion.progress import run
from mocapstudio.similarity import index, kernels, search
from mocapstudio.similarity.choices import AUTOMATIC, EXACT, INDEXED
from mocapstudio.similarity.search import find_indexed, index_of, searching
from mocapstudio.similarity.texture import MotionTexture, motion_texture
from mocapstudio.similarity.words import (
    Corpus,
    WordNeighbours,
    WordShape,
    find_neighbours,
    word_starts,
)

JOINTS = ("Hips", "Spine", "LeftArm", "RightUpLeg", "LeftLeg", "Head")
SHAPE = WordShape()


def texture(seconds: float, seed: int) -> MotionTexture:
    return motion_texture(walking(seconds, rate=24, seed=seed, variation=0.3), JOINTS)


def finished(source: MotionTexture, corpus: Corpus, how: str, keep: int = 5) -> WordNeighbours:
    work, shares = searching(source, corpus, keep, 1, SHAPE, how), list[float]()
    while True:
        try:
            shares.append(next(work))
        except StopIteration as stop:
            assert shares == sorted(shares)
            assert all(0 <= share < 1 for share in shares)
            return stop.value


def same(one: WordNeighbours, other: WordNeighbours) -> None:
    np.testing.assert_array_equal(one.words, other.words)
    np.testing.assert_allclose(one.distances, other.distances, rtol=1e-4, atol=1e-7)
    np.testing.assert_array_equal(one.found, other.found)
    np.testing.assert_array_equal(one.spans, other.spans)


@pytest.fixture(scope="module")
def parts() -> list[MotionTexture]:
    return [texture(8.0, 0), texture(6.0, 1), texture(0.6, 2), texture(9.0, 3), texture(0.9, 4)]


@pytest.mark.parametrize("own", [True, False])
@pytest.mark.parametrize("keep", [1, 5])
def test_a_small_index_finds_what_the_exact_search_finds(
    parts: list[MotionTexture], own: bool, keep: int
) -> None:
    """There the candidates are all words: gathering, minima and exclusions are what is tested."""
    source = parts[0]
    corpus = Corpus.of(parts if own else parts[1:])
    same(finished(source, corpus, INDEXED, keep), finished(source, corpus, EXACT, keep))


def test_minima_are_true_ones_however_few_the_candidates(
    parts: list[MotionTexture], monkeypatch
) -> None:
    """From anywhere the search descends to a local minimum of the exact distance."""
    source, corpus = parts[0], Corpus.of(parts[1:])
    monkeypatch.setattr(index, "_COUNTS", (2,) * len(index.PACES))
    found = finished(source, corpus, INDEXED, 1)
    every = find_neighbours(source, corpus, 200, 1, SHAPE)
    for w in range(len(found.words)):
        at = np.flatnonzero(every.found[w] == found.found[w, 0])
        assert len(at) == 1
        assert every.distances[w, at[0]] == pytest.approx(found.distances[w, 0], rel=1e-4)


@pytest.mark.parametrize(
    ("n", "m", "count"), [(4, 4, 1), (15, 20, 127), (15, 20, 129), (6, 13, 300)]
)
def test_dtw_of_listed_words_is_that_of_all_words(n: int, m: int, count: int) -> None:
    rng = np.random.default_rng(count)
    distances = rng.uniform(0.01, 1.0, (n, 500)).astype(np.float32)
    whole, ends = np.empty(501 - m, np.float32), np.empty((2, 501 - m), np.int16)
    kernels.dtw_word(distances, m, whole, ends)
    starts = rng.integers(0, 501 - m, count)
    some, some_ends = np.empty(count, np.float32), np.empty((2, count), np.int16)
    kernels.dtw_listed(distances, m, starts, some, some_ends)
    np.testing.assert_array_equal(some, whole[starts])
    np.testing.assert_array_equal(some_ends, ends[:, starts])


def test_gathered_spans_lie_end_to_end() -> None:
    poses = np.random.default_rng(0).normal(size=(30, 3, 4)).astype(np.float32)
    runs = np.array([[2, 5], [5, 6], [20, 30]])
    planes = np.full((3, 4, 14), np.nan, np.float32)
    kernels.gather(poses, runs, planes)
    expected = np.concatenate([poses[a:b] for a, b in runs])
    np.testing.assert_array_equal(planes.transpose(2, 0, 1), expected)


def test_the_sign_of_a_quaternion_does_not_matter(parts: list[MotionTexture]) -> None:
    made = index.WordIndex.of(parts, SHAPE)
    assert made is not None
    poses = parts[1].quaternions
    turned = poses.copy()
    turned[10:, 2] *= -1
    starts = np.arange(5, 60, 5)
    ours = made.features.of(poses, starts)
    np.testing.assert_allclose(made.features.of(turned, starts), ours, atol=1e-5)
    # Of all that is indexed a word that is there itself is the nearest.
    here = made.starts[7]
    assert made.tree.query(made.features.of(made.poses, np.array([here])))[1].item() == 7


def test_the_index_is_kept_by_content(parts: list[MotionTexture]) -> None:
    first = index_of(parts, SHAPE)
    assert index_of([*parts], SHAPE) is first
    assert index_of(parts, WordShape(12, 5, 20)) is not first
    assert index_of(parts[1:], SHAPE) is not first
    assert len(search._kept) <= 2


@pytest.mark.parametrize("frames", [2, 14, 19])
def test_where_no_word_is_long_enough_none_is_found(frames: int) -> None:
    short = motion_texture(walking(frames / 24, rate=24, seed=1), JOINTS)
    source = texture(2.0, 0)
    found = finished(source, Corpus.of([short]), INDEXED)
    assert np.all(found.found == -1)
    assert np.all(np.isinf(found.distances))
    nothing = find_indexed(source, None, word_starts(len(source), SHAPE), 5, 1, SHAPE)
    same(found, nothing)


def test_automatic_is_exact_below_and_indexed_above_the_break_even(
    parts: list[MotionTexture], monkeypatch
) -> None:
    used: list[int] = []
    build = index.WordIndex.of

    def counted(textures: list[MotionTexture], shape: WordShape) -> index.WordIndex | None:
        used.append(sum(map(len, textures)))
        return build(textures, shape)

    monkeypatch.setattr(search, "_kept", type(search._kept)())
    monkeypatch.setattr(index.WordIndex, "of", staticmethod(counted))
    corpus = Corpus.of(parts)
    exact = finished(parts[0], corpus, AUTOMATIC)
    assert used == []
    monkeypatch.setattr(search, "WORTH_INDEXING", 300)
    # The take itself is short and searched exactly; the context is indexed.
    same(finished(parts[0], corpus, AUTOMATIC), exact)
    assert used == [corpus.frames - len(parts[0])]


def test_the_parameter_reaches_the_search() -> None:
    take, context = walking(4.0, seed=0, variation=0.3), [walking(5.0, seed=1, variation=0.3)]
    maps = [
        run(detect(take, context, DetectionParameters(search=how))).map.values
        for how in (EXACT, INDEXED)
    ]
    np.testing.assert_allclose(maps[0], maps[1], atol=1e-3)
    with pytest.raises(ParameterError, match="search must be one of"):
        DetectionParameters(search="guess")


def test_real_neighbours_are_found(data) -> None:
    """Nearly all of the exact K within two frames, on takes that the index does not hold whole."""
    from mocapstudio.evaluation.corpora import read_take
    from mocapstudio.similarity.texture import comparable_joints

    folder = data / "bandai_1_styles_bvh_CCBYNC4"
    takes = [read_take(path) for path in sorted(folder.glob("*walk*.bvh"))[:14]]
    joints = comparable_joints(takes[0], takes[1:])
    source, *others = [motion_texture(take, joints) for take in takes]
    corpus = Corpus.of(others)
    exact = find_neighbours(source, corpus, 5, 3, SHAPE)
    made = index_of(others, SHAPE)
    found = find_indexed(source, made, exact.words, 5, 3, SHAPE)
    near = np.abs(found.found[:, None] - exact.found[:, :, None]) <= 2
    assert near.any(axis=2).mean() >= 0.99
