"""Foot-skate clean-up of walks whose skate is known, and of input that cannot be met."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from made_takes import below_a_reference, build, elsewhere, walking

from mocapstudio.cleaning.contacts.model import Contact, ContactPoint, Fixed, Floor, Following, Line
from mocapstudio.cleaning.ik import foot_skate
from mocapstudio.evaluation.demo.take import demo_motion, demo_skeleton
from mocapstudio.formats.changes import covered
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take

SOLE = np.array([0.0, -0.05, 0.1])
LEFT = ContactPoint("LeftFoot", "ball", SOLE)
RIGHT = ContactPoint("RightFoot", "ball", SOLE)
POINTS = (LEFT, RIGHT)


def place(take: Take, point: ContactPoint) -> np.ndarray:
    positions, world = take_pose(take)
    joint = take.skeleton.index[point.joint]
    return positions[:, joint] + rot.rotate(world[:, joint], point.offset)


def contact(point: ContactPoint, start: int, end: int, target, name: str = "c") -> Contact:
    return Contact(name, point.joint, point.point, start, end, target)


def clean(take: Take, *contacts: Contact, **more) -> foot_skate.SkateResult:
    return run(foot_skate.clean(take, contacts, more.pop("points", POINTS), **more))


@pytest.fixture(scope="module")
def walk() -> Take:
    """Knees bent, on the spot but for a slow drift that the feet must not share."""
    take = walking(3.0, rate=60)
    rotations = take.rotations.copy()
    rotations[:, 0] = rot.IDENTITY
    for side in ("Left", "Right"):
        for joint, degrees in (("UpLeg", -30.0), ("Leg", 60.0), ("Foot", -30.0)):
            at = take.skeleton.index[side + joint]
            small = rot.slerp(np.broadcast_to(rot.IDENTITY, rotations[:, at].shape),
                              rotations[:, at], np.full(take.frames, 0.15))  # fmt: skip
            bent = rot.about_axis(0, np.deg2rad(degrees))
            rotations[:, at] = rot.multiply(small, bent)
    time = np.arange(take.frames) / 60
    translations = np.stack([0.05 * time, 0.9 + 0 * time, 0.08 * time], axis=-1)[:, None]
    return take.with_motion(rot.continuous(rotations), translations)


@pytest.fixture(scope="module")
def planted(walk) -> foot_skate.SkateResult:
    height = place(walk, LEFT)[:, 1].mean()
    return clean(
        walk,
        contact(LEFT, 30, 80, Floor(float(height)), "left"),
        contact(RIGHT, 70, 130, Floor(float(height)), "right"),
    )


def test_points_stand_still_on_their_floor(walk, planted):
    for point, start, end in ((LEFT, 30, 80), (RIGHT, 70, 130)):
        after = place(planted.take, point)[start:end]
        assert np.abs(after - after.mean(axis=0)).max() < 5e-4
        assert abs(after[:, 1].mean() - place(walk, LEFT)[:, 1].mean()) < 5e-4
    assert planted.unreached == ()
    assert planted.slide.before > 0.05
    assert planted.slide.worst_after < 0.02


def test_bones_keep_their_length(walk, planted):
    parents = walk.skeleton.parents[1:]
    places = [take_pose(take)[0] for take in (walk, planted.take)]
    before, after = (np.linalg.norm(p[:, 1:] - p[:, parents], axis=2) for p in places)
    np.testing.assert_allclose(after, before, atol=1e-12)


def test_what_is_not_declared_is_untouched(walk, planted):
    allowed = covered(walk, planted.declared)
    turned = (walk.rotations != planted.take.rotations).any(axis=2)
    moved = (walk.translations != planted.take.translations).any(axis=2)
    assert turned.any()
    assert not (turned & ~allowed.rotations).any()
    assert not (moved & ~allowed.translations).any()
    legs = {"UpLeg", "Leg", "Foot"}
    rows = {one.row for one in planted.declared}
    assert rows <= {side + part for side in ("Left", "Right") for part in legs} | {"root position"}


def test_velocities_stay_continuous_at_the_edges(walk, planted):
    """Nowhere does the departure bend faster than a gentle ease over the easing time would."""
    away = place(planted.take, LEFT) - place(walk, LEFT)
    bend = np.linalg.norm(np.diff(away, 2, axis=0), axis=1) * 60**2
    gap = np.linalg.norm(away, axis=1).max()
    # Minimum jerk over T bends by 5.77 gap / T^2 at most; a jump would be gap * rate^2.
    assert bend.max() < 4 * 5.77 * gap / 0.3**2
    assert 4 * 5.77 / 0.3**2 < 0.5 * 60**2


def test_the_motion_between_keeps_its_detail(walk):
    """Arms and trunk are there after the clean-up, sample by sample."""
    result = clean(walk, contact(LEFT, 60, 90, Floor(0.02)))
    at = walk.skeleton.index["RightArm"]
    np.testing.assert_array_equal(result.take.rotations[:, at], walk.rotations[:, at])
    np.testing.assert_array_equal(result.take.rotations[:, 0], walk.rotations[:, 0])


def test_a_planted_take_is_hardly_changed():
    motion = demo_motion()
    span = slice(600, 900)
    take = Take("demo", demo_skeleton(), motion.rotations[span], motion.root[span][:, None],
                Fraction(60))  # fmt: skip
    from mocapstudio.cleaning.contacts.detection import detect_contacts
    from mocapstudio.cleaning.contacts.points import contact_points

    points = contact_points(take)
    contacts = [c for c in detect_contacts(take, points=points) if c.point != "palm"]
    assert len(contacts) >= 4
    result = clean(take, *contacts, points=points)
    assert result.slide.after < result.slide.before
    assert result.slide.worst_after * 1e3 / 60 < 1.0
    assert max(result.turned.values()) < 6.0
    assert result.moved < 0.05


def test_targets_of_every_kind(walk):
    start = place(walk, LEFT)[50]
    fixed = start + np.array([0.02, 0.01, 0.0])
    result = clean(walk, contact(LEFT, 50, 60, Fixed(tuple(fixed))))
    np.testing.assert_allclose(
        place(result.take, LEFT)[50:60], fixed[None].repeat(10, 0), atol=1e-3
    )

    rail = Line(tuple(start), (0.0, 0.0, 2.0))
    after = place(clean(walk, contact(LEFT, 50, 60, rail)).take, LEFT)[50:60]
    np.testing.assert_allclose(after[:, :2], start[None, :2].repeat(10, 0), atol=1e-3)
    # Along the rail it goes on as it did.
    assert np.ptp(after[:, 2]) > 0.5 * np.ptp(place(walk, LEFT)[50:60, 2])

    partner = elsewhere(walk, 0.0, (0.01, 0.0, 0.0))
    follow = Following("partner", "LeftFoot", tuple(SOLE))
    result = clean(walk, contact(LEFT, 50, 60, follow), others={"partner": partner})
    wanted = place(partner, LEFT)[50:60]
    np.testing.assert_allclose(place(result.take, LEFT)[50:60], wanted, atol=1e-3)


def test_heel_rolls_to_toe_without_a_jump(walk):
    heel = ContactPoint("LeftFoot", "heel", np.array([0.0, -0.05, -0.05]))
    toe = ContactPoint("LeftFoot", "toe", np.array([0.0, -0.05, 0.15]))
    height = float(place(walk, heel)[:, 1].min())
    roll = (
        contact(heel, 30, 55, Floor(height), "heel"),
        contact(LEFT, 45, 80, Floor(height), "ball"),
        contact(toe, 60, 95, Floor(height), "toe"),
    )
    result = clean(walk, *roll, points=(heel, LEFT, toe))
    for point, start, end in ((heel, 30, 55), (LEFT, 45, 80), (toe, 60, 95)):
        steps = np.linalg.norm(np.diff(place(result.take, point)[start:end], axis=0), axis=1)
        assert steps.max() < 1e-3
    speed = np.linalg.norm(np.diff(take_pose(result.take)[0], axis=0), axis=2)
    before = np.linalg.norm(np.diff(take_pose(walk)[0], axis=0), axis=2)
    assert speed.max() < before.max() + 0.01


def test_contacts_that_take_turns_agree(walk):
    """Where one point of a foot is let go and another is held, the foot does not jump."""
    toe = ContactPoint("LeftFoot", "toe", np.array([0.0, -0.05, 0.15]))
    height = float(place(walk, LEFT)[:, 1].min())
    turns = (
        contact(LEFT, 30, 60, Floor(height), "ball"),
        contact(toe, 60, 90, Floor(height), "toe"),
    )
    result = clean(walk, *turns, points=(LEFT, toe))
    away = place(result.take, LEFT) - place(walk, LEFT)
    steps = np.linalg.norm(np.diff(away, axis=0), axis=1)
    assert steps[58:62].max() < 2.0 * steps[45:58].max() + 1e-3


def test_a_contact_of_one_frame(walk):
    spot = place(walk, LEFT)[40] + np.array([0.0, 0.02, 0.0])
    result = clean(walk, contact(LEFT, 40, 41, Fixed(tuple(spot))))
    np.testing.assert_allclose(place(result.take, LEFT)[40], spot, atol=1e-3)
    assert result.unreached == ()
    assert result.slide.before == result.slide.after == 0.0


def test_out_of_reach_gives_the_nearest_pose_and_says_so(walk):
    spot = np.array([3.0, 0.5, 0.0])
    result = clean(walk, contact(LEFT, 60, 70, Fixed(tuple(spot)), "far"))
    (missed,) = result.unreached
    assert (missed.contact, missed.frames) == ("far", 10)
    positions = take_pose(result.take)[0]
    hip, foot = (walk.skeleton.index[n] for n in ("LeftUpLeg", "LeftFoot"))
    # The whole leg points at the target, as far as it goes.
    reach = np.linalg.norm(positions[60:70, foot] - positions[60:70, hip], axis=1)
    assert reach.min() > 0.8
    got = np.linalg.norm(place(result.take, LEFT)[60:70] - spot, axis=1)
    assert missed.millimetres == pytest.approx(1e3 * got.max(), rel=1e-6)
    assert got.max() < np.linalg.norm(place(walk, LEFT)[60:70] - spot, axis=1).min()
    assert result.moved <= 0.06 * 0.86 + 1e-9


def test_contradicting_contacts_are_met_halfway_and_named(walk):
    start = place(walk, LEFT)[60]
    apart = np.array([0.04, 0.0, 0.0])
    result = clean(
        walk,
        contact(LEFT, 55, 65, Fixed(tuple(start + apart)), "one"),
        contact(LEFT, 55, 65, Fixed(tuple(start - apart)), "other"),
    )
    assert {missed.contact for missed in result.unreached} == {"one", "other"}
    np.testing.assert_allclose(place(result.take, LEFT)[58:62], start[None].repeat(4, 0), atol=5e-3)


def test_a_chain_of_bones_without_length():
    skeleton = build([("root", "", (0, 0, 0)), ("a", "root", (0, 0, 0)), ("b", "a", (0, 0, 0))])
    still = np.tile(rot.IDENTITY, (20, 3, 1))
    take = Take("point", skeleton, still, np.zeros((20, 1, 3)), Fraction(30))
    target = Fixed((0.5, 0.0, 0.0))
    result = run(foot_skate.clean(take, [Contact("c", "b", None, 5, 10, target)], ()))
    (missed,) = result.unreached
    assert missed.millimetres > 400
    assert np.isfinite(result.take.translations).all()


def test_a_joint_without_children_and_without_a_point(walk):
    joint = walk.skeleton.index["RightHand"]
    before = take_pose(walk)[0][60, joint]
    target = Fixed(tuple(before + np.array([-0.02, -0.03, 0.02])))
    result = run(foot_skate.clean(walk, [Contact("c", "RightHand", None, 60, 62, target)], ()))
    after = take_pose(result.take)[0][60:62, joint]
    np.testing.assert_allclose(after, np.tile(target.position, (2, 1)), atol=1e-3)


def test_a_body_below_a_turned_reference(walk):
    hung = below_a_reference(walk, rot.about_axis(0, np.float64(0.7)))
    spot = place(walk, LEFT)[60] + np.array([0.01, 0.01, 0.0])
    result = clean(hung, contact(LEFT, 60, 70, Fixed(tuple(spot))))
    np.testing.assert_allclose(place(result.take, LEFT)[60:70], spot[None].repeat(10, 0), atol=1e-3)
    assert "Reference" not in {one.row for one in result.declared}


def test_frames_outside_the_trim_stay(walk):
    trimmed = replace(walk, trim=(20, 160))
    result = clean(trimmed, contact(LEFT, 22, 60, Floor(0.05)))
    np.testing.assert_array_equal(result.take.rotations[:20], walk.rotations[:20])
    assert min(one.start for one in result.declared) >= 20


def test_no_contacts_change_nothing(walk):
    result = clean(walk)
    np.testing.assert_array_equal(result.take.rotations, walk.rotations)
    assert result.declared == ()


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        (Contact("c", "Elbow", None, 0, 5, Floor(0.0)), "no joint Elbow"),
        (Contact("c", "LeftFoot", "heel", 0, 5, Floor(0.0)), "no point heel"),
        (Contact("c", "LeftFoot", "ball", 5, 5, Floor(0.0)), "frames 5 to 5"),
        (Contact("c", "LeftFoot", "ball", 170, 181, Floor(0.0)), "frames 170 to 181"),
        (Contact("c", "LeftFoot", "ball", 0, 5, Following("x", "Hips")), "no performer x"),
        (Contact("c", "LeftFoot", "ball", 0, 5, Line((0, 0, 0), (0, 0, 0))), "no length"),
    ],
)  # fmt: skip
def test_bad_contacts_are_told(walk, bad, message):
    with pytest.raises(MocapError, match=message):
        clean(walk, bad)


@pytest.mark.parametrize("metres", [0.3, 5.0])
def test_what_a_hand_cannot_reach_pulls_no_foot_off_the_floor(walk, metres):
    palm = ContactPoint("LeftHand", "palm", np.array([0.0, 0.0, 0.0]))
    points = (*POINTS, palm)
    feet = [
        contact(point, 40, 100, Floor(float(place(walk, point)[:, 1].mean())), point.joint)
        for point in POINTS
    ]
    alone = clean(walk, *feet, points=points)
    assert alone.unreached == ()
    # Straight up: the legs are stretched before the hips have gone as far as they may.
    shoulder = take_pose(walk)[0][70, walk.skeleton.index["LeftArm"]]
    spot = shoulder + np.array([0.0, 0.55 + metres, 0.0])
    hand = contact(palm, 60, 80, Fixed(tuple(spot)), "far")
    result = clean(walk, *feet, hand, points=points)
    (missed,) = result.unreached
    assert missed.contact == "far"
    away = np.linalg.norm(place(result.take, palm)[60:80] - spot, axis=1)
    assert missed.millimetres == pytest.approx(1e3 * away.max(), rel=1e-6)
    for point, one in zip(POINTS, feet, strict=True):
        stood = place(result.take, point)[40:100]
        assert np.abs(stood - np.median(stood, axis=0)).max() < 5e-4
        assert abs(stood[:, 1].mean() - one.target.height) < 5e-4
    # The body leans for it as far as it can: nearer than an arm alone would get.
    assert result.moved > 0.02
