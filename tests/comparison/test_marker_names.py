"""Markers told by their labels, and the frame of the head of paper 4."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from mocapstudio import formats
from mocapstudio.comparison.kata import performance_of
from mocapstudio.comparison.marker_names import limb_of, marker_roles
from mocapstudio.comparison.normalisation import normalised
from mocapstudio.comparison.parameters import BOX
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.markers import MarkerTake

# Labels and rough places, in metres, of the 25 markers of paper 4 (figure 1): x left, y up.
KARATE = {
    "BKHD": (0, 1.75, -0.12), "RFHD": (-0.08, 1.75, 0.1), "LFHD": (0.08, 1.75, 0.1),
    "C7": (0, 1.5, -0.08), "NCK": (0, 1.45, 0.06),
    "RSHD": (-0.2, 1.45, 0), "LSHD": (0.2, 1.45, 0),
    "RELB": (-0.25, 1.15, 0), "LELB": (0.25, 1.15, 0),
    "RWRS": (-0.25, 0.9, 0.1), "LWRS": (0.25, 0.9, 0.1),
    "RIND": (-0.25, 0.8, 0.12), "LIND": (0.25, 0.8, 0.12),
    "RPNK": (-0.27, 0.8, 0.1), "LPNK": (0.27, 0.8, 0.1),
    "RFHP": (-0.12, 1.0, 0.1), "RBHP": (-0.08, 1.0, -0.1),
    "LFHP": (0.12, 1.0, 0.1), "LBHP": (0.08, 1.0, -0.1),
    "RKNE": (-0.12, 0.5, 0.05), "LKNE": (0.12, 0.5, 0.05),
    "RFAK": (-0.12, 0.1, 0.05), "RBAK": (-0.12, 0.1, -0.05),
    "LFAK": (0.12, 0.1, 0.05), "LBAK": (0.12, 0.1, -0.05),
}  # fmt: skip


@pytest.fixture(scope="module")
def karate() -> MarkerTake:
    rng = np.random.default_rng(0)
    places = np.array(list(KARATE.values()), float)
    turn = rot.from_rotation_vector(np.cumsum(rng.normal(0, 0.1, (40, 1, 3)), axis=0))
    body = places + 0.01 * np.cumsum(rng.normal(size=(40, 25, 3)), axis=0)
    world = rot.rotate(np.broadcast_to(turn, (40, 25, 4)), body) + rng.normal(size=(40, 1, 3))
    return MarkerTake("karate", tuple(KARATE), world, Fraction(250))


@pytest.mark.parametrize(
    ("label", "limb"),
    [
        ("BKHD", "head"), ("male:LFHD", "head"), ("C7", "spine"), ("NCK", "spine"),
        ("RSHD", "right arm"), ("LPNK", "left arm"), ("RFHP", "spine"), ("LBWT", "spine"),
        ("LKNE", "left leg"), ("RFAK", "right leg"), ("LASI", "spine"), ("R.Heel", "right leg"),
        ("r_shoulder_study", "right arm"), ("L.PSIS_study", "spine"), ("LMT5", "left leg"),
        ("LeftForeArm", "left arm"), ("RightThigh", "right leg"), ("RWRA", "right arm"),
        ("LSmallToe", "left leg"), ("ball", "other"), ("STRN", "spine"), ("RBAC", "spine"),
    ],
)  # fmt: skip
def test_limbs_are_told_by_labels(label: str, limb: str) -> None:
    assert limb_of(label) == limb


def test_one_marker_stands_for_each_joint() -> None:
    roles = {role: list(KARATE)[i] for i, role in marker_roles(tuple(KARATE)).items()}
    assert roles["head"] == "BKHD"
    assert roles["neck"] == "NCK"
    assert roles["left elbow"] == "LELB"
    assert roles["right hand"] == "RWRS"
    assert roles["left foot"] == "LFAK"
    assert len(set(roles.values())) == len(roles)


def test_the_head_frame_is_that_of_the_paper(karate: MarkerTake) -> None:
    performance = performance_of(karate)
    local = performance.head.local(performance.positions)
    at = {row.name: i for i, row in enumerate(performance.rows)}
    np.testing.assert_allclose(local[:, at["NCK"]], 0, atol=1e-9)
    np.testing.assert_allclose(local[:, at["BKHD"], :2], 0, atol=1e-9)
    assert (local[:, at["BKHD"], 2] > 0).all()
    np.testing.assert_allclose(local[:, at["C7"], 0], 0, atol=1e-9)
    # A rotation, not a reflection: distances and handedness stay.
    original = karate.positions[:, karate.index["LELB"]] - karate.positions[:, karate.index["NCK"]]
    np.testing.assert_allclose(
        np.linalg.norm(local[:, at["LELB"]], axis=1), np.linalg.norm(original, axis=1)
    )
    determinants = np.linalg.det(performance.head.axes)
    np.testing.assert_allclose(determinants, 1)


def test_the_unit_box_is_touched_and_holds_everything(karate: MarkerTake) -> None:
    poses = normalised(performance_of(karate), range(25), BOX)
    assert np.abs(poses.points - 0.5).max() == pytest.approx(0.5)
    assert performance_of(karate).warnings == ()


def test_rows_are_in_the_order_of_limbs(karate: MarkerTake) -> None:
    limbs = [row.limb for row in performance_of(karate).rows]
    assert list(dict.fromkeys(limbs)) == [
        "spine", "head", "left arm", "right arm", "left leg", "right leg",
    ]  # fmt: skip
    assert len(set(limbs)) == sum(a != b for a, b in pairwise(limbs)) + 1


def test_a_real_take_of_markers_has_a_head_and_no_strangers(data: Path) -> None:
    path = data / "cmu_martial_arts_c3d" / "135_02.c3d"
    if not path.exists():
        pytest.skip(f"no {path}")
    performance = performance_of(formats.read_any(path)[0][0])
    assert performance.warnings == ()
    assert len(performance.rows) == 41
    assert {row.limb for row in performance.rows} == {
        "spine", "head", "left arm", "right arm", "left leg", "right leg",
    }  # fmt: skip
