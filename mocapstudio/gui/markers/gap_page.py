"""The inspector's first page: what can be done with the chosen gap."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QVBoxLayout, QWidget

from mocapstudio.gui import wording
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.markers.bridge import MarkersBridge, MarkersShown
from mocapstudio.gui.markers.working import Working
from mocapstudio.gui.widgets.fields import NumberField
from mocapstudio.gui.widgets.parts import label, rule
from mocapstudio.review.marker_fills import METHODS


class GapPage(QWidget):
    """The chosen marker and gap, and the ways to fill it.

    Parameters
    ----------
    bridge
        What is shown and chosen.
    working
        Knows which gaps would be filled.
    actions
        The commands behind the buttons.
    """

    def __init__(self, bridge: MarkersBridge, working: Working, actions: Actions) -> None:
        super().__init__()
        self._bridge, self._working = bridge, working
        self._name = label("", "heading", "markers-name")
        self._words = label("", "muted", "markers-words", wrap=True)
        self._words.setMinimumHeight(2 * self._words.fontMetrics().lineSpacing() + 4)
        self._words.setAlignment(Qt.AlignmentFlag.AlignTop)
        self._short = label("frames", "muted", "markers-short")
        body = QVBoxLayout(self)
        body.setContentsMargins(12, 10, 12, 10)
        body.setSpacing(7)
        body.addWidget(self._name)
        body.addWidget(self._words)
        body.addLayout(_fill_buttons(actions))
        body.addLayout(self._all_row(actions))
        body.addWidget(rule())
        body.addLayout(_other_buttons(actions))
        body.addStretch(1)
        bridge.changed.connect(self._follow)
        self._show(bridge.shown)
        self._count()

    def _all_row(self, actions: Actions) -> QHBoxLayout:
        field = NumberField()
        field.setObjectName("markers-longest")
        field.setRange(1, 10_000)
        field.setValue(self._bridge.shown.longest)
        field.setToolTip("Frames of the longest gap that is filled when all are")
        field.setKeyboardTracking(False)
        field.setFixedWidth(64)
        field.setAlignment(Qt.AlignmentFlag.AlignRight)
        field.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        field.valueChanged.connect(lambda frames: self._bridge.set(longest=frames))
        self._longest = field
        row = QHBoxLayout()
        row.setSpacing(6)
        row.addWidget(actions.push_button("markers-fill-all", "Fill all up to"), 1)
        row.addWidget(field)
        row.addWidget(self._short)
        return row

    def _follow(self, old: MarkersShown, new: MarkersShown) -> None:
        if new.frame != old.frame and new.playing:
            return
        self._show(new)
        if (old.gaps, old.longest) != (new.gaps, new.longest):
            self._count()

    def _show(self, shown: MarkersShown) -> None:
        self._name.setText(shown.marker or "No marker chosen")
        self._words.setText(_words_of(shown))
        self._longest.setValue(shown.longest)

    def _count(self) -> None:
        count = len(self._working.short_gaps())
        self._short.setToolTip(f"{count} gaps of this take are as short")


def _fill_buttons(actions: Actions) -> QGridLayout:
    grid = QGridLayout()
    grid.setSpacing(6)
    best, *others = METHODS
    button = actions.push_button(f"markers-fill-{best.name}", f"1  {best.words.capitalize()}")
    button.setProperty("role", "primary")
    grid.addWidget(button, 0, 0, 1, 6)
    for number, one in enumerate(others):
        button = actions.push_button(f"markers-fill-{one.name}", f"{number + 2}  {one.short}")
        # Three of the short ones in a row, then two.
        row, wide = (1, 2) if number < 3 else (2, 3)
        grid.addWidget(button, row, wide * (number if number < 3 else number - 3), 1, wide)
    return grid


def _other_buttons(actions: Actions) -> QGridLayout:
    grid = QGridLayout()
    grid.setSpacing(6)
    exchange = actions.push_button("markers-exchange", "Exchange with another marker…")
    grid.addWidget(exchange, 0, 0, 1, 2)
    grid.addWidget(actions.push_button("markers-clear", "Take away"), 1, 0)
    grid.addWidget(actions.push_button("markers-take-back", "Take back"), 1, 1)
    return grid


def _words_of(shown: MarkersShown) -> str:
    take, marker = shown.result, shown.marker
    if take is None or marker is None:
        return "Choose one in the list, in the lanes or in the viewport."
    one = shown.gaps.by_label[marker]
    if one.never_seen:
        return "It is never seen: nothing can bring it back."
    gap = shown.chosen_gap
    if gap is not None:
        what = "Missing" if gap in one.gaps else "Filled"
        ends = " · touches the take's end" if gap[0] == 0 or gap[1] == take.frames else ""
        return f"{what} {wording.span(take, *gap)}{ends}{_kept(shown, *gap)}"
    if shown.span is not None:
        return f"Chosen: {wording.span(take, *shown.span)}{_kept(shown, *shown.span)}"
    if not one.gaps:
        return "Seen in every frame."
    return f"Seen here; {len(one.gaps)} gap{'' if len(one.gaps) == 1 else 's'} elsewhere."


def _kept(shown: MarkersShown, start: int, end: int) -> str:
    touched = (
        one.row == shown.marker and one.start < end and start < one.end for one in shown.protected
    )
    return " · protected" if any(touched) else ""
