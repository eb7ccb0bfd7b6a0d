"""BVH as it is met in the wild: one oddity a test, each with what the report must say."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from bvh_text import COLUMNS, HEADER, HEADER_LINES, JOINTS, bvh, walk
from scipy.spatial.transform import Rotation

from mocapstudio import formats
from mocapstudio.formats import ReadOptions, bvh_motion
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take


@pytest.fixture(params=["plain parser", "compiled parser"])
def read(tmp_path: Path, request, monkeypatch: pytest.MonkeyPatch):
    if request.param == "compiled parser":
        monkeypatch.setattr(bvh_motion, "KERNEL_FROM_BYTES", 0)

    def reader(text: str | bytes, **options) -> tuple[list[Take], list[formats.Problem]]:
        path = tmp_path / "take.bvh"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        takes, report = formats.read(path, ReadOptions(**options))
        return takes, [problem for problem in report.problems if not problem.guess]

    return reader


def same(take: Take, other: Take) -> None:
    np.testing.assert_array_equal(take.rotations, other.rotations)
    np.testing.assert_array_equal(take.translations, other.translations)
    assert take.rate == other.rate


def test_a_plain_file(read) -> None:
    rows = walk()
    (take,), problems = read(bvh(rows))
    assert problems == []
    assert take.skeleton.names == JOINTS
    assert take.rate == 30
    assert take.frames == 30
    assert len(take.skeleton.end_parents) == 3
    np.testing.assert_allclose(take.translations[:, 0], np.round(rows[:, :3], 6) * 0.01)


def test_every_joint_turns_in_its_own_euler_order(read) -> None:
    rows = walk()
    (take,), _ = read(bvh(rows))
    orders = ["ZXY", "ZXY", "XYZ", "ZYX", "YZX", "YXZ", "XZY", "ZXY", "ZXY"]
    for joint, order in enumerate(orders):
        angles = np.round(rows[:, 3 + 3 * joint : 6 + 3 * joint], 6)
        expected = Rotation.from_euler(order, angles, degrees=True)
        ours = Rotation.from_quat(take.rotations[:, joint])
        assert (expected * ours.inv()).magnitude().max() < 1e-12


@pytest.mark.parametrize("order", ["X", "ZY", "XYX", ""])
def test_fewer_rotation_channels(read, order: str) -> None:
    words = " ".join(f"{letter}rotation" for letter in order)
    header = HEADER.replace(
        "\t\tOFFSET 0.0 20.0 0.0\n\t\tCHANNELS 3 Zrotation Xrotation Yrotation",
        f"\t\tOFFSET 0.0 20.0 0.0\n\t\tCHANNELS {len(order)} {words}",
    )
    rows = walk(columns=COLUMNS - 3 + len(order))
    (take,), _ = read(bvh(rows, header))
    spine = take.skeleton.index["Spine"]
    ours = Rotation.from_quat(take.rotations[:, spine])
    expected = Rotation.identity(len(rows))
    for i, letter in enumerate(order):
        turn = Rotation.from_euler(letter, np.round(rows[:, [24 + i]], 6), degrees=True)
        expected = expected * turn
    assert (expected * ours.inv()).magnitude().max() < 1e-12


@pytest.mark.parametrize(
    ("what", "change"),
    [
        ("carriage return and newline", lambda t: t.replace("\n", "\r\n")),
        ("lone carriage returns", lambda t: t.replace("\n", "\r")),
        ("tabs between values", lambda t: t.replace(" ", "\t")),
        ("channel names in lower case", lambda t: t.replace("rotation", "ROTATION")),
        ("keywords in lower case", lambda t: t.replace("JOINT", "joint").replace("ROOT", "Root")),
        ("end sites in another case", lambda t: t.replace("End Site", "END SITE")),
        ("end sites with names", lambda t: t.replace("End Site", "End Site tip.of it")),
        ("brace on the joint's line", lambda t: t.replace("\n\t\t{", " {")),
        ("blank lines before the rows", lambda t: t.replace("0.0333333\n", "0.0333333\n\n \n")),
        ("blank lines between rows", lambda t: t.replace("\n0", "\n\n0").replace("\n-", "\n\n-")),
        ("no newline at the end", lambda t: t.rstrip("\n")),
        ("no colons", lambda t: t.replace("Frames:", "Frames").replace("Time:", "Time")),
        ("spaces around rows", lambda t: t.replace("\n", " \n ")),
        ("a fraction of frames", lambda t: t.replace("Frames: 30", "Frames: 30.0")),
    ],
)
def test_harmless_dialects_read_the_same(read, what: str, change) -> None:
    text = bvh(walk())
    changed = change(text)
    assert changed != text
    (plain,), _ = read(text)
    (take,), problems = read(changed)
    same(take, plain)
    assert take.skeleton.names == plain.skeleton.names
    assert problems == [], what


def test_leaves_without_end_site(read) -> None:
    start = HEADER.index("\t\t\t\tEnd Site")
    end = HEADER.index("\n\t\t\t}", start) + 1
    header = HEADER[:start] + HEADER[end:]
    (take,), problems = read(bvh(walk(), header))
    assert problems == []
    assert len(take.skeleton.end_parents) == 2
    assert not take.skeleton.children[take.skeleton.index["LeftFoot"]]


def test_names_keep_colons_dots_spaces_and_other_scripts(read) -> None:
    names = {"Spine": "mixamo:Spine.001 end", "Head": "Kopf Ä头", "LeftFoot": "EndSite"}
    header = HEADER
    for name, other in names.items():
        header = header.replace(f"JOINT {name}\n", f"JOINT {other}\n")
    (take,), problems = read(bvh(walk(), header))
    assert set(names.values()) <= set(take.skeleton.names)
    assert problems == []


def test_repeated_names_are_numbered(read) -> None:
    header = HEADER.replace("RightUpLeg", "LeftUpLeg").replace("RightLeg", "LeftUpLeg")
    (take,), problems = read(bvh(walk(), header))
    assert [n for n in take.skeleton.names if "UpLeg" in n] == [
        *("LeftUpLeg", "LeftUpLeg#2", "LeftUpLeg#3"),
    ]
    assert [p.done for p in problems] == ["named LeftUpLeg#2", "named LeftUpLeg#3"]
    assert all(HEADER.splitlines()[p.line - 1].strip().startswith("JOINT") for p in problems)


def test_byte_order_mark_and_latin_1(read) -> None:
    text = b"\xef\xbb\xbf" + bvh(walk()).replace("Spine", "R\xfccken").encode("latin-1")
    (take,), problems = read(text)
    assert "Rücken" in take.skeleton.names
    assert [p.line for p in problems] == [1, 1 + HEADER[: HEADER.index("Spine")].count("\n")]


def test_exponents_are_numbers(read) -> None:
    rows = walk()
    body = "".join(" ".join(f"{cell:.12e}" for cell in row) + "\n" for row in rows)
    head = bvh(rows).partition("0.0333333\n")[0] + "3.33333E-2\n"
    (take,), problems = read(head + body.replace("e+00", "E0"))
    np.testing.assert_allclose(take.translations[:, 0], rows[:, :3] * 0.01, atol=1e-12)
    assert take.rate == 30
    assert problems == []


def test_decimal_commas(read) -> None:
    text = bvh(walk())
    head, rate, body = text.partition("0.0333333\n")
    (plain,), _ = read(text)
    (take,), problems = read(head + rate + body.replace(".", ","))
    same(take, plain)
    assert [p.what for p in problems] == ["decimal commas"]


def test_commas_between_values(read) -> None:
    text = bvh(walk())
    head, rate, body = text.partition("0.0333333\n")
    (plain,), _ = read(text)
    (take,), problems = read(head + rate + body.replace(" ", ", "))
    same(take, plain)
    assert "separated by commas" in problems[0].what


def test_fused_numbers_are_told_apart_by_their_signs(read) -> None:
    text = bvh(-np.abs(walk()))
    head, rate, body = text.partition("0.0333333\n")
    (plain,), _ = read(text)
    (take,), _ = read(head + rate + body.replace(" -", "-"))
    same(take, plain)


def test_rows_broken_over_lines(read) -> None:
    text = bvh(walk())
    head, rate, body = text.partition("0.0333333\n")
    broken = "".join(
        " ".join(line.split()[:7]) + "\n" + " ".join(line.split()[7:]) + "\n"
        for line in body.splitlines()
    )
    (plain,), _ = read(text)
    (take,), problems = read(head + rate + broken)
    same(take, plain)
    assert ["broken" in p.what for p in problems] == [True]


def test_text_after_the_last_row(read) -> None:
    (plain,), _ = read(bvh(walk()))
    (take,), problems = read(bvh(walk()) + "\n# exported by something\n\x1a")
    same(take, plain)
    assert [(p.line, p.what) for p in problems] == [
        (HEADER_LINES + 3 + 30 + 2, "text after the last row")
    ]


def test_several_roots_are_several_takes(read) -> None:
    rows = np.concatenate([walk(seed=1), walk(seed=2)], axis=1)
    header = HEADER + HEADER.partition("HIERARCHY\n")[2]
    takes, _ = read(bvh(rows, header))
    (one,), _ = read(bvh(rows[:, :COLUMNS]))
    (two,), _ = read(bvh(rows[:, COLUMNS:]))
    assert len(takes) == 2
    same(takes[0], one)
    same(takes[1], two)
    assert [take.source.performer for take in takes] == [0, 1]
    assert takes[0].name != takes[1].name


def test_several_motions_are_several_takes(read) -> None:
    first, second = bvh(walk(seed=1)), bvh(walk(frames=12, seed=2))
    motion = second[second.index("MOTION") :]
    for more in (motion, second):
        takes, _ = read(first + more)
        assert [take.frames for take in takes] == [30, 12]


def six_channels(rows: np.ndarray, places: dict[str, np.ndarray]) -> tuple[str, np.ndarray]:
    """Header and rows with position channels on every joint but the root."""
    columns, header_lines, name, joint = [rows[:, :6]], [], "", 0
    for line in HEADER.splitlines():
        if line.strip().startswith("JOINT"):
            name = line.split()[1]
        if "CHANNELS 3" in line:
            joint += 1
            line = line.replace("CHANNELS 3", "CHANNELS 6 Xposition Yposition Zposition")
            columns += [places[name], rows[:, 3 + 3 * joint : 6 + 3 * joint]]
        header_lines.append(line)
    return "\n".join(header_lines) + "\n", np.concatenate(columns, axis=1)


def offsets_of(take: Take) -> dict[str, np.ndarray]:
    return {n: take.skeleton.offsets[j] / 0.01 for j, n in enumerate(take.skeleton.names)}


def test_six_channels_that_repeat_the_offset_are_bones(read) -> None:
    rows = walk()
    (plain,), _ = read(bvh(rows))
    places = {n: np.tile(o, (30, 1)) for n, o in offsets_of(plain).items()}
    header, wide = six_channels(rows, places)
    (take,), _ = read(bvh(wide, header))
    assert take.translated == (0,)
    same(take, plain)
    np.testing.assert_allclose(take.skeleton.offsets, plain.skeleton.offsets)


def test_zero_offsets_with_the_lengths_in_position_channels(read) -> None:
    rows = walk()
    (plain,), _ = read(bvh(rows))
    places = {n: np.tile(o, (30, 1)) for n, o in offsets_of(plain).items()}
    header, wide = six_channels(rows, places)
    lines = header.splitlines()
    for i, line in enumerate(lines):
        if "OFFSET" in line and lines[i - 2].strip() != "End Site":
            lines[i] = "OFFSET 0 0 0"
    (take,), _ = read(bvh(wide, "\n".join(lines) + "\n"))
    np.testing.assert_allclose(take.skeleton.offsets[1:], plain.skeleton.offsets[1:])
    assert take.source.unit == 0.01


def test_position_channels_that_move_replace_the_offset(read) -> None:
    rows = walk()
    (plain,), _ = read(bvh(rows))
    places = {n: np.tile(o, (30, 1)) for n, o in offsets_of(plain).items()}
    places["Head"] = places["Head"] + np.linspace(0, 5, 30)[:, None] * [0, 1, 0]
    header, wide = six_channels(rows, places)
    (take,), _ = read(bvh(wide, header))
    head = take.skeleton.index["Head"]
    assert take.translated == (0, head)
    np.testing.assert_allclose(take.translations[:, 1], places["Head"] * 0.01, atol=1e-8)


def test_position_channels_that_are_zero_are_displacements(read) -> None:
    rows = walk()
    (plain,), _ = read(bvh(rows))
    header, wide = six_channels(rows, {n: np.zeros((30, 3)) for n in JOINTS})
    (take,), _ = read(bvh(wide, header))
    same(take, plain)
    np.testing.assert_allclose(take.skeleton.offsets, plain.skeleton.offsets)


def test_radians_when_told(read) -> None:
    rows = walk()
    (plain,), _ = read(bvh(rows))
    turned = rows.copy()
    turned[:, 3:] = np.radians(rows[:, 3:])
    (take,), _ = read(bvh(turned), angles="radians")
    np.testing.assert_allclose(take.rotations, plain.rotations, atol=1e-6)


def test_a_world_with_z_up_is_turned_at_the_root_only(read) -> None:
    rows = walk()
    rows[:, 3:6] = 0
    (plain,), _ = read(bvh(rows))
    # The same motion in a Z-up world: (x, y, z) -> (x, -z, y).
    lying = rows.copy()
    lying[:, :3] = np.stack([rows[:, 0], -rows[:, 2], rows[:, 1]], axis=-1)
    lying[:, 4] = 90
    for options in ({}, {"up": "z"}):
        (take,), _ = read(bvh(lying), **options)
        np.testing.assert_allclose(take_pose(take)[0], take_pose(plain)[0], atol=1e-6)
        np.testing.assert_array_equal(take.skeleton.offsets, plain.skeleton.offsets)
        np.testing.assert_array_equal(take.rotations[:, 1:], plain.rotations[:, 1:])


def test_the_users_word_counts_more_than_the_guess(read) -> None:
    (take,), _ = read(bvh(walk()), unit=0.0254, up="z", fps=Fraction(25))
    assert take.source.unit == 0.0254
    assert take.rate == 25
    legs = np.linalg.norm(take.skeleton.offsets[2:4], axis=1)
    np.testing.assert_allclose(legs, [42 * 0.0254, 40 * 0.0254])


def test_more_or_fewer_rows_when_lenient(read) -> None:
    text = bvh(walk())
    for stated in (29, 31, 1_000_000_000):
        (take,), problems = read(text.replace("Frames: 30", f"Frames: {stated}"), lenient=True)
        assert take.frames == 30
        assert problems[0].line == HEADER_LINES + 2
        assert str(stated) in problems[0].what


def test_a_cut_off_row_is_left_out_when_lenient(read) -> None:
    (take,), problems = read(bvh(walk())[:-50], lenient=True)
    assert take.frames == 29
    assert [p.line for p in problems] == [HEADER_LINES + 2, HEADER_LINES + 33]


@pytest.mark.parametrize(
    ("written", "rate"), [("0.0", 100), ("0", 100), ("120", 120), ("33.3333", 30), ("-0.01", 100)]
)
def test_odd_frame_times_are_guessed_and_said_to_be(tmp_path: Path, written, rate) -> None:
    path = tmp_path / "take.bvh"
    path.write_text(bvh(walk(), frame_time=written))
    (take,), report = formats.read(path)
    assert take.rate == rate
    (problem,) = [p for p in report.problems if p.override == "fps"]
    assert problem.guess
    assert problem.line == HEADER_LINES + 3
    (take,), report = formats.read(path, ReadOptions(fps=Fraction(50)))
    assert take.rate == 50
    assert not [p for p in report.problems if p.override == "fps"]


def test_a_missing_frame_time_is_guessed(tmp_path: Path) -> None:
    path = tmp_path / "take.bvh"
    path.write_text(bvh(walk()).replace("Frame Time: 0.0333333\n", ""))
    (take,), report = formats.read(path)
    assert (take.frames, take.rate) == (30, 100)
    assert any("missing" in problem.what for problem in report.problems)
