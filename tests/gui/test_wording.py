"""What the desk says about flags, in figures that can be checked."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from plot_scene import analysis_of, walking

from mocapstudio.cleaning.model import Kind, Neighbour
from mocapstudio.gui import wording

TAKE = walking(1200, 120, first_frame=1)
ANALYSIS = analysis_of(TAKE)
FLAG = next(flag for flag in ANALYSIS.flags if flag.joint == "LeftForeArm")


def neighbours(count: int) -> list[Neighbour]:
    return [Neighbour("other", 0, 10, 3.0, 1) for _ in range(count)]


def test_an_explanation_names_joint_angle_neighbours_and_length():
    column = ANALYSIS.map.residuals[FLAG.start : FLAG.end, ANALYSIS.map.rows.index(FLAG.joint)]
    text = wording.explain(FLAG, TAKE, ANALYSIS.map, neighbours(5))
    assert text.startswith(
        f"LeftForeArm departs up to {float(np.max(column)):.0f}° from its 5 nearest neighbours"
        f" for {(FLAG.end - FLAG.start) / 120:.2f} s."
    )


def test_root_position_departs_by_centimetres():
    flag = next(flag for flag in ANALYSIS.flags if flag.joint == "root position")
    assert " cm from " in wording.explain(flag, TAKE, ANALYSIS.map, neighbours(1))


@pytest.mark.parametrize("kind", list(Kind))
def test_every_kind_is_explained(kind):
    text = wording.explain(replace(FLAG, kind=kind), TAKE, ANALYSIS.map, [])
    assert len(text.split(". ")) >= 2


def test_other_joints_of_the_limb_are_named():
    flag = replace(FLAG, joints=("LeftForeArm", "LeftHand", "LeftArm"))
    assert "LeftHand and LeftArm depart with it." in wording.explain(
        flag, TAKE, ANALYSIS.map, neighbours(2)
    )


def test_spans_end_with_the_last_frame_they_hold():
    assert wording.span(TAKE, 120, 240) == "1.00–2.00 s (1.00 s, frames 121–240)"
    assert wording.span(TAKE, 120, 121).endswith("frame 121)")


def test_displacements_are_centimetres_largest_first():
    moved = {"LeftHand": 0.123, "RightFoot": 0.2, "Head": 0.0001}
    assert wording.displacement(moved) == "RightFoot 20.0 cm, LeftHand 12.3 cm"
    assert "stay where they are" in wording.displacement({"Head": 0.0})
