from __future__ import annotations

import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from mocapstudio import formats
from mocapstudio.formats import ReadOptions, WriteOptions
from mocapstudio.motion.errors import FileError, MocapError
from mocapstudio.motion.kinematics import end_positions, take_pose
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

UNIT = 0.0254 / 0.45

NAMESAKES = {
    "root": "Hips",
    "lowerback": "LowerBack",
    "upperback": "Spine",
    "thorax": "Spine1",
    "lowerneck": "Neck",
    "upperneck": "Neck1",
    "head": "Head",
    **{
        amc.format(short): bvh.format(long)
        for short, long in (("l", "Left"), ("r", "Right"))
        for amc, bvh in {
            "{}femur": "{}UpLeg",
            "{}tibia": "{}Leg",
            "{}foot": "{}Foot",
            "{}toes": "{}ToeBase",
            "{}clavicle": "{}Shoulder",
            "{}humerus": "{}Arm",
            "{}radius": "{}ForeArm",
            "{}wrist": "{}Hand",
        }.items()
    },
}

# Computed points of the C3D: each the end of a bone, where the next joint is.
BONE_ENDS = {
    "PEL0": "root",
    "LBK0": "upperback",
    "UBK0": "thorax",
    "TRX0": "lowerneck",
    "LNK0": "upperneck",
    "UNK0": "head",
    **{
        f"{side}{point}": f"{side.lower()}{joint}"
        for side in "LR"
        for point, joint in {
            "HJ0": "femur",
            "FE0": "tibia",
            "TI0": "foot",
            "CL0": "humerus",
            "HU0": "radius",
            "RA0": "wrist",
            "WR0": "hand",
            "HN0": "fingers",
        }.items()
    },
}

UNITS_PART = ":units\n  mass 1.0\n  length 0.45\n  angle deg\n"
ROOT_PART = """:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
"""
BONES_PART = """:bonedata
  begin
    id 1
    name lfemur   # the thigh
    direction 0 -1 0
    length 8
    axis 0 0 20 XYZ
    dof rx ry rz
    limits (-160.0 20.0)
           (-70.0 70.0)
           (-60.0 70.0)
  end
  begin
    id 2
    name lpatella
    direction 0 -1 0
    length 1
    axis 10 20 30 XYZ
  end
  begin
    id 3
    name ltibia
    direction 0 -1 0
    length 7
    axis 30 0 20 XYZ
    dof rz rx
    limits (-10.0 170.0)
           (-10.0 170.0)
  end
"""
TREE_PART = """:hierarchy
  begin
    root lfemur
    lfemur lpatella
    lpatella ltibia
  end
"""
HEAD = "# leg\n:version 1.10\n:name leg\n:documentation\n  bones : and words\n"
ASF = HEAD + UNITS_PART + ROOT_PART + BONES_PART + TREE_PART
KEYWORDS = ":FULLY-SPECIFIED\n:DEGREES\n"


def frame(number: int, turn: float = 0.0) -> str:
    return f"{number}\nroot {turn} 17 2 {turn} 20 30\nlfemur 10 {turn} 30\nltibia {turn / 2} 40\n"


FRAMES = "".join(frame(n, n / 4) for n in range(1, 9))


@pytest.fixture
def leg(tmp_path: Path) -> Path:
    (tmp_path / "07.asf").write_text(ASF)
    path = tmp_path / "07_01.amc"
    path.write_text(KEYWORDS + FRAMES)
    return path


def read(path: Path, options: ReadOptions | None = None) -> Take:
    (take,), _ = formats.read(path, options)
    return take


def positions(take: Take) -> NDArray[np.float64]:
    return take_pose(take)[0]


def mentions(path: Path, options: ReadOptions | None = None) -> dict[str, bool]:
    _, report = formats.read(path, options)
    return {f"{p.what}: {p.done}": p.guess for p in report.problems}


# Against other files of the same takes.


