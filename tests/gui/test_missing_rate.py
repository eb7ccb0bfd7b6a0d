"""Files that state no frame rate, and files of markers: the desk asks what to do."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from made_takes import walking
from PySide6.QtWidgets import QComboBox

from mocapstudio import formats
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.markers import MarkerTake


def rateless(path):
    """A table of markers without times."""
    heads = ",".join(f"{name}.{axis}" for name in ("LKNE", "RKNE", "LASI") for axis in "XYZ")
    rows = [",".join(f"{0.1 * n + c:.3f}" for c in range(9)) for n in range(20)]
    path.write_text("\n".join([heads, *rows]) + "\n")
    return path


def markers_of(take) -> MarkerTake:
    """A marker at each joint of a take."""
    positions, _ = take_pose(take)
    return MarkerTake(take.name, take.skeleton.names, positions, take.rate)


@pytest.fixture
def walk(tmp_path):
    """A walk as C3D, and as BVH."""
    take = walking(seconds=0.5, rate=30, name="walk")
    formats.write(markers_of(take), tmp_path / "walk.c3d")
    formats.write(take, tmp_path / "body.bvh")
    return tmp_path


def test_several_files_are_asked_for_their_rate_once(hands, tmp_path):
    files = [rateless(tmp_path / name) for name in ("one.csv", "two.csv")]
    hands.window.files.open_paths(files)
    hands.see(lambda: hands.shows("rate-dialog"))
    assert "2 files" in hands.text("rate-title")
    hands.type("rate-text", "often", enter=False)
    hands.click("rate-ok")
    assert "is no frame rate" in hands.text("rate-wrong")
    hands.type("rate-text", "119.88", enter=False)
    hands.click("rate-ok")
    hands.come_back()
    hands.see(lambda: len(hands.window.bridge.state.markers) == 2)
    assert not hands.shows("trouble-dialog")
    assert {one.take.rate for one in hands.window.bridge.state.markers} == {Fraction(120000, 1001)}
    assert hands.window.bridge.state.scene.performers == ()


def test_cancelling_the_rate_opens_nothing(hands, tmp_path):
    hands.window.files.open_paths([rateless(tmp_path / "one.csv")])
    hands.see(lambda: hands.shows("rate-dialog"))
    assert hands.text("rate-title") == "one.csv states no frame rate"
    hands.click("rate-cancel")
    hands.come_back()
    assert not hands.window.jobs.running
    assert hands.window.bridge.state.scene.performers == ()


def test_markers_are_compared_as_they_are_with_the_rate_that_was_told(hands, tmp_path):
    hands.window.files.open_paths([rateless(tmp_path / "one.csv")])
    hands.see(lambda: hands.shows("rate-dialog"))
    hands.type("rate-text", "25")
    hands.come_back()
    hands.see(lambda: hands.shows("markers-table"))
    hands.menu("Markers", "Compare")
    hands.come_back()
    assert hands.window.switching.name == "compare"
    reference = hands.window.switching.front.bridge.state.reference
    assert isinstance(reference, MarkerTake)
    assert reference.rate == 25


def test_markers_are_solved_to_the_take_under_review(hands, walk):
    pytest.importorskip("mocapstudio.motion.solving")
    if hands.window.bridge.ui.learning:
        hands.menu("Analysis", "Learn from the Context")
    hands.window.files.open_paths([walk / "body.bvh"])
    hands.see(lambda: hands.window.bridge.state.active == "body")
    hands.window.files.open_paths([walk / "walk.c3d"])
    hands.see(lambda: hands.shows("markers-table"))
    hands.click("button-markers-solve")
    hands.see(lambda: hands.shows("markers-dialog"))
    assert hands.find("markers-template", QComboBox).currentText() == "body (open)"
    hands.click("markers-solve")
    hands.come_back()
    hands.see(lambda: hands.window.bridge.state.active == "walk solved", 60)
    solved, body = (p.take for p in reversed(hands.window.bridge.state.scene.performers))
    assert solved.skeleton.names == body.skeleton.names
    assert (solved.rate, solved.frames) == (body.rate, body.frames)
    apart = np.linalg.norm(take_pose(solved)[0] - take_pose(body)[0], axis=2)
    assert apart[:, 0].max() < 0.05
    hands.menu("File", "Import Report")
    hands.see(lambda: hands.shows("import-report"))
    assert hands.text("import-name") == "walk.c3d"
    table = hands.find("import-problems")
    found = [table.item(row, 1).text() for row in range(table.rowCount())]
    assert any("off the solved joints" in words for words in found)
