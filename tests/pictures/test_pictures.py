"""Pictures show what they are about: right size, right colours, in the right places."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.detection import detect
from mocapstudio.evaluation.demo import demo_with_errors
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.facing import ROOT_POSITION
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take
from mocapstudio.pictures import pose_picture as pose_module
from mocapstudio.pictures.curve_picture import curve_picture
from mocapstudio.pictures.map_picture import grouped_rows, map_picture, pooled
from mocapstudio.pictures.opengl import opengl_problem
from mocapstudio.pictures.pose_picture import pose_picture
from mocapstudio.pictures.stick import frame_of_change, stick
from mocapstudio.pictures.style import DARK, LIGHT, Palette, map_colours, rgb

FRAMES = slice(1400, 2200)
FLAWED = 600


@pytest.fixture(scope="module")
def take() -> Take:
    whole, _ = demo_with_errors()
    return whole.with_motion(whole.rotations[FRAMES], whole.translations[FRAMES])


@pytest.fixture(scope="module")
def raised(take: Take) -> Take:
    """The take with the left arm turned by 60 degrees."""
    rotations = take.rotations.copy()
    arm = take.skeleton.index["LeftArm"]
    turn = rot.about_axis(2, np.full(40, np.deg2rad(60.0)))
    span = slice(FLAWED, FLAWED + 40)
    rotations[span, arm] = rot.multiply(rotations[span, arm], turn)
    return take.with_motion(rotations)


@pytest.fixture(scope="module")
def analysis(take: Take) -> Analysis:
    return run(detect(take))


def pixels(png: bytes) -> np.ndarray:
    return imread(io.BytesIO(png))[..., :3]


def of_hue(image: np.ndarray, colour: str, least: float = 0.25) -> np.ndarray:
    """Which pixels lean towards a colour, whatever the light on them."""
    wanted = rgb(colour) - rgb(colour).mean()
    given = image - image.mean(axis=-1, keepdims=True)
    length = np.linalg.norm(given, axis=-1)
    alike = given @ wanted / np.maximum(length * np.linalg.norm(wanted), 1e-9)
    return (length > least) & (alike > 0.95)


@pytest.mark.parametrize("palette", [DARK, LIGHT], ids=["dark", "light"])
def test_poses_show_the_flagged_joints_on_either_side(
    take: Take, raised: Take, palette: Palette
) -> None:
    frame = FLAWED + 20
    picture = pose_picture(raised, take, frame, ["LeftArm"], size=(800, 450), palette=palette)
    image = pixels(picture.png)
    assert image.shape == (450, 800, 3)
    left, right = image[60:, :400], image[60:, 400:]
    wrong, proposal = palette.wrong, palette.proposal
    assert of_hue(left, wrong).sum() > 200
    assert of_hue(right, proposal).sum() > 200
    # The other side's version is there as a ghost only.
    assert of_hue(left, proposal).sum() < of_hue(right, proposal).sum()
    assert of_hue(right, wrong).sum() < of_hue(left, wrong).sum()
    body = np.abs(left - rgb(palette.field)).max(axis=-1) > 0.45
    columns = np.flatnonzero(body.any(axis=0))
    rows = np.flatnonzero(body.any(axis=1))
    assert rows[-1] - rows[0] > 200
    assert columns[0] > 0
    assert columns[-1] < 399


def test_one_side_only_where_there_is_no_proposal(take: Take) -> None:
    picture = pose_picture(take, None, 100, ["Head"], size=(500, 400))
    image = pixels(picture.png)
    assert image.shape == (400, 500, 3)
    assert of_hue(image, DARK.wrong).sum() > 100
    assert of_hue(image, DARK.proposal).sum() == 0


def test_without_opengl_poses_are_drawn_flat_and_say_so(
    take: Take, raised: Take, monkeypatch: pytest.MonkeyPatch
) -> None:
    rendered = pose_picture(raised, take, FLAWED + 20, ["LeftArm"], size=(800, 450))
    monkeypatch.setattr(pose_module, "opengl_problem", lambda: "no OpenGL here")
    flat = pose_picture(raised, take, FLAWED + 20, ["LeftArm"], size=(800, 450))
    assert rendered.note is None
    assert flat.note is not None
    assert "no OpenGL here" in flat.note
    # The same view: what is marked lies in the same place in both.
    both = [of_hue(pixels(p.png)[60:, :400], DARK.wrong) for p in (rendered, flat)]
    middles = [np.argwhere(one).mean(axis=0) for one in both]
    assert both[1].sum() > 200
    assert np.linalg.norm(middles[0] - middles[1]) < 25


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="hides Mesa as Linux finds it")
def test_a_machine_without_opengl_is_told_and_not_crashed_on() -> None:
    assert opengl_problem() is None
    hidden = {
        **os.environ,
        "__EGL_VENDOR_LIBRARY_DIRS": "/nowhere",
        "LIBGL_DRIVERS_PATH": "/nowhere",
    }
    hidden.pop("DISPLAY", None)
    script = "from mocapstudio.pictures.opengl import opengl_problem; print(opengl_problem())"
    ended = subprocess.run(
        [sys.executable, "-c", script], env=hidden, capture_output=True, text=True, check=True
    )
    assert "no OpenGL" in ended.stdout


def test_importing_pictures_imports_no_vtk_and_no_qt() -> None:
    script = (
        "import sys, mocapstudio.pictures.pose_picture, mocapstudio.pictures.map_picture,"
        " mocapstudio.pictures.curve_picture;"
        "print([m for m in ('pyvista', 'vtkmodules', 'PySide6', 'matplotlib.pyplot')"
        " if m in sys.modules])"
    )
    ended = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True
    )
    assert ended.stdout.strip() == "[]"


def test_the_map_shows_flags_where_they_are(analysis: Analysis) -> None:
    size = (1000, 500)
    image = pixels(map_picture(analysis, size=size).png)
    assert image.shape == (500, 1000, 3)
    order = [
        row for _, rows in grouped_rows(analysis.take.skeleton, analysis.map.rows) for row in rows
    ]
    left, right, top, bottom = 190, 1000 - 124, 64, 500 - 56
    worst = analysis.flags[0]
    x = left + (right - left) * worst.peak_frame / analysis.take.frames
    y = top + (bottom - top) * (order.index(worst.joint) + 0.5) / len(order)
    spot = image[round(y) - 3 : round(y) + 4, round(x) - 3 : round(x) + 4]
    loudest = map_colours(DARK, analysis.parameters.threshold)[-60:]
    nearest = np.linalg.norm(spot[..., None, :] - loudest, axis=-1).min(axis=-1)
    assert nearest.min() < 0.05
    quiet_row = int(np.argmin(analysis.map.values.max(axis=0)))
    name = analysis.map.rows[quiet_row]
    y = top + (bottom - top) * (order.index(name) + 0.5) / len(order)
    assert image[round(y), left + 5 : right - 5].mean() < 0.25


def test_known_errors_are_marked_above_the_map(analysis: Analysis) -> None:
    plain = pixels(map_picture(analysis, size=(1000, 500)).png)
    known = [Declared("LeftLeg", 200, 260), Declared("RightLeg", 200, 260)]
    marked = pixels(map_picture(analysis, known=known, size=(1000, 500)).png)
    added = of_hue(marked, DARK.truth) & ~of_hue(plain, DARK.truth)
    columns = np.flatnonzero(added[:64].any(axis=0))
    expected = 190 + (1000 - 190 - 124) * 230 / analysis.take.frames
    assert len(columns) > 3
    assert abs(columns.mean() - expected) < 3


def test_rows_are_grouped_by_limb_each_once(analysis: Analysis) -> None:
    groups = grouped_rows(analysis.take.skeleton, analysis.map.rows)
    rows = [row for _, inside in groups for row in inside]
    assert sorted(rows) == sorted(analysis.map.rows)
    assert groups[0] == ("root", ("root position", "root heading"))
    assert dict(groups)["left leg"] == ("LeftUpLeg", "LeftLeg", "LeftFoot", "LeftToe")


@pytest.mark.parametrize("most", [1, 7, 100, 800, 5000])
def test_pooling_keeps_the_highest_value_of_every_row(most: int) -> None:
    values = np.random.default_rng(1).random((4, 801)).astype(np.float32)
    small = pooled(values, most)
    assert small.shape == (4, min(most, 801))
    assert np.array_equal(small.max(axis=1), values.max(axis=1))


def test_map_colours_step_up_at_the_threshold() -> None:
    for palette in (DARK, LIGHT):
        colours = map_colours(palette, 0.5)
        steps = np.linalg.norm(np.diff(colours, axis=0), axis=1)
        assert int(steps.argmax()) == 127
        np.testing.assert_allclose(colours[0], rgb(palette.field), atol=1e-9)


@pytest.mark.parametrize("row", ["LeftArm", ROOT_POSITION, "root heading"])
def test_curves_show_both_versions(take: Take, raised: Take, row: str) -> None:
    moved = raised.with_motion(translations=raised.translations + 0.1)
    picture = curve_picture(moved, take, row, (FLAWED, FLAWED + 40), size=(700, 400))
    image = pixels(picture.png)
    assert image.shape == (400, 700, 3)
    inside = image[56:352, 71:680]
    assert of_hue(inside, DARK.proposal).sum() > 300
    shaded = of_hue(inside, DARK.open, 0.03)
    columns = np.flatnonzero(shaded.sum(axis=0) > 100)
    middle = 609 * (60 + 20) / 160
    assert abs(columns.mean() - middle) < 12


def test_the_frame_of_change_is_where_the_versions_differ_most(take: Take, raised: Take) -> None:
    assert FLAWED <= frame_of_change(raised, take, FLAWED - 100, FLAWED + 140) < FLAWED + 40


def test_a_joint_marks_the_bones_it_turns(take: Take) -> None:
    pose = stick(take, 0, ["LeftForeArm"])
    index = take.skeleton.index
    marked = {tuple(bone) for bone in pose.bones[pose.marked_bones]}
    assert marked == {(index["LeftForeArm"], index["LeftHand"])}
    assert stick(take, 0, [ROOT_POSITION]).marked_bones.all()
    assert not stick(take, 0).marked_points.any()


def test_a_picture_is_saved_whole(take: Take, tmp_path: Path) -> None:
    picture = curve_picture(take, take, "Head", (10, 20), size=(300, 200))
    picture.save(tmp_path / "curve.png")
    assert (tmp_path / "curve.png").read_bytes() == picture.png
    assert picture.png.startswith(b"\x89PNG")
