"""Motion-words: their places, their neighbours by brute force, and their resampling."""

from __future__ import annotations

from dataclasses import replace

import naive
import numpy as np
import pytest
from made_takes import walking
from scipy.spatial.transform import Rotation

from mocapstudio.motion import rotations as rot
from mocapstudio.similarity import words
from mocapstudio.similarity.parallel import blocks, for_blocks
from mocapstudio.similarity.texture import MotionTexture, motion_texture
from mocapstudio.similarity.words import (
    Corpus,
    WordShape,
    find_neighbours,
    resampling_matrix,
    warped_word,
    word_starts,
)

JOINTS = ("Hips", "Spine", "LeftArm", "RightUpLeg", "LeftLeg", "Head")


def texture(seconds: float, seed: int) -> MotionTexture:
    return motion_texture(walking(seconds, rate=24, seed=seed, variation=0.3), JOINTS)


def bare(quaternions: np.ndarray) -> MotionTexture:
    frames = len(quaternions)
    still = np.zeros((frames, 3), np.float32)
    names = tuple(f"j{i}" for i in range(quaternions.shape[1]))
    return MotionTexture(names, quaternions.astype(np.float32), still, still[:, 0], 0, 1.0)


@pytest.mark.parametrize("frames", [0, 1, 14, 15, 16, 20, 21, 100])
@pytest.mark.parametrize(("length", "hop"), [(15, 5), (5, 1), (7, 30)])
def test_words_cover_the_texture_to_its_last_frame(frames: int, length: int, hop: int) -> None:
    starts = word_starts(frames, WordShape(length, hop, length))
    assert starts.tolist() == naive.word_starts(frames, length, hop)
    assert (len(starts) == 0) == (frames < length)


