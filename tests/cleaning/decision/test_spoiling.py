"""Errors put into clean motion: labels tell the truth, and nothing else changes."""

from __future__ import annotations

import numpy as np
import pytest
from made_takes import horse, person, walking
from scipy.spatial.transform import Rotation

from mocapstudio.cleaning.decision import shapes
from mocapstudio.cleaning.decision.spoiling import Anatomy, spoil
from mocapstudio.cleaning.decision.surroundings import anatomy_of
from mocapstudio.motion.topology import topology
from mocapstudio.similarity.texture import BodyMotion, body_motion

JOINTS = person().names
ANATOMY = anatomy_of(person(), JOINTS)


def motion(seconds: float = 12.0, rate: int = 30, seed: int = 0) -> BodyMotion:
    return body_motion(walking(seconds, rate, seed=seed), JOINTS)


def departures(clean: BodyMotion, spoilt: BodyMotion) -> np.ndarray:
    """(F, m + 2): degrees of the joints, centimetres of the root's place, degrees of heading."""
    a = Rotation.from_quat(clean.rotations.reshape(-1, 4))
    b = Rotation.from_quat(spoilt.rotations.reshape(-1, 4))
    turned = np.rad2deg((a.inv() * b).magnitude()).reshape(clean.rotations.shape[:2])
    moved = 100.0 * np.linalg.norm(spoilt.position - clean.position, axis=1)
    headed = np.rad2deg(np.abs(spoilt.heading - clean.heading))
    return np.column_stack([turned, moved, headed])


@pytest.mark.parametrize("rate", [30, 120])
@pytest.mark.parametrize("seed", range(6))
def test_labels_agree_with_what_was_done(rate: int, seed: int) -> None:
    clean = motion(rate=rate, seed=seed)
    spoilt, label = spoil(clean, ANATOMY, np.random.default_rng(seed))
    away = departures(clean, spoilt)
    assert label.shape == away.shape
    assert set(np.unique(label)) <= {-1, 0, 1}
    assert np.any(label == 1)
    wrong = np.array([10.0] * len(JOINTS) + [2.0, 10.0])
    doubtful = np.array([4.0] * len(JOINTS) + [0.8, 4.0])
    slack = 1e-3
    assert np.all(label[away > wrong + slack] == 1)
    assert np.all((away <= doubtful + slack)[label == 0])
    between = (away > doubtful + slack) & (away < wrong - slack)
    assert np.all(label[between] != 0)
    # What is small and yet called wrong lies inside a pop or jitter: never on the heading.
    assert np.all(away[:, -1][label[:, -1] == 1] > 10.0 - slack)
    np.testing.assert_allclose(np.linalg.norm(spoilt.rotations, axis=-1), 1.0, atol=1e-9)


def test_the_clean_motion_is_left_as_it_was() -> None:
    clean = motion()
    before = clean.rotations.copy(), clean.heading.copy(), clean.position.copy()
    spoil(clean, ANATOMY, np.random.default_rng(1))
    for kept, now in zip(before, (clean.rotations, clean.heading, clean.position), strict=True):
        np.testing.assert_array_equal(kept, now)


@pytest.mark.parametrize("seed", range(60))
def test_one_error_stays_in_one_span_of_one_limb(seed: int) -> None:
    """In a motion as short as this there is room for one error."""
    clean = motion(3.0, seed=seed % 5)
    spoilt, label = spoil(clean, ANATOMY, np.random.default_rng(seed))
    # But for their signs, quaternions outside the error are bit for bit the same.
    same = np.all(np.abs(spoilt.rotations) == np.abs(clean.rotations), axis=-1)
    placed = np.all(spoilt.position == clean.position, axis=1)
    headed = spoilt.heading == clean.heading
    rows = np.column_stack([~same, ~placed, ~headed])
    touched = np.flatnonzero(rows.any(axis=1))
    if not len(touched):
        assert not label.any()
        return
    start, end = touched[0], touched[-1] + 1
    assert start > 0 and end < len(clean)
    assert end - start <= 101 * 30 / 24
    assert np.all(label[:start] == 0) and np.all(label[end:] == 0)
    assert np.all(label[:, ~rows.any(axis=0)] == 0)
    joints = np.flatnonzero(rows[:, :-2].any(axis=0))
    limbs = set(ANATOMY.limb[joints].tolist())
    mirrored = {int(ANATOMY.limb[ANATOMY.mirror[j]]) for j in joints}
    assert len(limbs) <= 1 or limbs <= mirrored
    assert (len(joints) > 0) + (not placed.all()) + (not headed.all()) == 1