@pytest.mark.parametrize("name", ["05_13", "02_01"])
def test_joints_are_where_the_bvh_of_the_same_take_has_them(data: Path, name: str) -> None:
    folder = data / "cmu_same_take_3_formats"
    amc = read(folder / f"{name}.amc")
    bvh = read(folder / f"{name}.bvh", ReadOptions(unit=UNIT, up="y"))
    assert bvh.frames == amc.frames + 1
    index, places = amc.skeleton.index, positions(amc)
    # These BVH were converted without the bone of the thorax: neck and shoulders stand at its
    # start. The C3D of the take, below, has it as the AMC does.
    thorax = places[:, index["lowerneck"]] - places[:, index["thorax"]]
    assert not bvh.skeleton.offsets[bvh.skeleton.index["LeftShoulder"]].any()
    places[:, amc.skeleton.descendants(index["thorax"])[1:]] -= thorax[:, None]
    of_amc = places[:, [index[n] for n in NAMESAKES]]
    of_bvh = positions(bvh)[1:, [bvh.skeleton.index[n] for n in NAMESAKES.values()]]
    assert np.linalg.norm(of_amc - of_bvh, axis=-1).max() < 0.001


def test_bones_end_where_the_c3d_of_the_same_take_has_them(data: Path) -> None:
    ezc3d = pytest.importorskip("ezc3d")
    folder = data / "cmu_same_take_3_formats"
    amc = read(folder / "05_13.amc")
    c3d = ezc3d.c3d(str(folder / "05_13.c3d"))
    labels = [one.split(":")[-1] for one in c3d["parameters"]["POINT"]["LABELS"]["value"]]
    z_up = c3d["data"]["points"][:3].transpose(2, 1, 0) / 1000
    of_c3d = z_up[:, [labels.index(label) for label in BONE_ENDS], :][..., [1, 2, 0]]
    of_amc = positions(amc)[:, [amc.skeleton.index[n] for n in BONE_ENDS.values()]]
    assert np.linalg.norm(of_amc - of_c3d, axis=-1).max() < 0.001


@pytest.mark.parametrize("name", ["05_13", "02_01"])
def test_arms_legs_and_head_are_found(data: Path, name: str) -> None:
    skeleton = read(data / "cmu_same_take_3_formats" / f"{name}.amc").skeleton
    limbs = {one.name: [skeleton.names[j] for j in one.joints] for one in topology(skeleton).limbs}
    assert limbs["spine"] == ["root", "lowerback", "upperback", "thorax"]
    assert limbs["head"] == ["lowerneck", "upperneck", "head"]
    for side in ("left", "right"):
        assert limbs[f"{side} arm"][1:3] == [f"{side[0]}humerus", f"{side[0]}radius"]
        assert limbs[f"{side} leg"][1:4] == [side[0] + n for n in ("femur", "tibia", "foot")]


def test_every_amc_has_the_frames_that_its_readme_states(data: Path) -> None:
    folder = data / "cmu_asfamc"
    stated = re.findall(r"^\| (\S+\.amc) \| (\d+) \|", (folder / "README.md").read_text(), re.M)
    assert len(stated) == 4
    for name, frames in stated:
        take = read(folder / name)
        assert (name, take.frames, take.rate) == (name, int(frames), 120)
        assert len(take.skeleton) == 31
        assert take.first_frame == 1


def test_an_amc_is_written_as_bvh(data: Path, tmp_path: Path) -> None:
    take = read(data / "cmu_same_take_3_formats" / "02_01.amc")
    path = tmp_path / "walk.bvh"
    formats.write(take, path, options=WriteOptions(unit=UNIT))
    back = read(path, ReadOptions(unit=UNIT, up="y", trim_start=False))
    assert back.skeleton.names == take.skeleton.names
    assert back.rate == take.rate
    np.testing.assert_allclose(positions(back), positions(take), atol=1e-4)


# What the numbers mean.


def test_bones_turn_within_their_own_axes(leg: Path) -> None:
    take = read(leg)
    assert take.skeleton.names == ("root", "lfemur", "lpatella", "ltibia")
    turn = 8 / 4

    def turned(order: str, *degrees: float) -> Rotation:
        # scipy's lower case letters: about fixed axes, the first letter first.
        return Rotation.from_euler(order, degrees, degrees=True)

    def within(axis: Rotation, own: Rotation) -> Rotation:
        return axis * own * axis.inv()

    root = turned("xyz", turn, 20, 30)
    thigh = root * within(turned("z", 20), turned("xyz", 10, turn, 30))
    shank = thigh * within(turned("xyz", 30, 0, 20), turned("xz", 40, turn / 2))
    hip = np.array([turn, 17, 2])
    knee = hip + thigh.apply([0, -8, 0])
    below = knee + thigh.apply([0, -1, 0])
    foot = below + shank.apply([0, -7, 0])
    places, world = take_pose(take)
    np.testing.assert_allclose(places[-1], np.array([hip, hip, knee, below]) * UNIT, atol=1e-12)
    tips = end_positions(take.skeleton, places, world)
    np.testing.assert_allclose(tips[-1], [foot * UNIT], atol=1e-12)


