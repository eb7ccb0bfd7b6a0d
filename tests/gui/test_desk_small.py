"""The main job on generated motion: mouse and keys only, from opening to the export."""

from __future__ import annotations

import numpy as np
from hands import CTRL, SHIFT
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication

from mocapstudio import formats

VERDICT = 6


def verdicts(hands) -> list[str]:
    return [row[VERDICT] for row in hands.rows()]


def open_take(hands, generated) -> None:
    # What is learnt meanwhile would rearrange the queue under these hands.
    hands.menu("Analysis", "Learn from the Context")
    hands.press("O", CTRL)
    hands.answer_file_dialog(generated.take)
    hands.see(lambda: len(hands.rows()) > 2, 60)


def test_the_main_job(hands, generated, tmp_path):
    open_take(hands, generated)
    scores = [float(row[4]) for row in hands.rows()]
    assert scores == sorted(scores, reverse=True)

    hands.press("N")
    hands.see(lambda: hands.selected_rows() == [0])
    joint = hands.rows()[0][1]
    assert hands.text("inspector-joint") == joint
    hands.see(lambda: "nearest neighbour" in hands.text("inspector-why"))

    hands.press("A")
    hands.see(lambda: verdicts(hands)[0] == "accepted")
    assert hands.selected_rows() == [1]
    hands.press("R")
    hands.see(lambda: verdicts(hands)[:2] == ["accepted", "rejected"])

    hands.press("E", CTRL)
    out = tmp_path / "out.bvh"
    hands.answer_file_dialog(out)
    hands.see(out.exists)
    hands.see(lambda: "Exported" in hands.text("note"))
    before, after = (formats.read(path)[0][0] for path in (generated.take, out))
    changed = np.flatnonzero(np.abs(before.rotations - after.rotations).max(axis=(0, 2)) > 1e-9)
    moved = np.abs(before.translations - after.translations).max() > 1e-9
    assert moved or len(changed)


def test_keys_do_not_decide_while_typing(hands, generated):
    open_take(hands, generated)
    hands.press("N")
    hands.see(lambda: hands.selected_rows() == [0])
    hands.press("F", CTRL)
    field = hands.find("queue-filter-text")
    assert QApplication.focusWidget() is field
    for key in "arda1":
        hands.press(key)
    assert field.text().lower() == "arda1"
    hands.key(Qt.Key.Key_Escape)
    hands.see(lambda: set(verdicts(hands)) == {"open"})
    assert not field.hasFocus()
    hands.press("A")
    hands.see(lambda: "accepted" in verdicts(hands))


def test_letters_in_the_table_are_commands_not_type_ahead(hands, generated):
    open_take(hands, generated)
    hands.click_row(1)
    hands.see(lambda: hands.selected_rows() == [1])
    hands.press("P")
    hands.see(lambda: hands.selected_rows() == [0])
    hands.press("D")
    hands.see(lambda: "deferred" in verdicts(hands))


def test_several_rows_are_decided_together_and_undone_as_one(hands, generated):
    open_take(hands, generated)
    hands.click_row(0)
    hands.click_row(2, SHIFT)
    hands.see(lambda: hands.selected_rows() == [0, 1, 2])
    hands.click("button-reject")
    hands.see(lambda: verdicts(hands).count("rejected") == 3)
    hands.press("Z", CTRL)
    hands.see(lambda: "rejected" not in verdicts(hands))