def test_every_kind_of_error_occurs() -> None:
    rng, clean = np.random.default_rng(3), motion(30.0)
    rows = np.zeros(len(JOINTS) + 2)
    for _ in range(40):
        _, label = spoil(clean, ANATOMY, rng)
        rows += (label == 1).any(axis=0)
    assert rows.min() > 0


def test_the_same_seed_spoils_the_same_way() -> None:
    clean = motion()
    once, again, other = (spoil(clean, ANATOMY, np.random.default_rng(seed)) for seed in (5, 5, 6))
    np.testing.assert_array_equal(once[0].rotations, again[0].rotations)
    np.testing.assert_array_equal(once[1], again[1])
    assert np.any(once[1] != other[1])


@pytest.mark.parametrize("frames", [2, 3, 6, 10, 20])
def test_a_short_motion_is_spoilt_where_there_is_room(frames: int) -> None:
    for seed in range(20):
        clean = motion(frames / 30, seed=seed)
        spoilt, label = spoil(clean, ANATOMY, np.random.default_rng(seed))
        assert len(spoilt) == len(label) == frames
        assert np.all(np.isfinite(spoilt.rotations))


def test_anatomy_tells_limbs_and_mirror_images() -> None:
    for skeleton in (person(), person(fingers=True), horse()):
        parts = topology(skeleton)
        names = [skeleton.names[j] for j in parts.body_joints()]
        found = anatomy_of(skeleton, names)
        assert sorted(set(found.limb.tolist())) == list(range(found.limb.max() + 1))
        for k, name in enumerate(names):
            limb = parts.limb_of(skeleton.index[name])
            mates = {names[i] for i in np.flatnonzero(found.limb == found.limb[k])}
            assert mates == {skeleton.names[j] for j in limb.joints} & set(names)
            assert names[found.mirror[k]] == skeleton.names[parts.mirror[skeleton.index[name]]]
    # A joint whose partner is not compared has none.
    some = anatomy_of(person(), ["Hips", "LeftArm", "RightLeg"])
    np.testing.assert_array_equal(some.mirror, [0, 1, 2])


@pytest.mark.parametrize("kind", ["pop", "spike", "drift", "offset", "flip", "noise"])
@pytest.mark.parametrize("frames", [1, 2, 7, 60])
def test_errors_grow_to_about_their_size_and_no_further(kind: str, frames: int) -> None:
    for seed in range(30):
        rng = np.random.default_rng(seed)
        size = shapes.envelope(kind, frames, 1.25, rng)
        assert size.shape == (frames,)
        assert np.abs(size).max() <= 1.3 + 1e-9
        assert np.abs(size).max() > 0.0
        axis = shapes.axis(frames, rng)
        np.testing.assert_allclose(np.linalg.norm(axis, axis=1), 1.0, atol=1e-9)


@pytest.mark.parametrize(("kind", "low", "high"), [("jitter", 12.0, 60.0), ("noise", 1.0, 12.0)])
def test_jitter_lies_above_twelve_hertz_and_noise_below(kind: str, low: float, high: float) -> None:
    rate = 120.0
    for seed in range(10):
        values = shapes.noise(kind, 240, rate, np.random.default_rng(seed))
        assert np.linalg.norm(values, axis=1).max() == pytest.approx(1.0)
        power = (np.abs(np.fft.rfft(values * np.hanning(240)[:, None], axis=0)) ** 2).sum(axis=1)
        frequency = np.fft.rfftfreq(240, 1 / rate)
        inside = (frequency >= low - 1) & (frequency <= high + 1)
        assert power[inside].sum() > 0.95 * power.sum()


def test_no_limb_no_swap() -> None:
    """A chain has no sides to exchange; it is spoilt in other ways."""
    alone = Anatomy(np.zeros(len(JOINTS), dtype=np.int64), np.arange(len(JOINTS)))
    clean = motion()
    for seed in range(10):
        _, label = spoil(clean, alone, np.random.default_rng(seed))
        assert label.shape == (len(clean), len(JOINTS) + 2)