@pytest.mark.parametrize("order", ["XYZ", "ZYX", "YXZ"])
def test_the_axis_string_orders_the_rotations(leg: Path, order: str) -> None:
    text = ASF.replace("axis XYZ", f"axis {order}")
    leg.with_name("07.asf").write_text(text)
    values = {"X": 2.0, "Y": 20.0, "Z": 30.0}
    expected = Rotation.from_euler(order.lower(), [values[a] for a in order], degrees=True)
    found = Rotation.from_quat(read(leg).rotations[-1, 0])
    assert (found * expected.inv()).magnitude() < 1e-12


def test_sections_may_come_in_any_order(leg: Path) -> None:
    expected = positions(read(leg))
    leg.with_name("07.asf").write_text(TREE_PART + BONES_PART + ROOT_PART + UNITS_PART + HEAD)
    np.testing.assert_array_equal(positions(read(leg)), expected)


def test_the_order_of_the_roots_values_is_the_files(leg: Path) -> None:
    expected = positions(read(leg))
    text = ASF.replace("TX TY TZ RX RY RZ", "RZ RY RX TX TY TZ")
    leg.with_name("07.asf").write_text(text)
    swapped = re.sub(r"root (\S+) 17 2 (\S+) 20 30", r"root 30 20 \2 \1 17 2", KEYWORDS + FRAMES)
    leg.write_text(swapped)
    np.testing.assert_allclose(positions(read(leg)), expected, atol=1e-12)


def test_angles_are_degrees_or_radians_or_guessed(leg: Path) -> None:
    expected = positions(read(leg))

    def radians(match: re.Match[str]) -> str:
        name, *values = match[0].split()
        kept = 3 if name == "root" else 0
        return " ".join(
            [name, *values[:kept], *(repr(np.radians(float(v)).item()) for v in values[kept:])]
        )

    frames = re.sub(r"(?m)^[a-z].*$", radians, FRAMES)
    leg.write_text(":RADIANS\n" + frames)
    np.testing.assert_allclose(positions(read(leg)), expected, atol=1e-12)
    leg.write_text(FRAMES)
    np.testing.assert_array_equal(positions(read(leg)), expected)
    leg.with_name("07.asf").write_text(ASF.replace("  angle deg\n", ""))
    np.testing.assert_array_equal(positions(read(leg)), expected)
    assert mentions(leg)["no unit of angles stated: guessed degrees"]


def test_length_scale_and_its_override(leg: Path) -> None:
    thigh = np.linalg.norm(read(leg).skeleton.offsets[2])
    assert thigh == pytest.approx(8 * UNIT)
    assert mentions(leg)[
        "length scale 0.45 in 07.asf: guessed 1 unit = 0.05644 m (inches over the scale)"
    ]
    assert np.linalg.norm(read(leg, ReadOptions(unit=0.1)).skeleton.offsets[2]) == 0.8


def test_the_rate_is_asked_for_or_a_stated_guess(leg: Path) -> None:
    assert read(leg).rate == 120
    assert mentions(leg)["no frame rate stated: guessed 120 frames a second"]
    sixty = ReadOptions(fps=Fraction(60))
    assert read(leg, sixty).rate == 60
    assert not any("frame rate" in text for text in mentions(leg, sixty))
    leg.write_text(":SAMPLES-PER-SECOND 30\n" + KEYWORDS + FRAMES)
    assert read(leg).rate == 30


