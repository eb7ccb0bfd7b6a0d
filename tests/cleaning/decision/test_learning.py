"""Learning from a small context, end to end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from made_takes import faced, moved, turned, walking

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.decision import examples, store, training
from mocapstudio.cleaning.decision.examples import TooLittleToLearnError
from mocapstudio.cleaning.decision.features import COLUMN, NAMES, USUAL
from mocapstudio.cleaning.decision.matching import LEAST_FRAMES
from mocapstudio.cleaning.decision.model import Decision, examine, halves, pool
from mocapstudio.cleaning.decision.surroundings import anatomy_of, surroundings
from mocapstudio.cleaning.decision.training import learn
from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.parameters import PAPER, DetectionParameters
from mocapstudio.cleaning.refined import detect_refined
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION
from mocapstudio.motion.progress import Progress, run
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import body_motion, texture_of

CONTEXT = tuple(walking(5.0, 30, seed=seed) for seed in (1, 2, 3))


@pytest.fixture(scope="session")
def decision() -> Decision:
    """Learnt once from three clean walks of five seconds."""
    return run(learn(CONTEXT))


@pytest.fixture
def little_work(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where what is learnt does not matter, little is learnt from."""
    monkeypatch.setattr(examples, "_VARIANTS", (8, 8))
    for name in ("_WHOLE", "_HALF", "_ROOT", "_SMALL"):
        monkeypatch.setattr(training, name, replace(getattr(training, name), trees=4, least=5))


def decided(take: Take, decision: Decision) -> Analysis:
    analysis = run(detect(take, CONTEXT, decision=decision))
    assert analysis.learnt
    return analysis


@pytest.mark.parametrize("seed", [0, 4, 5, 6])
def test_clean_takes_raise_hardly_a_flag(decision: Decision, seed: int) -> None:
    analysis = decided(walking(10.0, 30, seed=seed), decision)
    assert len(analysis.flags) <= 2


@pytest.mark.parametrize(
    ("joint", "start", "end"),
    [("LeftForeArm", 100, 125), ("RightLeg", 150, 170), ("Spine", 60, 90), ("Head", 200, 230)],
)
@pytest.mark.parametrize("seed", [0, 4])
def test_an_offset_of_40_degrees_is_flagged(
    decision: Decision, joint: str, start: int, end: int, seed: int
) -> None:
    analysis = decided(turned(walking(10.0, 30, seed=seed), joint, start, end, 40), decision)
    flags = [f for f in analysis.flags if f.joint == joint and f.overlaps(start, end)]
    assert flags
    covered = sum(min(f.end, end) - max(f.start, start) for f in flags)
    assert covered > 0.7 * (end - start)
    assert sum(f.end - f.start for f in flags) < 2 * (end - start)
    assert len({f.joint for f in analysis.flags}) <= 3


def test_root_errors_are_flagged_on_their_rows(decision: Decision) -> None:
    clean = walking(10.0, 30, seed=0)
    pop = decided(moved(clean, 80, 82, (0.0, 0.25, 0.0)), decision)
    assert any(f.joint == ROOT_POSITION and f.overlaps(80, 82) for f in pop.flags)
    flip = decided(faced(clean, 120, 140, 120), decision)
    assert any(f.joint == ROOT_HEADING and f.overlaps(120, 140) for f in flip.flags)


def test_probabilities_are_probabilities(decision: Decision) -> None:
    values = decided(turned(walking(6.0, 30, seed=0), "Head", 60, 80, 40), decision).map.values
    assert np.all((values >= 0) & (values <= 1))
    assert values.max() > 0.5


@pytest.mark.parametrize("frames", [3, 12, LEAST_FRAMES, 25, 30])
def test_a_take_too_short_for_a_window_raises_nothing(decision: Decision, frames: int) -> None:
    whole = walking(10.0, 30, seed=0)
    short = replace(
        whole, rotations=whole.rotations[:frames], translations=whole.translations[:frames]
    )
    analysis = decided(short, decision)
    assert np.all(np.isfinite(analysis.map.values))


