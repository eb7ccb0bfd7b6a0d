"""The main job on real takes: two dancers, mouse and keys only, from opening to the export.

What is checked is what the user sees (the queue's cells, the inspector's words) and what stands
in the exported file; no slot and no document is called.
"""

from __future__ import annotations

import re
import shutil
from dataclasses import dataclass
from pathlib import Path

import pytest
from bvh_cells import changed_cells, read_cells
from hands import CTRL, SHIFT, Hands
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QFrame, QLabel, QToolButton

JOINT, TIME, SCORE, KIND, VERDICT = 1, 2, 4, 5, 6


@dataclass(frozen=True)
class Edit:
    """One accepted repair, as the list of edits says it."""

    rows: frozenset[str]
    first: int
    last: int


@pytest.fixture
def salsa(data, tmp_path) -> Path:
    """Dancer 60's takes and 61_10, copied where a test may write beside them."""
    folder = tmp_path / "salsa"
    folder.mkdir()
    source = data / "cmu_salsa_pairs_bvh"
    for path in [*source.glob("60_*.bvh"), source / "61_10_scaled.bvh"]:
        shutil.copy(path, folder)
    return folder


def verdict(hands: Hands, row: int) -> str:
    return hands.rows()[row][VERDICT]


def counts(hands: Hands, word: str) -> int:
    return sum(row[VERDICT] == word for row in hands.rows())


def open_everything(hands: Hands, salsa: Path) -> None:
    """The take by the menu, the partner by its button, the context by its dialog."""
    # What is learnt meanwhile would rearrange the queue under these hands.
    hands.menu("Analysis", "Learn from the Context")
    hands.menu("File", "Open")
    hands.answer_file_dialog(salsa / "60_10_scaled.bvh")
    hands.see(lambda: len(hands.rows()) > 5, 90)
    alone = hands.rows()

    hands.click("button-partner")
    hands.answer_file_dialog(salsa / "61_10_scaled.bvh")
    hands.see(lambda: hands.find("active-take").count() == 2)
    assert hands.find("active-take").currentText() == "60_10_scaled"

    others = [path for path in sorted(salsa.glob("60_*.bvh")) if "60_10" not in path.name]
    hands.press("K", CTRL)
    hands.see(lambda: hands.find("context-dialog").isVisible())
    hands.click("context-add-files")
    hands.answer_file_dialog(*others)
    hands.see(lambda: hands.text("context-count") == f"{len(others)} takes")
    hands.click("context-ok")
    hands.come_back()
    hands.see(lambda: hands.text("button-context") == f"Context ({len(others)})", 60)
    hands.see(lambda: len(hands.rows()) > 5 and hands.rows() != alone, 90)


def walk_to(hands: Hands, row: int) -> None:
    """Go to a row by the keys N and P."""
    if not hands.selected_rows():
        hands.press("N")
    while hands.selected_rows() != [row]:
        at = hands.selected_rows()[0]
        hands.press("N" if at < row else "P")
        hands.see(lambda at=at: hands.selected_rows() != [at])


def wait_for_neighbours(hands: Hands) -> None:
    hands.see(lambda: "nearest neighbour" in hands.text("inspector-why"))


def joint_row(hands: Hands, start: int = 0) -> int:
    """First open row of a joint, not of the root."""
    for row, cells in enumerate(hands.rows()):
        if row >= start and cells[VERDICT] == "open" and not cells[JOINT].startswith("root "):
            return row
    raise AssertionError("no open flag of a joint is left")


def edits(hands: Hands) -> list[Edit]:
    """Read the list of edits in the inspector."""
    tabs = hands.find("inspector-tabs")
    QTest.mouseClick(
        tabs.tabBar(), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier,
        tabs.tabBar().tabRect(1).center(),
    )  # fmt: skip
    found = []
    for card in hands.find("inspector-edits").findChildren(QFrame):
        if not card.objectName().startswith("edit-"):
            continue
        labels = card.findChildren(QLabel)
        title, words = labels[0].full, labels[1].text()
        if title.endswith("(off)"):
            continue
        numbers = [int(n) for n in re.search(r"frames? (\d+)(?:–(\d+))?", words).groups() if n]
        found.append(Edit(frozenset(title.split(", ")), numbers[0], numbers[-1]))
    return found


def decide_by_keys(hands: Hands) -> None:
    row = joint_row(hands)
    walk_to(hands, row)
    wait_for_neighbours(hands)
    hands.press("2")
    hands.see(lambda: hands.find("neighbour-2").isChecked())
    hands.see(lambda: "neighbour" in hands.text("inspector-method"))
    hands.press("0")
    hands.see(lambda: not hands.find("neighbour-2").isChecked())
    hands.press("A")
    hands.see(lambda: verdict(hands, row) == "accepted")
    following = hands.selected_rows()[0]
    assert following == row + 1
    hands.press("R")
    hands.see(lambda: verdict(hands, following) == "rejected")
    deferred = hands.selected_rows()[0]
    joint, time = hands.rows()[deferred][JOINT : TIME + 1]
    hands.press("D")
    hands.see(lambda: counts(hands, "deferred") == 1)
    # What is left for later goes to the end of the queue.
    last = hands.rows()[-1]
    assert (last[JOINT], last[TIME], last[VERDICT]) == (joint, time, "deferred")
    walk_to(hands, following)
    hands.press("U")
    hands.see(lambda: verdict(hands, following) == "open")
    walk_to(hands, row)
    hands.press("E")
    hands.see(lambda: hands.find("inspector-edits").isVisible())
    hands.press("Z", CTRL)
    hands.see(lambda: verdict(hands, following) == "rejected")
    hands.press("Y", CTRL)
    hands.see(lambda: verdict(hands, following) == "open")


