"""Learnt decisions on disk: named by content, read whole or not at all."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from made_takes import walking

from mocapstudio.cleaning.decision import store
from mocapstudio.cleaning.decision.forest import Forest
from mocapstudio.cleaning.decision.general import general_judge
from mocapstudio.cleaning.decision.model import Bench, Decision, Judge
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.take import Take

JOINTS = ("Hips", "Spine", "Head")


def forest(seed: int) -> Forest:
    """One tree of three nodes with numbers of its own."""
    rng = np.random.default_rng(seed)
    return Forest(
        float(rng.normal()),
        np.array([0], dtype=np.int32),
        np.array([seed % 3, -1, -1], dtype=np.int32),
        rng.normal(size=3).astype(np.float32),
        np.array([1, 0, 0], dtype=np.int32),
        np.array([2, 0, 0], dtype=np.int32),
        np.array([1, 0, 0], dtype=np.uint8),
        rng.normal(size=3).astype(np.float32),
    )


def decision(judges: int) -> Decision:
    usual = np.arange(15, dtype=np.float32).reshape(5, 3)
    own = (Judge(forest(2 * i), forest(2 * i + 1)) for i in range(judges))
    both = tuple(Bench(one, general_judge(), 0.25) for one in own)
    doubts = {
        "a": (Declared("Head", 3, 9), Declared("Spine", 0, 2)),
        "b": (Declared("Hips", 1, 2),),
    }
    return Decision(JOINTS, usual, both, forest(9), doubts if judges == 1 else {})


def forests(one: Decision) -> list[Forest]:
    return [f for judge in one.judges for f in (judge.own.joints, judge.own.root)] + [one.spans]


@pytest.mark.parametrize("judges", [1, 2])
def test_what_is_saved_is_loaded(tmp_path: Path, judges: int) -> None:
    path = tmp_path / "new" / "folder" / "one.npz"
    kept = decision(judges)
    store.save(kept, path)
    again = store.load(path)
    assert again is not None
    assert again.joints == JOINTS
    assert again.doubts == kept.doubts
    np.testing.assert_array_equal(again.usual, kept.usual)
    assert [one.share for one in again.judges] == judges * [0.25]
    rows = np.random.default_rng(0).normal(size=(50, 3)).astype(np.float32)
    rows[::7, 0] = np.nan
    for mine, theirs in zip(forests(kept), forests(again), strict=True):
        np.testing.assert_array_equal(mine.probability(rows), theirs.probability(rows))
    assert [p.name for p in path.parent.iterdir()] == ["one.npz"]


def test_a_missing_or_damaged_file_is_no_decision(tmp_path: Path) -> None:
    path = tmp_path / "one.npz"
    assert store.load(path) is None
    assert store.load(tmp_path) is None
    store.save(decision(1), path)
    whole = path.read_bytes()
    for damaged in (b"", b"no zip at all", whole[: len(whole) // 2], whole[:-30]):
        path.write_bytes(damaged)
        assert store.load(path) is None


def test_no_flipped_byte_makes_it_fail(tmp_path: Path) -> None:
    """It is either read or refused: a broken cache must never stop an analysis."""
    path = tmp_path / "one.npz"
    store.save(decision(1), path)
    whole = path.read_bytes()
    rng = np.random.default_rng(1)
    for at in rng.choice(len(whole), 300, replace=False):
        spoilt = bytearray(whole)
        spoilt[at] ^= int(rng.integers(1, 256))
        path.write_bytes(bytes(spoilt))
        found = store.load(path)
        assert found is None or found.joints == JOINTS


def test_a_file_with_a_part_missing_is_no_decision(tmp_path: Path) -> None:
    path = tmp_path / "one.npz"
    store.save(decision(1), path)
    with np.load(path) as arrays:
        parts = dict(arrays)
    for name in parts:
        np.savez_compressed(path, **{k: v for k, v in parts.items() if k != name})
        assert store.load(path) is None


def test_a_save_that_fails_leaves_nothing(tmp_path: Path) -> None:
    path = tmp_path / "one.npz"
    store.save(decision(1), path)
    before = path.read_bytes()
    broken = replace(decision(1), judges=(None,))  # type: ignore[arg-type]
    with pytest.raises(AttributeError):
        store.save(broken, path)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["one.npz"]


def takes() -> list[Take]:
    return [walking(1.0, seed=seed) for seed in range(3)]


def test_the_key_is_of_the_content_in_any_order() -> None:
    one, two, three = takes()
    first = store.key([one, two, three], JOINTS)
    assert store.key([three, one, two], JOINTS) == first
    assert store.key([replace(t, name="other", source=None) for t in takes()], JOINTS) == first
    assert len(first) == 32 and first.isalnum()


def test_the_key_changes_with_all_that_matters() -> None:
    one, two, three = takes()
    first = store.key([one, two, three], JOINTS)
    rotations, places = two.rotations.copy(), two.translations.copy()
    rotations[17, 3, 1] += 1e-4
    places[5, 0, 2] += 1e-4
    longer = replace(
        two.skeleton,
        offsets=two.skeleton.offsets * np.where(np.arange(19) == 13, 1.1, 1.0)[:, None],
    )
    others = [
        two.with_motion(rotations),
        two.with_motion(translations=places),
        replace(two, rate=Fraction(60)),
        replace(two, trim=(0, 29)),
        replace(two, skeleton=longer),
        one,
    ]
    found = {store.key([one, other, three], JOINTS) for other in others}
    assert len(found | {first}) == len(others) + 1
    assert store.key([one, two], JOINTS) != first
    assert store.key([one, two, three, three], JOINTS) != first
    assert store.key([one, two, three], JOINTS[:2]) != first
    assert store.key([one, two, three], JOINTS[::-1]) != first


def test_the_users_cache_is_the_place() -> None:
    folder = store.default_folder()
    assert folder.is_absolute()
    assert folder.name == "decisions"
