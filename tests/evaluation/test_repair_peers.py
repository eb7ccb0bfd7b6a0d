from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mocapstudio.cleaning.model import Kind
from mocapstudio.evaluation.cases import Case
from mocapstudio.evaluation.injection import inject
from mocapstudio.evaluation.repair_benchmark import true_spans
from mocapstudio.evaluation.repair_metrics import changed_outside
from mocapstudio.evaluation.repair_peers import (
    PEERS,
    butterworth,
    kalman,
    low_rank,
    savitzky_golay,
    slerp,
    smoothed_states,
    spline,
)
from mocapstudio.evaluation.truth import departure
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.facing import ROOT_POSITION

SMOOTHERS = {"Savitzky-Golay", "Butterworth"}


def spoilt_case(take, kind: Kind, seed: int = 0, context=()) -> Case:
    dirty, truth = inject(take, kind, np.random.default_rng(seed))
    return Case(dirty, take, (truth,), tuple(context))


@pytest.mark.parametrize("name", [n for n in PEERS if n not in SMOOTHERS])
@pytest.mark.parametrize("kind", [Kind.FLIP, Kind.LIMB, Kind.HEADING_FLIP, Kind.HEIGHT_DRIFT])
def test_told_the_spans_a_peer_leaves_all_else_alone(make_take, name, kind) -> None:
    case = spoilt_case(make_take(8.0), kind, context=[make_take(8.0, seed=0)])
    spans = true_spans(case)
    for peer in PEERS[name].members().values():
        result = peer(case.dirty, case.context, spans)
        assert changed_outside(case.dirty, result, spans) == 0
        assert np.allclose(np.linalg.norm(result.rotations, axis=-1), 1.0)
        assert not np.array_equal(result.rotations, case.dirty.rotations) or kind in (
            Kind.HEIGHT_DRIFT,
        )


@pytest.mark.parametrize("name", [n for n in PEERS if n not in SMOOTHERS])
def test_a_short_error_in_smooth_motion_is_undone(make_take, name) -> None:
    take = make_take(8.0, 60)
    case = spoilt_case(take, Kind.POP, context=[take])
    best = min(
        np.nanmax(departure(take, peer(case.dirty, case.context, true_spans(case))))
        for peer in PEERS[name].members().values()
    )
    assert best < 0.2 * departure(take, case.dirty).max()


def test_slerp_agrees_with_scipy(take) -> None:
    from scipy.spatial.transform import Slerp

    joint = take.skeleton.index["Chest"]
    got = slerp(take, (), [Declared("Chest", 40, 55)])
    ends = Rotation.from_quat(take.rotations[[39, 55], joint])
    wanted = Slerp([39, 55], ends)(np.arange(40, 55))
    assert np.allclose(rot.angle(got.rotations[40:55, joint], wanted.as_quat()), 0.0, atol=1e-6)


def test_a_spline_follows_a_steady_turn_and_a_cubic_path(take) -> None:
    time = np.arange(take.frames) / 30
    rotations, translations = take.rotations.copy(), take.translations.copy()
    rotations[:, 2] = rot.from_rotation_vector(np.outer(time, [0.3, 0.1, -0.2]))
    translations[:, 0] = np.stack([time**3, time**2, time], axis=1)
    steady = take.with_motion(rot.continuous(rotations), translations)
    spans = [Declared("Chest", 50, 70), Declared(ROOT_POSITION, 50, 70)]
    got = spline(steady, (), spans, knots=2, seconds=0.1)
    assert np.allclose(rot.angle(got.rotations, steady.rotations), 0.0, atol=1e-5)
    assert np.allclose(got.translations, translations, atol=1e-9)


def test_what_is_wrong_at_the_very_start_or_end_is_held(take) -> None:
    for span in (Declared("Chest", 0, 5), Declared("Chest", take.frames - 5, take.frames)):
        edge = 5 if span.start == 0 else take.frames - 6
        for got in (slerp(take, (), [span]), spline(take, (), [span], knots=4, seconds=0.1)):
            held = got.rotations[span.start : span.end, 2]
            assert np.allclose(held, take.rotations[edge, 2])


def test_kalman_smoothing_is_the_gaussian_posterior() -> None:
    rng = np.random.default_rng(0)
    frames, step, restless = 25, 1 / 30, 3000.0
    values = np.cumsum(rng.standard_normal((frames, 2)), axis=0)
    seen = np.ones(frames, dtype=bool)
    seen[8:14] = False
    # Positions of an integrated Wiener process with a vague start, conditioned in one piece.
    time = np.arange(frames) * step
    low, high = np.minimum.outer(time, time), np.maximum.outer(time, time)
    prior = restless * (low**2 * (3 * high - low) / 6) + 1e9 * (1 + np.outer(time, time))
    gain = prior[:, seen] @ np.linalg.inv(prior[np.ix_(seen, seen)] + np.eye(seen.sum()))
    wanted = gain @ values[seen]
    assert np.allclose(smoothed_states(values, seen, step, restless), wanted, atol=1e-3)


def test_low_rank_recovers_what_the_pose_tells(make_take) -> None:
    rng = np.random.default_rng(1)
    take = make_take(20.0)
    phase = 2 * np.pi * 0.7 * np.arange(take.frames) / 30
    axes = rng.standard_normal((17, 3))
    rotations = rot.from_rotation_vector(0.3 * np.sin(phase)[:, None, None] * axes[None])
    steady = take.with_motion(rotations)
    case = spoilt_case(steady, Kind.OFFSET, seed=3, context=[steady])
    got = low_rank(case.dirty, case.context, true_spans(case), rank=8, noise=0.02)
    assert departure(steady, got).max() < 1.0 < departure(steady, case.dirty).max()
    alone = low_rank(case.dirty, (), true_spans(case), rank=8, noise=0.02)
    assert departure(steady, alone).max() < 1.0


def test_smoothers_keep_what_is_smooth_and_dull_what_is_sharp(make_take) -> None:
    still = make_take(8.0, 60, still=True)
    moved = still.with_motion(translations=np.broadcast_to([[1.0, 0.9, 2.0]], (480, 1, 3)).copy())
    for got in (
        savitzky_golay(moved, (), (), seconds=0.4, order=2),
        butterworth(moved, (), (), hertz=4.0),
    ):
        assert np.allclose(got.translations, moved.translations, atol=1e-6)
    case = spoilt_case(make_take(8.0, 60), Kind.POP)
    got = butterworth(case.dirty, (), (), hertz=4.0)
    wrong = case.mask()
    assert departure(case.clean, got)[wrong].max() < departure(case.clean, case.dirty)[wrong].max()
    assert butterworth(case.dirty, (), (), hertz=40.0) is case.dirty


def test_kalman_is_not_misled_by_turned_signs(make_take) -> None:
    take = make_take(8.0)
    flipped = take.rotations.copy()
    flipped[100:, 2] *= -1
    spans = [Declared("Chest", 95, 105)]
    a = kalman(take, (), spans, restless=1e5)
    b = kalman(take.with_motion(flipped), (), spans, restless=1e5)
    assert np.allclose(rot.angle(a.rotations, b.rotations), 0.0, atol=1e-5)