def decide_by_mouse(hands: Hands) -> None:
    row = joint_row(hands)
    hands.click_row(row)
    wait_for_neighbours(hands)
    hands.click("neighbour-1")
    hands.see(lambda: hands.find("neighbour-1").isChecked())
    accepted = counts(hands, "accepted")
    hands.click("button-accept")
    hands.see(lambda: counts(hands, "accepted") == accepted + 1)
    row = hands.selected_rows()[0]
    hands.click("button-reject")
    hands.see(lambda: verdict(hands, row) == "rejected")
    hands.click_row(row)
    hands.click("button-reopen")
    hands.see(lambda: verdict(hands, row) == "open")
    hands.click("button-defer")
    hands.see(lambda: counts(hands, "deferred") == 2)
    hands.click("button-undo")
    hands.see(lambda: counts(hands, "deferred") == 1)
    hands.click("button-redo")
    hands.see(lambda: counts(hands, "deferred") == 2)
    row = joint_row(hands)
    hands.click_row(row)
    hands.click("button-reject-like")
    hands.see(lambda: verdict(hands, row) == "rejected")
    before = counts(hands, "open")
    first = joint_row(hands)
    hands.click_row(first)
    hands.click_row(first + 1, CTRL)
    hands.press("R", SHIFT)
    hands.see(lambda: counts(hands, "open") < before)


def protect(hands: Hands) -> None:
    """By key, then lift it by the mouse: in between nothing can be accepted there."""
    row = joint_row(hands)
    hands.click_row(row)
    wait_for_neighbours(hands)
    hands.press("P", SHIFT)
    hands.see(lambda: "Shift+U" in hands.text("note"))
    hands.press("A")
    hands.see(lambda: hands.find("trouble-dialog").isVisible())
    assert "protected" in hands.text("trouble-cause")
    hands.click("trouble-ok")
    hands.come_back()
    assert verdict(hands, row) == "open"
    edits(hands)
    card = hands.find("protected-span")
    lift = card.findChild(QToolButton, "protected-lift")
    QTest.mouseClick(lift, Qt.MouseButton.LeftButton)
    hands.click_row(row)
    hands.press("A")
    hands.see(lambda: verdict(hands, row) == "accepted")


def mute_and_delete(hands: Hands) -> None:
    """One repair is switched off and one deleted: neither is in the export."""
    count = len(edits(hands))
    assert count >= 3
    hands.click("edit-mute")
    hands.see(lambda: len(edits(hands)) == count - 1)
    accepted = counts(hands, "accepted")
    cards = hands.find("inspector-edits").findChildren(QToolButton, "edit-delete")
    QTest.mouseClick(cards[-1], Qt.MouseButton.LeftButton)
    hands.see(lambda: counts(hands, "accepted") == accepted - 1)
    assert len(edits(hands)) == count - 2


def filter_and_sort(hands: Hands) -> None:
    everything = len(hands.rows())
    accepted = counts(hands, "accepted")
    hands.choose("queue-filter-verdict", "Accepted")
    hands.see(lambda: len(hands.rows()) == accepted)
    hands.choose("queue-filter-verdict", "Verdicts")
    hands.see(lambda: len(hands.rows()) == everything)
    kind = hands.rows()[0][KIND]
    hands.choose("queue-filter-kind", kind)
    hands.see(lambda: {row[KIND] for row in hands.rows()} == {kind})
    hands.choose("queue-filter-kind", "Kinds")
    hands.type("queue-filter-text", "thigh")
    hands.see(lambda: all("thigh" in row[JOINT].lower() for row in hands.rows()))
    hands.type("queue-filter-text", "")
    hands.see(lambda: len(hands.rows()) == everything)
    head = hands.find("queue-header")
    for column in (TIME, 0):
        at = QPoint(head.sectionViewportPosition(column) + 8, head.height() // 2)
        QTest.mouseClick(head.viewport(), Qt.MouseButton.LeftButton, pos=at)
        values = [float(row[column].split()[0]) for row in hands.rows()]
        assert values in (sorted(values), sorted(values, reverse=True))
    if hands.rows()[0][0] != "1":
        QTest.mouseClick(head.viewport(), Qt.MouseButton.LeftButton, pos=at)
    assert hands.rows()[0][0] == "1"


@pytest.mark.parametrize("size", [(1440, 900), (1280, 720)])
def test_two_dancers_from_opening_to_export(open_desk, qtbot, salsa, size):
    hands = Hands(open_desk(*size), qtbot)
    open_everything(hands, salsa)
    filter_and_sort(hands)
    decide_by_keys(hands)
    decide_by_mouse(hands)
    protect(hands)
    mute_and_delete(hands)
    changes = edits(hands)
    assert changes

    hands.press("E", CTRL)
    out = salsa / "out.bvh"
    hands.answer_file_dialog(out)
    hands.see(lambda: "Exported out.bvh" in hands.text("note"))

    before, after = read_cells(salsa / "60_10_scaled.bvh"), read_cells(out)
    assert after.head == before.head
    assert after.channels == before.channels
    changed = changed_cells(before, after)
    assert changed
    hips = before.channels[0][0]
    for joint, channel, frame in changed:
        rows = {joint}
        if joint == hips:
            rows = {"root position"} if channel.endswith("position") else {joint, "root heading"}
        assert any(rows & one.rows and one.first <= frame <= one.last for one in changes), (
            f"{joint} {channel} changed in frame {frame}, outside {changes}"
        )
    for one in changes:
        assert any(one.first <= frame <= one.last for _, _, frame in changed), f"{one} is not there"