def test_a_decision_about_other_joints_is_not_used(decision: Decision) -> None:
    take = walking(5.0, 30, seed=0)
    other = replace(decision, joints=decision.joints[:-1])
    analysis = run(detect(take, CONTEXT, decision=other))
    assert not analysis.learnt
    plain = run(detect(take, CONTEXT))
    np.testing.assert_array_equal(analysis.map.values, plain.map.values)


def test_the_same_seed_learns_the_same(little_work: None) -> None:
    some = CONTEXT[:2]
    rows = np.random.default_rng(0).normal(size=(300, len(NAMES))).astype(np.float32)
    once, again, other = (run(learn(some, seed=seed)) for seed in (3, 3, 4))
    np.testing.assert_array_equal(once.usual, again.usual)
    judged = [one.judges[0].own.joints.probability(rows) for one in (once, again, other)]
    np.testing.assert_array_equal(judged[0], judged[1])
    assert np.any(judged[0] != judged[2])


def test_a_single_take_is_judged_by_its_other_half(little_work: None) -> None:
    alone = walking(10.0, 30, seed=0)
    found = run(learn([alone]))
    assert len(found.judges) == 2
    analysis = run(detect(turned(alone, "Spine", 100, 130, 40), decision=found))
    assert analysis.learnt
    assert np.all(np.isfinite(analysis.map.values))


def test_halves_are_whole_takes_or_blocks_of_one() -> None:
    assert set(halves(100, 0, 3)) == {0} and set(halves(100, 1, 3)) == {1}
    alone = halves(400, 0, 1)
    assert set(alone) == {0, 1}
    assert np.flatnonzero(np.diff(alone)).tolist() == [71, 143, 215, 287, 359]


def test_a_context_too_short_to_learn_from_says_so() -> None:
    short = walking(0.5, 30)
    with pytest.raises(TooLittleToLearnError, match="long enough"):
        run(learn([short, walking(0.4, 30, seed=1)]))


def test_learning_can_be_given_up(tmp_path: Path) -> None:
    work = store.prepare(CONTEXT, tmp_path)
    for _ in range(8):
        assert isinstance(next(work), Progress)
    work.close()
    assert list(tmp_path.iterdir()) == []


