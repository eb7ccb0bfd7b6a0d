"""The import report: what was odd, and reading a file in another way."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hands import CTRL, Hands
from PySide6.QtCore import Qt

from mocapstudio import formats
from mocapstudio.motion.kinematics import take_pose

ODD = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Leg
  {
    OFFSET 0 -45 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    JOINT Foot
    {
      OFFSET 0 -45 0
      CHANNELS 3 Zrotation Xrotation Yrotation
    }
  }
  JOINT Leg
  {
    OFFSET 0 45 0
    CHANNELS 3 Zrotation Xrotation Yrotation
  }
}
MOTION
Frames: 40
Frame Time: 0.0
"""


@pytest.fixture
def odd(tmp_path):
    """A BVH file with a repeated name and no frame time."""
    rows = [f"0 {90 + n / 10} 0 {n} 0 0 0 0 0 0 0 0 0 0 0" for n in range(40)]
    path = tmp_path / "odd.bvh"
    path.write_text(ODD + "\n".join(rows) + "\n")
    return path


def open_take(hands: Hands, path) -> None:
    if hands.window.bridge.ui.learning:
        hands.menu("Analysis", "Learn from the Context")
    hands.window.files.open_paths([path])
    name = path.stem
    hands.see(lambda: any(p.id == name for p in hands.window.bridge.state.scene.performers))


def table(hands: Hands) -> list[list[str]]:
    one = hands.find("import-problems")
    return [[one.item(r, c).text() for c in range(5)] for r in range(one.rowCount())]


def open_report(hands: Hands) -> None:
    hands.menu("File", "Import Report")
    hands.see(lambda: hands.shows("import-report"))
    report = hands.find("import-report")
    report.activateWindow()
    hands.see(report.isActiveWindow)


def answer(hands: Hands, key: Qt.Key) -> None:
    """Answer the question that is asked."""
    hands.see(lambda: hands.shows("confirm-question"))
    question = hands.find("confirm-question")
    question.activateWindow()
    hands.see(question.isActiveWindow)
    hands.key(key)


def test_the_report_says_what_the_reader_says(hands, odd):
    open_take(hands, odd)
    _, report = formats.read(odd)
    assert {one.guess for one in report.problems} == {True, False}
    hands.click("import-link")
    hands.see(lambda: hands.shows("import-report"))
    shown = table(hands)
    assert [row[1:3] for row in shown] == [[p.what, p.done] for p in report.problems]
    assert [row[0] for row in shown] == [str(p.line) if p.line else "–" for p in report.problems]
    assert [row[3] == "guess" for row in shown] == [p.guess for p in report.problems]
    guessed = {p.override for p in report.problems if p.guess}
    for name in ("fps", "unit", "up", "forward", "angles"):
        assert hands.shows(f"reading-{name}-guessed") == (name in guessed), name
    assert hands.find("reading-angles").isEnabled()


def test_reading_again_takes_the_overrides_and_remembers_them(hands, odd):
    open_take(hands, odd)
    state = hands.window.bridge.state
    old = state.take
    open_report(hands)
    hands.type("reading-fps-text", "many", enter=False)
    hands.click("import-again")
    assert "'many' is no frame rate" in hands.text("import-wrong")
    hands.type("reading-fps-text", "50", enter=False)
    hands.type("reading-unit-text", "in", enter=False)
    hands.choose("reading-up", "Z")
    hands.choose("reading-angles", "radians")
    hands.click("import-again")
    hands.see(lambda: hands.window.bridge.state.take is not old)
    new = hands.window.bridge.state.take
    wanted = formats.ReadOptions(fps=Fraction(50), unit=0.0254, up="z", angles="radians")
    (expected,), report = formats.read(odd, wanted)
    assert new.rate == 50
    assert np.allclose(take_pose(new)[0], take_pose(expected)[0])
    assert hands.window.bridge.state.active == "odd"
    hands.see(lambda: [row[1] for row in table(hands)] == [p.what for p in report.problems])
    assert not hands.shows("reading-fps-guessed")
    assert hands.text("reading-unit-text") == "in"
    hands.click("import-plain")
    hands.click("import-again")
    hands.see(lambda: hands.window.bridge.state.take.rate == old.rate)
    assert np.allclose(take_pose(hands.window.bridge.state.take)[0], take_pose(old)[0])


def test_decisions_are_not_lost_without_a_question_nor_takes_to_a_bad_file(hands, odd):
    open_take(hands, odd)
    document = hands.window.bridge.document
    document.protect(["Leg"], 0, 10)
    old = hands.window.bridge.state.take
    open_report(hands)
    hands.type("reading-fps-text", "50", enter=False)
    hands.click("import-again")
    answer(hands, Qt.Key.Key_Escape)
    hands.see(lambda: not hands.shows("confirm-question"))
    hands.come_back()
    assert hands.window.bridge.state.take is old
    assert len(hands.window.bridge.state.sitting.protected) == 1
    hands.click("import-again")
    answer(hands, Qt.Key.Key_Return)
    hands.see(lambda: hands.window.bridge.state.take is not old)
    assert hands.window.bridge.state.sitting.protected == ()
    assert hands.window.bridge.state.can_undo is None
    # What cannot be read so leaves all as it was.
    read = hands.window.bridge.state.take
    hands.come_back()
    odd.write_text("HIERARCHY\nROOT Hips\n")
    hands.click("import-again")
    hands.see(lambda: hands.shows("trouble-dialog"))
    assert hands.text("trouble-file") == str(odd)
    assert hands.window.bridge.state.take is read
    hands.click("trouble-ok")
    hands.come_back()


def test_each_open_file_has_a_report_of_its_own(hands, odd, generated):
    open_take(hands, odd)
    open_take(hands, generated.take)
    hands.press("I", CTRL)
    hands.see(lambda: hands.shows("import-report"))
    files = hands.find("import-files")
    assert [files.item(row).text().split("\n")[0] for row in range(2)] == ["odd.bvh", "take.bvh"]
    assert hands.text("import-name") == "take.bvh"
    hands.click_cell(files, files.visualItemRect(files.item(0)))
    assert hands.text("import-name") == "odd.bvh"
    _, report = formats.read(odd)
    assert len(table(hands)) == len(report.problems)


def test_a_file_that_came_with_a_session_is_looked_at(hands, odd, tmp_path):
    open_take(hands, odd)
    session = tmp_path / "evening.mocapstudio"
    assert hands.window.files.handing_over.save(session)
    hands.window.files.begin_anew()
    hands.see(lambda: not hands.window.bridge.state.scene.performers)
    hands.window.files.opening.imports._known.clear()
    hands.window.files.open_paths([session])
    hands.see(lambda: hands.window.bridge.state.active == "odd")
    open_report(hands)
    _, report = formats.read(odd)
    hands.see(lambda: [row[1] for row in table(hands)] == [p.what for p in report.problems])