def test_the_corpus_knows_where_its_frames_come_from() -> None:
    parts = [texture(1.0, 0), texture(0.5, 1), texture(2.0, 2)]
    corpus = Corpus.of(parts)
    assert corpus.frames == 24 + 12 + 48
    for which, part in enumerate(parts):
        for frame in (0, len(part) // 2, len(part) - 1):
            at = int(corpus.starts[which]) + frame
            assert corpus.locate(at) == (which, frame)
            np.testing.assert_array_equal(corpus.planes[:, :, at], part.quaternions[frame])


@pytest.mark.parametrize("own", [True, False])
@pytest.mark.parametrize("group", [None, [0, 2, 4]])
def test_neighbours_are_those_of_brute_force(own: bool, group: list[int] | None) -> None:
    source = texture(3.0, 0)
    others = [texture(2.2, 1), texture(0.6, 2), texture(1.4, 3)]  # the second: shorter than a word
    corpus = Corpus.of([source, *others] if own else others)
    shape, keep, trim = WordShape(9, 6, 12), 5, 1
    joints = None if group is None else np.array(group)
    found = find_neighbours(source, corpus, keep, trim, shape, joints)
    np.testing.assert_array_equal(found.words, naive.word_starts(len(source), 9, 6))
    columns = slice(None) if group is None else group
    targets = [one.quaternions[:, columns] for one in corpus.textures]
    for w, word in enumerate(found.words):
        expected = naive.find_neighbours(
            source.quaternions[:, columns], targets, keep, trim, (9, 12), int(word), own
        )
        there = found.found[w] >= 0
        assert there.sum() == len(expected)
        np.testing.assert_allclose(
            found.distances[w, there], [one[0] for one in expected], rtol=1e-3, atol=1e-6
        )
        places = [corpus.locate(int(at)) for at in found.found[w, there]]
        assert places == [(which, at) for _, which, at, _ in expected]
        assert [tuple(span) for span in found.spans[w, there].tolist()] == [
            ends for *_, ends in expected
        ]


@pytest.mark.parametrize("frames", [0, 10, 40, 400])
def test_searching_in_steps_finds_the_same(frames: int, monkeypatch) -> None:
    monkeypatch.setattr(words, "_TARGETS_A_STEP", 1)  # the least number of words a step
    source = texture(17.0, 0)
    source = replace(source, quaternions=source.quaternions[:frames])
    corpus = Corpus.of([source, texture(3.0, 1)])
    work, shares = words.searching(source, corpus, 3, 1), list[float]()
    while True:
        try:
            shares.append(next(work))
        except StopIteration as stop:
            found = stop.value
            break
    whole = find_neighbours(source, corpus, 3, 1)
    for name in ("words", "found", "spans", "distances"):
        np.testing.assert_array_equal(getattr(found, name), getattr(whole, name))
    assert shares == sorted(shares)
    assert len(shares) == -(-len(whole.words) // 12)


def test_no_neighbour_straddles_two_takes_or_lies_near_its_source() -> None:
    source = texture(4.0, 0)
    corpus = Corpus.of([source, texture(1.0, 1), texture(0.9, 2), texture(3.0, 3)])
    shape = WordShape()
    found = find_neighbours(source, corpus, 15, 1, shape)
    assert np.any(found.found >= 0)
    for word, starts in zip(found.words, found.found, strict=True):
        for start in starts[starts >= 0]:
            which, at = corpus.locate(int(start))
            assert at + shape.target <= len(corpus.textures[which])
            centres = at + shape.target / 2, word + shape.source / 2
            assert which > 0 or abs(centres[0] - centres[1]) >= shape.source / 2


def test_a_repeated_motion_is_its_own_neighbour_elsewhere() -> None:
    one = texture(1.5, 0).quaternions
    gap = Rotation.random(20 * len(JOINTS), rng=1).as_quat().reshape(20, len(JOINTS), 4)
    source = bare(rot.continuous(np.concatenate([one, gap, one]).astype(float)))
    found = find_neighbours(source, Corpus.of([source]), 1, 1)
    for w, elsewhere in ((0, 56), (1, 61)):
        assert found.found[w, 0] == elsewhere
        assert found.distances[w, 0] < 1e-5


@pytest.mark.parametrize("frames", [2, 14, 19])
def test_where_nothing_is_long_enough_nothing_is_found(frames: int) -> None:
    small = bare(texture(2.0, 0).quaternions[:frames])
    found = find_neighbours(small, Corpus.of([small]), 5, 1)
    assert np.all(found.found == -1)
    assert np.all(np.isinf(found.distances))


@pytest.mark.parametrize("length", [1, 2, 5, 15, 20])
@pytest.mark.parametrize("to", [1, 5, 15, 20])
def test_resampling_weights(length: int, to: int) -> None:
    weights = resampling_matrix(length, to)
    assert weights.shape == (to, length)
    np.testing.assert_allclose(weights.sum(axis=1), 1.0, atol=1e-6)
    signal = np.random.default_rng(length).normal(size=(length, 2))
    np.testing.assert_allclose(weights @ signal, naive.resampled(signal, to), atol=1e-6)
    if length == to:
        np.testing.assert_allclose(weights, np.eye(length), atol=1e-7)


@pytest.mark.parametrize(("length", "to"), [(20, 15), (15, 20), (12, 15), (30, 10), (9, 33)])
def test_a_straight_line_stays_one(length: int, to: int) -> None:
    ramp = resampling_matrix(length, to) @ np.arange(length)
    expected = np.linspace(0, length - 1, to)
    lobes = 3 * max(1.0, (length - 1) / (to - 1))
    inner = (expected > lobes) & (expected < length - 1 - lobes)
    np.testing.assert_allclose(ramp[inner], expected[inner], atol=0.1)
    assert np.all(np.diff(ramp) > 0)
    assert abs(ramp[0]) < 1.0
    assert abs(ramp[-1] - length + 1) < 1.0


def test_a_slow_wave_keeps_its_height_and_place() -> None:
    wave = np.sin(2 * np.pi * np.arange(40) / 16)
    for to in (31, 40, 53):
        at = np.linspace(0, 39, to)
        inner = (at > 5) & (at < 34)
        found = resampling_matrix(40, to) @ wave
        np.testing.assert_allclose(found[inner], np.sin(2 * np.pi * at / 16)[inner], atol=0.03)


def test_a_warped_word_has_unit_quaternions_and_keeps_what_needs_no_warping() -> None:
    corpus = Corpus.of([texture(3.0, 0)])
    word = warped_word(corpus, 11, 15, 15)
    np.testing.assert_allclose(word, corpus.textures[0].quaternions[11:26], atol=1e-6)
    for span in (9, 12, 20):
        word = warped_word(corpus, 11, span, 15)
        np.testing.assert_allclose(np.linalg.norm(word, axis=-1), 1.0, atol=1e-6)


@pytest.mark.parametrize("degrees_a_frame", [2.0, 9.0, 14.0, 20.0])
def test_a_warped_word_follows_a_joint_that_spins(degrees_a_frame: float) -> None:
    """An arm that whirls by more than half a turn within a word is no reason to jump."""
    angles = np.deg2rad(degrees_a_frame) * np.arange(40.0)
    spin = bare(rot.continuous(rot.about_axis(0, angles))[:, None])
    word = warped_word(Corpus.of([spin]), 8, 20, 15)[:, 0].astype(float)
    steps = np.rad2deg(rot.angle(word[1:], word[:-1]))
    np.testing.assert_allclose(steps[4:-4], degrees_a_frame * 19 / 14, rtol=0.15)
    expected = rot.about_axis(0, np.deg2rad(degrees_a_frame) * (8 + np.linspace(0, 19, 15)))
    assert np.rad2deg(rot.angle(word, expected)[4:-4]).max() < 0.1 * degrees_a_frame


@pytest.mark.parametrize("rows", [0, 1, 15, 16, 17, 100, 1000])
def test_blocks_partition_their_rows(rows: int) -> None:
    pieces = list(blocks(rows, 16))
    covered = [row for start, end in pieces for row in range(start, end)]
    assert covered == list(range(rows))
    assert all(end - start >= 16 for start, end in pieces[:-1])
    seen = np.zeros(rows, dtype=int)

    def work(start: int, end: int) -> None:
        seen[start:end] += 1

    for_blocks(rows, work)
    assert np.all(seen == 1)


def test_a_fault_in_a_block_is_raised_when_all_have_ended() -> None:
    ended = []

    def work(start: int, _: int) -> None:
        if start == 0:
            raise ArithmeticError("first block")
        ended.append(start)

    with pytest.raises(ArithmeticError, match="first block"):
        for_blocks(500, work)
    assert len(ended) == len(list(blocks(500))) - 1