def test_what_was_learnt_is_kept(
    tmp_path: Path, little_work: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    for n in range(70):
        (tmp_path / f"old{n}.npz").write_bytes(b"")
    first = run(store.prepare(CONTEXT[:2], tmp_path))
    kept = [path for path in tmp_path.glob("*.npz") if path.stat().st_size]
    assert len(kept) == 1
    assert len(list(tmp_path.glob("*.npz"))) <= 64
    seen = list(store.prepare(CONTEXT[1::-1], tmp_path))
    assert [one.what for one in seen] == ["context known"]
    again = run(store.prepare(CONTEXT[:2], tmp_path))
    np.testing.assert_array_equal(again.usual, first.usual)
    # A damaged file is learnt anew.
    kept[0].write_bytes(b"PK")
    run(store.prepare(CONTEXT[:2], tmp_path))
    assert store.load(kept[0]) is not None


def test_a_cache_that_cannot_be_written_costs_nothing_else(
    tmp_path: Path, little_work: None
) -> None:
    (tmp_path / "taken").write_text("a file where the folder should be")
    found = run(store.prepare(CONTEXT[:2], tmp_path / "taken"))
    assert isinstance(found, Decision)


@pytest.fixture
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "decisions"
    monkeypatch.setattr(store, "default_folder", lambda: folder)
    return folder


def test_refined_detection_prepares_and_detects(little_work: None, own_cache: Path) -> None:
    take = walking(5.0, 30, seed=0)
    seen: list[Progress] = []
    analysis = run(detect_refined(take, CONTEXT[:2]), seen.append)
    assert analysis.learnt
    assert len(list(own_cache.iterdir())) == 1
    done = [one.done for one in seen]
    assert done == sorted(done) and done[0] == 0.0 and done[-1] <= 1.0
    same = run(store.prepare(CONTEXT[:2]))
    expected = run(detect(take, CONTEXT[:2], decision=same))
    np.testing.assert_array_equal(analysis.map.values, expected.map.values)


@pytest.mark.parametrize(
    "make",
    [
        lambda take: detect_refined(take, CONTEXT[:2], DetectionParameters(mode=PAPER)),
        lambda take: detect_refined(take, [walking(0.5, 30, seed=1)]),
    ],
)
def test_without_a_decision_the_plain_map_is_drawn(
    own_cache: Path, make: Callable[[Take], object]
) -> None:
    analysis = run(make(walking(5.0, 30, seed=0)))  # type: ignore[arg-type]
    assert isinstance(analysis, Analysis)
    assert not analysis.learnt
    assert not own_cache.exists()


def test_features_of_an_error_stand_out_in_its_joint() -> None:
    take, joints = walking(6.0, 30, seed=0), CONTEXT[0].skeleton.names
    spoilt = turned(take, "LeftForeArm", 60, 90, 40)
    limb = anatomy_of(take.skeleton, joints).limb
    others = [texture_of(body_motion(one, joints)) for one in CONTEXT]
    motion = body_motion(spoilt, joints)
    texture = texture_of(motion)
    seen = examine(motion, surroundings(others, texture, limb))
    assert seen is not None
    assert seen.joints.shape == (len(texture), len(joints), len(NAMES))
    column, inside = joints.index("LeftForeArm"), slice(50, 70)
    for name in ("context mean", "context nearest", "given others", "given other limbs"):
        values = seen.joints[inside, :, COLUMN[name]]
        assert np.all(np.argmax(values, axis=1) == column)
        assert np.abs(values[:, column] - 40).max() < 20
    near = seen.joints[..., COLUMN["context mean"]]
    assert np.median(np.delete(near, column, axis=1)) < 8
    barred = examine(motion, surroundings(others, texture, limb), barred=[0, 1, 2])
    assert barred is not None
    assert np.all(np.isnan(barred.joints[..., COLUMN["context mean"]]))
    assert np.all(barred.joints[..., COLUMN["context count"]] == 0)
    assert np.all(np.isfinite(barred.joints[..., COLUMN["own mean"]]))


def test_pooling_keeps_the_highest_value_of_every_frame() -> None:
    for rate in (24, 30, 60, 120):
        take = walking(3.0, rate, seed=0)
        texture = texture_of(body_motion(take, take.skeleton.names))
        values = np.zeros((take.frames, 1), dtype=np.float32)
        for frame in (0, 1, take.frames // 2, take.frames - 1):
            values[:] = 0.0
            values[frame] = 7.0
            found = pool(values, texture)
            assert found.shape == (len(texture), 1)
            assert found.max() == 7.0
            at = int(np.argmax(found))
            assert abs(texture.frame(at) - frame) <= texture.frames_each


def test_what_is_usual_is_named_for_every_joint(decision: Decision) -> None:
    assert decision.usual.shape == (len(USUAL), len(decision.joints))
    assert np.all(decision.usual > 0)


def test_errors_of_the_context_are_doubted(decision: Decision) -> None:
    """What is wrong in one take is told by the others; clean walks hardly raise any."""
    dirty = turned(CONTEXT[1], "LeftForeArm", 60, 85, 60.0)
    doubts = run(learn([CONTEXT[0], dirty, CONTEXT[2]])).doubted([dirty, CONTEXT[0]])
    (found,) = [one for one in doubts[0] if one.row == "LeftForeArm"]
    assert found.start < 65 and found.end > 80 and found.end - found.start < 50
    clean = decision.doubted(CONTEXT)
    assert sum(len(one) for one in clean) <= 2
