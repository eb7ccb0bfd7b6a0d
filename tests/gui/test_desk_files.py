"""Opening, bad input, dropping, saving, closing: what a user of the real window sees."""

from __future__ import annotations

import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import pytest
from hands import CTRL, Hands
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import QApplication, QDialogButtonBox

from mocapstudio import formats
from mocapstudio.review.manner import Manner


def open_take(hands: Hands, path: Path) -> None:
    # What is learnt meanwhile would rearrange the queue under these hands.
    if hands.window.bridge.ui.learning:
        hands.menu("Analysis", "Learn from the Context")
    hands.press("O", CTRL)
    hands.answer_file_dialog(path)
    hands.see(lambda: len(hands.rows()) > 2, 60)


def spoil(path: Path, how: str) -> int | None:
    """Spoil a BVH file; returns the line that is to blame, where one is."""
    lines = path.read_text().splitlines()
    motion = next(n for n, line in enumerate(lines) if line.strip().startswith("MOTION"))
    blamed: int | None = motion + 8
    if how == "not a BVH":
        lines, blamed = ["just some words", *lines[motion:]], None
    elif how == "a value is no number":
        lines[motion + 7] = lines[motion + 7].replace(lines[motion + 7].split()[3], "oops", 1)
    elif how == "a value is NaN":
        lines[motion + 7] = lines[motion + 7].replace(lines[motion + 7].split()[3], "nan", 1)
    elif how == "a value is missing":
        lines[motion + 7] = " ".join(lines[motion + 7].split()[:-1])
    elif how == "cut off in the hierarchy":
        lines, blamed = lines[: motion // 2], None
    elif how == "zero frames":
        lines = [*lines[: motion + 1], "Frames: 0", lines[motion + 2]]
        blamed = None
    path.write_text("\n".join(lines) + "\n")
    return blamed


@pytest.mark.parametrize(
    "how",
    [
        "not a BVH",
        "a value is no number",
        "a value is NaN",
        "a value is missing",
        "cut off in the hierarchy",
        "zero frames",
    ],
)
def test_bad_input_gets_one_dialog_and_the_sitting_stays(hands, generated, tmp_path, how):
    open_take(hands, generated.take)
    hands.press("NR")
    before = hands.rows()
    bad = tmp_path / "bad.bvh"
    bad.write_bytes(generated.take.read_bytes())
    line = spoil(bad, how)
    hands.press("O", CTRL)
    hands.answer_file_dialog(bad)
    hands.see(lambda: hands.shows("trouble-dialog"))
    assert hands.text("trouble-file") == str(bad)
    assert len(hands.text("trouble-cause")) > 8
    if line is not None:
        assert hands.text("trouble-place") == f"line {line}"
    hands.click("trouble-ok")
    hands.come_back()
    assert hands.rows() == before
    assert hands.find("active-take").currentText() == "take"


def test_bad_files_of_a_context_are_named_and_the_others_used(hands, generated):
    open_take(hands, generated.take)
    folder = generated.context[0].parent
    (folder / "broken.bvh").write_text("HIERARCHY\nROOT Hips\n")
    hands.press("K", CTRL)
    hands.click("context-add-folder")
    hands.answer_file_dialog(folder)
    hands.see(lambda: hands.text("context-count") == "2 takes")
    hands.click("context-ok")
    hands.see(lambda: hands.shows("trouble-dialog"))
    assert hands.text("trouble-file").endswith("broken.bvh")
    hands.click("trouble-ok")
    hands.come_back()
    assert hands.text("button-context") == "Context (1)"


def test_a_context_of_another_skeleton_is_refused_by_name(hands, generated, data):
    open_take(hands, generated.take)
    other = data / "cmu_salsa_pairs_bvh" / "60_01_scaled.bvh"
    before = hands.rows()
    hands.press("K", CTRL)
    hands.click("context-add-files")
    hands.answer_file_dialog(other)
    hands.click("context-ok")
    hands.see(lambda: hands.shows("trouble-dialog"), 40)
    assert str(other) in hands.text("trouble-cause")
    assert "another skeleton" in hands.text("trouble-cause")
    hands.click("trouble-ok")
    hands.come_back()
    assert hands.rows() == before
    assert hands.text("button-context") == "Context"


def drop(window, paths: list[Path], at: QPoint) -> None:
    """Drop files, as the window system tells a window of it."""
    mime = QMimeData()
    mime.setUrls([QUrl.fromLocalFile(str(path)) for path in paths])
    copy, left, none = (
        Qt.DropAction.CopyAction,
        Qt.MouseButton.LeftButton,
        Qt.KeyboardModifier.NoModifier,
    )
    QApplication.sendEvent(window, QDragEnterEvent(at, copy, mime, left, none))
    target = window.findChild(object, "drop-zones")
    assert target.isVisible()
    QApplication.sendEvent(target, QDropEvent(QPointF(at), copy, mime, left, none))
    assert not target.isVisible()


def test_dropping_offers_review_partner_or_context(hands, desk, generated):
    assert hands.shows("welcome-hint")
    drop(desk, [generated.take], QPoint(1300, 400))
    hands.see(lambda: len(hands.rows()) > 2, 60)
    drop(desk, [generated.context[0]], QPoint(720, 400))
    hands.see(lambda: hands.find("active-take").count() == 2)
    assert hands.find("active-take").currentText() == "take"
    drop(desk, [generated.context[0].parent], QPoint(1300, 400))
    hands.see(lambda: hands.text("button-context") == "Context (1)")


def test_an_export_never_replaces_an_input(hands, generated):
    open_take(hands, generated.take)
    before = generated.take.read_bytes()
    hands.press("E", CTRL)
    hands.answer_file_dialog(generated.take)
    hands.see(lambda: hands.shows("confirm-question"))
    hands.key(Qt.Key.Key_Return)
    hands.see(lambda: hands.shows("trouble-dialog"))
    assert generated.take.read_bytes() == before
    hands.click("trouble-ok")


def test_the_name_offered_for_an_export_is_stem_clean(hands, generated):
    open_take(hands, generated.take)
    hands.press("E", CTRL)
    hands.see(lambda: hands.shows("file-dialog"))
    field = QApplication.activeModalWidget().findChild(object, "fileNameEdit")
    hands.see(lambda: field.text() == "take_clean.bvh")
    hands.key(Qt.Key.Key_Escape)


def test_a_session_is_saved_and_opened_again(hands, open_desk, qtbot, generated, tmp_path):
    open_take(hands, generated.take)
    hands.press("NAR")
    hands.see(lambda: {"accepted", "rejected"} <= {row[6] for row in hands.rows()})
    rows = hands.rows()
    hands.press("S", CTRL)
    session = tmp_path / "evening.mocapstudio"
    hands.answer_file_dialog(session)
    hands.see(session.exists)
    assert "evening.mocapstudio" in hands.text("facts")
    assert "unsaved" not in hands.text("facts")
    hands.window.close()
    assert not hands.window.isVisible()

    other = Hands(open_desk(), qtbot)
    other.menu("File", "Open Recent", "evening.mocapstudio")
    other.see(lambda: other.shows("queue-table") and len(other.rows()) == len(rows), 60)
    other.see(lambda: other.window.bridge.state.analysis is not None, 60)
    assert sorted(row[1:] for row in other.rows()) == sorted(row[1:] for row in rows)


def test_closing_with_unsaved_decisions_asks(hands, generated, tmp_path):
    open_take(hands, generated.take)
    hands.press("NR")
    hands.see(lambda: "unsaved" in hands.text("facts"))
    hands.press("Q", CTRL)
    hands.see(lambda: hands.shows("save-question"))
    hands.key(Qt.Key.Key_Escape)
    hands.see(lambda: QApplication.activeModalWidget() is None)
    hands.come_back()
    assert hands.window.isVisible()
    hands.press("Q", CTRL)
    hands.see(lambda: hands.shows("save-question"))
    box = QApplication.activeModalWidget()
    buttons = box.findChild(QDialogButtonBox)
    discard = buttons.button(QDialogButtonBox.StandardButton.Discard)
    from PySide6.QtTest import QTest

    QTest.mouseClick(discard, Qt.MouseButton.LeftButton)
    hands.see(lambda: not hands.window.isVisible())


CRASH = """
import os, sys
from mocapstudio import formats
from mocapstudio.review.manner import Manner
from mocapstudio.cleaning.detection import detect
from mocapstudio.motion.progress import run
from mocapstudio.review.document import Document
from mocapstudio.review.journal import Journal

document = Document()
journal = Journal(document)
performer = document.open_take(formats.read(sys.argv[1])[0][0])
analysis = run(detect(document.source(performer)))
document.finish_analysis(performer, document.begin_analysis(performer), analysis)
document.reject([item.flag.id for item in document.state.queue[:2]])
os._exit(1)
"""


def test_a_crash_costs_nothing(open_desk, qtbot, generated):
    done = subprocess.run([sys.executable, "-c", CRASH, generated.take], timeout=120)
    assert done.returncode == 1
    hands = Hands(open_desk(), qtbot)
    hands.click("welcome-recover")
    hands.see(lambda: hands.shows("queue-table") and len(hands.rows()) > 2, 60)
    assert [row[6] for row in hands.rows()].count("rejected") == 2
    assert "unsaved" in hands.text("facts")


def test_the_demo_take_opens_with_its_context(hands):
    hands.click("welcome-demo")
    hands.see(lambda: hands.shows("queue-table") and len(hands.rows()) > 5, 120)
    hands.see(lambda: hands.text("button-context").startswith("Context ("), 60)


def test_a_long_analysis_can_be_cancelled_and_leaves_nothing(hands, generated):
    open_take(hands, generated.take)
    before = hands.rows()
    hands.key(Qt.Key.Key_F5)
    hands.press(".", CTRL)
    hands.see(lambda: not hands.window.jobs.running)
    assert hands.rows() == before
    assert hands.window.jobs.wait(10)
    assert formats.read(generated.take)[0][0].frames == 1200


def test_takes_are_read_as_the_command_line_asks(open_desk, qtbot, generated):
    window = open_desk()
    window.open([generated.take], [], [], Manner(formats.ReadOptions(fps=Fraction(30))))
    qtbot.waitUntil(lambda: window.bridge.state.take is not None, timeout=30_000)
    assert window.bridge.state.take.rate == 30