def test_bytes_that_are_not_utf8_are_read_as_latin_1(leg: Path) -> None:
    asf = ASF.replace("ltibia", "ljambé").replace("# leg", "# Jürgen")
    leg.with_name("07.asf").write_bytes(asf.encode("latin-1"))
    leg.write_bytes((KEYWORDS + FRAMES).replace("ltibia", "ljambé").encode("latin-1"))
    assert read(leg).skeleton.names[-1] == "ljambé"
    said = mentions(leg)
    assert "bytes that are not UTF-8 in 07.asf: read as Latin-1" in said
    assert "bytes that are not UTF-8 in 07_01.amc: read as Latin-1" in said


@pytest.mark.parametrize("newline", ["\r\n", "\r"])
def test_newlines_and_comments(leg: Path, newline: str) -> None:
    expected = positions(read(leg))
    text = "#!OML:ASF C:\\leg.ASF\n" + KEYWORDS + FRAMES.replace("lfemur", "# note\nlfemur")
    leg.write_bytes(text.replace("\n", newline).encode())
    leg.with_name("07.asf").write_bytes(ASF.replace("\n", newline).encode())
    np.testing.assert_array_equal(positions(read(leg)), expected)


def test_bones_may_change_places_between_frames(leg: Path) -> None:
    expected = positions(read(leg))
    lines = (KEYWORDS + FRAMES).splitlines()
    lines[-2:] = lines[:-3:-1]
    leg.write_text("\n".join(lines))
    np.testing.assert_array_equal(positions(read(leg)), expected)


# Which skeleton.


def test_the_skeleton_is_found_by_name(leg: Path) -> None:
    beside = leg.with_name("08.asf")
    beside.write_text(ASF.replace("length 8", "length 9"))
    assert np.linalg.norm(read(leg).skeleton.offsets[2]) == pytest.approx(8 * UNIT)
    leg.with_name("07_01.ASF").write_text(ASF.replace("length 8", "length 5"))
    assert np.linalg.norm(read(leg).skeleton.offsets[2]) == pytest.approx(5 * UNIT)


def test_the_only_skeleton_is_the_right_one(leg: Path) -> None:
    take = read(leg.rename(leg.with_name("walk.amc")))
    assert take.name == "walk"


def test_no_skeleton_and_several(leg: Path) -> None:
    walk = leg.rename(leg.with_name("walk.amc"))
    leg.with_name("08.asf").write_text(ASF)
    with pytest.raises(FileError, match=r"walk\.amc.*several skeletons.*07\.asf, 08\.asf"):
        formats.read(walk)
    for name in ("07.asf", "08.asf"):
        leg.with_name(name).unlink()
    with pytest.raises(FileError, match=r"walk\.amc.*no skeleton"):
        formats.read(walk)


# What is refused, and where.


@pytest.mark.parametrize(
    ("old", "new", "line", "cause"),
    [
        ("lfemur 10 0.5 30", "lfemur 10 ten 30", 9, "'ten' is not a number"),
        ("lfemur 10 0.5 30", "lfemur 10 nan 30", 9, "'nan' instead of a number"),
        ("lfemur 10 0.5 30", "lfemur 10 1_0 30", 9, "'1_0' is not a number"),
        ("lfemur 10 0.5 30", "lfemur 10 1e99 30", 9, "too large"),
        ("lfemur 10 0.5 30", "lfemur 10 0.5", 9, "lfemur has 2 values, its skeleton 3"),
        ("lfemur 10 0.5 30", "lfemur 10 0.5 30 1", 9, "lfemur has 4 values"),
        ("lfemur 10 0.5 30", "", 7, "frame 2 lacks lfemur"),
        ("lfemur 10 0.5 30", "rfemur 10 0.5 30", 9, "'rfemur' is no bone"),
        ("lfemur 10 0.5 30", "ltibia 1 2", 10, "ltibia is twice in frame 2"),
        ("\n5\n", "\n6\n", 19, "frame 6 follows frame 4"),
        ("ltibia 1.0 40\n", "ltibia 1.0", 34, "cut off: frame 8 lacks ltibia"),
        (frame(8, 2.0), "8\nroot 2 17", 32, "cut off: frame 8 lacks root, lfemur, ltibia"),
        (KEYWORDS + FRAMES, KEYWORDS, None, "no line holds a frame number"),
        (KEYWORDS, "HIERARCHY\n", 1, "not AMC"),
    ],
)
def test_wrong_motion(leg: Path, old: str, new: str, line: int | None, cause: str) -> None:
    text = KEYWORDS + FRAMES
    assert old in text
    leg.write_text(text.replace(old, new))
    with pytest.raises(FileError, match=re.escape(cause)) as raised:
        formats.read(leg)
    assert (raised.value.path, raised.value.line) == (leg, line)


