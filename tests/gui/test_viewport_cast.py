"""Who is on stage in which state, and at which of their own frames."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from plot_scene import offer, sitting, walking

from mocapstudio.cleaning.model import DigressionMap
from mocapstudio.gui import theme
from mocapstudio.gui.viewport.cast import Part, Stage
from mocapstudio.gui.viewport.mapped import JointValues
from mocapstudio.gui.viewport.palette import palette, tint
from mocapstudio.motion.facing import ROOT_POSITION


def cast(document, **options):
    state = document.state
    options = {"ghosts": True, **options}
    return Stage().cast(state, document.result(state.active), **options)


def only(roles, part):
    (role,) = [role for role in roles if role.part is part]
    return role


def flag_of(document, joint):
    return next(item.flag for item in document.state.queue if item.flag.joint == joint)


def test_alone_a_performer_has_one_role():
    document = sitting()
    (role,) = cast(document)
    assert role.part is Part.RESULT
    assert role.motion.take is document.result(document.state.active)
    assert role.frame(0) == 0
    assert role.frame(document.state.take.frames) is None


def test_a_partner_keeps_their_own_rate_and_offset():
    document = sitting(walking(frames=600, rate=120))
    other = replace(walking(frames=60, rate=30), name="other")
    document.open_take(other, partner=True, offset=1.5)
    role = only(cast(document), Part.PARTNER)
    # At 2 s of the scene the partner, who began 1.5 s later, is at 0.5 s: frame 15 of 30 Hz.
    assert role.frame(240) == 15
    assert role.frame(179) == 0
    assert role.frame(170) is None
    assert role.frame(599) is None or role.frame(599) < 60
    assert role.name == "other"


def test_under_review_a_partner_sees_the_others():
    document = sitting(walking(frames=120))
    first = document.state.active
    second = document.open_take(replace(walking(120), name="second"), partner=True, offset=0.25)
    document.set_active(second)
    role = only(cast(document), Part.PARTNER)
    assert role.motion.take is document.state.scene.performer(first).take
    assert role.frame(0) == 30


def test_takes_that_are_no_partners_stay_off_stage():
    document = sitting(walking(frames=120))
    document.open_take(replace(walking(120), name="another"))
    assert [role.part for role in cast(document)] == [Part.RESULT]


def test_the_proposal_of_the_selected_flag_is_on_stage_within_its_span():
    document = sitting()
    flag = flag_of(document, "LeftForeArm")
    proposal = offer(document, flag.id)
    assert [role.part for role in cast(document)] == [Part.RESULT]
    document.select_flag(flag.id)
    role = only(cast(document), Part.PROPOSAL)
    assert role.turned == {"LeftForeArm"}
    assert role.frame(proposal.start) == proposal.start
    assert role.frame(proposal.start - 1) is None
    assert role.frame(proposal.end) is None
    joint = role.motion.take.skeleton.index["LeftForeArm"]
    inside = role.motion.take.rotations[proposal.start : proposal.end, joint]
    assert inside == pytest.approx(proposal.rotations[:, 0])
    assert [one.part for one in cast(document, ghosts=False)] == [Part.RESULT]


def test_after_accepting_the_original_takes_the_proposal_s_place():
    document = sitting()
    flag = flag_of(document, "LeftForeArm")
    proposal = offer(document, flag.id)
    document.accept([flag.id])
    document.select_flag(flag.id)
    roles = cast(document)
    assert [role.part for role in roles] == [Part.RESULT, Part.ORIGINAL]
    original = only(roles, Part.ORIGINAL)
    assert original.motion.take is document.state.take
    assert original.frame(proposal.start) == proposal.start
    assert original.frame(proposal.end) is None
    (edit,) = document.state.sitting.edits
    document.mute_edit(edit.id, True)
    assert Part.ORIGINAL not in {role.part for role in cast(document)}


def test_figures_are_shaped_once():
    document = sitting()
    stage, state = Stage(), document.state
    first = stage.cast(state, state.take, ghosts=True)
    again = stage.cast(state, state.take, ghosts=True)
    assert first[0].figure is again[0].figure
    assert first[0].motion is again[0].motion


def test_an_off_beat_rate_rounds_to_the_nearest_frame():
    document = sitting(walking(frames=600, rate=120))
    other = replace(walking(100, 30), name="ntsc", rate=Fraction(30000, 1001))
    document.open_take(other, partner=True)
    role = only(cast(document), Part.PARTNER)
    for frame in range(0, 396):
        own = role.frame(frame)
        assert abs(own / float(other.rate) - frame / 120) <= 0.5 / float(other.rate) + 1e-9


def test_joints_are_tinted_by_their_rows_and_the_hips_by_the_root_as_well():
    skeleton = walking(2).skeleton
    rows = ("LeftHand", "Hips", ROOT_POSITION)
    values = np.array([[0.9, 0.1, 0.7], [0.2, 0.8, 0.3]], np.float32)
    seen = JointValues(DigressionMap(rows, values, values), skeleton)
    first = seen.at(0)
    assert first[skeleton.index["LeftHand"]] == pytest.approx(0.9)
    assert first[skeleton.index["Hips"]] == pytest.approx(0.7)
    assert np.isnan(first[skeleton.index["RightHand"]])
    assert seen.at(1)[skeleton.index["Hips"]] == pytest.approx(0.8)


@pytest.mark.parametrize("name", ["dark", "light"])
@pytest.mark.parametrize("threshold", [0.2, 0.5, 0.9])
def test_what_is_flagged_stands_out_and_what_is_not_stays_neutral(name, threshold):
    colours = palette(theme.THEMES[name])
    values = np.array([0.0, 0.4 * threshold, threshold, 1.0, np.nan])
    calm, quiet, flagged, worst, unknown = tint(colours, values, threshold).astype(int)
    assert tuple(calm) == tuple(quiet) == colours.body
    assert tuple(unknown) == colours.unmapped
    for loud in (flagged, worst):
        assert np.abs(loud - calm).max() > 60
        # Coloured, where the body is grey.
        assert np.ptp(loud) > 60 > np.ptp(calm)