def test_a_cut_off_frame_may_be_left_out(leg: Path) -> None:
    leg.write_text((KEYWORDS + FRAMES)[:-12])
    take = read(leg, ReadOptions(lenient=True))
    assert take.frames == 7
    assert "frame 8 is cut off: left out" in mentions(leg, ReadOptions(lenient=True))


@pytest.mark.parametrize(
    ("old", "new", "where", "cause"),
    [
        ("length 8", "length eight", "length eight", "'eight' is not a number"),
        ("length 8", "length -8", "length -8", "negative length"),
        ("direction 0 -1 0", "direction 0 -1", "direction 0 -1\n", "direction needs 3 values"),
        ("axis 0 0 20 XYZ", "axis 0 0 20 XXZ", "axis 0 0 20", "no order of the axes"),
        ("dof rz rx", "dof rz rz", "dof rz", "a degree of freedom repeats"),
        ("dof rz rx", "dof rz rw", "dof rz rw", "'rw' is no degree of freedom"),
        ("name ltibia", "name lfemur", "begin\n    id 3", "bone lfemur repeats"),
        ("root lfemur", "root rfemur", "root rfemur", "names 'rfemur', no bone"),
        ("lpatella ltibia", "lpatella lfemur", "lpatella lfemur", "lfemur has two places"),
        ("length 0.45", "length 0", "length 0\n", "not a length scale"),
        ("angle deg", "angle gon", "angle gon", "deg or rad"),
        (":hierarchy", ":tree", None, "no section :hierarchy"),
        ("# leg", "leg", "leg", "not ASF"),
    ],
)
def test_wrong_skeleton(leg: Path, old: str, new: str, where: str | None, cause: str) -> None:
    text = ASF.replace(old, new)
    assert text != ASF
    asf = leg.with_name("07.asf")
    asf.write_text(text)
    line = None if where is None else 1 + text[: text.index(where)].count("\n")
    with pytest.raises(FileError, match=re.escape(cause)) as raised:
        formats.read(leg)
    assert (raised.value.path, raised.value.line) == (asf, line)


def test_a_bone_outside_the_hierarchy_is_left_out(leg: Path) -> None:
    leg.with_name("07.asf").write_text(ASF.replace("    lpatella ltibia\n", ""))
    assert read(leg).skeleton.names == ("root", "lfemur", "lpatella")
    assert "bone ltibia is not in the hierarchy of 07.asf: left out" in mentions(leg)


def test_mutated_files_are_read_or_refused(leg: Path) -> None:
    rng = np.random.default_rng(20)
    files = {leg: leg.read_bytes(), leg.with_name("07.asf"): ASF.encode()}
    outcomes = {"read": 0, "refused": 0}
    for round_ in range(200):
        path = list(files)[round_ % 2]
        path.write_bytes(mutated(files[path], rng))
        try:
            takes, _ = formats.read(path if path.suffix == ".amc" else leg)
            assert np.isfinite(positions(takes[0])).all()
            outcomes["read"] += 1
        except MocapError as refusal:
            assert "\n" not in str(refusal)
            outcomes["refused"] += 1
        path.write_bytes(files[path])
    assert min(outcomes.values()) > 20


def mutated(data: bytes, rng: np.random.Generator) -> bytes:
    a, b = sorted(rng.integers(0, len(data), 2))
    odd = [b"\xff", b"\0", b"nan", b"-", b"1e999", b"\n", b":", b"9" * 5000, b"begin", b" ", b"#"]
    match rng.integers(6):
        case 0:
            return data[:a]
        case 1:
            return data[:a] + data[min(b, a + 30) :]
        case 2:
            return data[:a] + odd[rng.integers(len(odd))] + data[a:]
        case 3:
            return data[:a] + bytes(rng.integers(0, 256, 3).tolist()) + data[a + 3 :]
        case 4:
            return data[:b] + data[a:b] + data[b:]
        case _:
            return data[:a] + bytes([data[a] ^ (1 << int(rng.integers(8)))]) + data[a + 1 :]
