"""What can be done with the chosen gap, and what was done."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from mocapstudio.gui import wording
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.markers.bridge import MarkersBridge, MarkersShown
from mocapstudio.gui.markers.working import Working
from mocapstudio.gui.widgets.cards import icon_button, make_card
from mocapstudio.gui.widgets.fields import NumberField
from mocapstudio.gui.widgets.parts import Hint, header, label, rule
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.review.marker_fills import METHODS
from mocapstudio.review.marker_model import MarkerEdit

_MOST_CARDS = 60


class MarkersInspector(QFrame):
    """The chosen marker and gap, the ways to fill it, and the list of edits.

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
        self.setObjectName("markers-inspector")
        self.setProperty("role", "panel")
        self.setMinimumWidth(264)
        self._bridge, self._working = bridge, working
        self._name = label("", "heading", "markers-name")
        self._words = label("", "muted", "markers-words", wrap=True)
        self._words.setMinimumHeight(2 * self._words.fontMetrics().lineSpacing() + 4)
        self._words.setAlignment(Qt.AlignmentFlag.AlignTop)
        self._short = label("", "muted", "markers-short")
        self._edits = _EditList(bridge)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(header("Gap"))
        body = QVBoxLayout()
        body.setContentsMargins(12, 10, 12, 10)
        body.setSpacing(7)
        body.addWidget(self._name)
        body.addWidget(self._words)
        body.addLayout(_fill_buttons(actions))
        body.addLayout(self._all_row(actions))
        body.addWidget(rule())
        body.addLayout(_other_buttons(actions))
        column.addLayout(body)
        column.addWidget(header("Edits"))
        column.addWidget(self._edits, 1)
        bridge.changed.connect(self._follow)
        self._show(bridge.shown)

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        self._edits.refresh()

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

    def _show(self, shown: MarkersShown) -> None:
        self._name.setText(shown.marker or "No marker chosen")
        self._words.setText(_words_of(shown))
        self._short.setText("frames")
        count = len(self._working.short_gaps())
        self._short.setToolTip(f"{count} gaps of this take are as short")


class _EditList(QScrollArea):
    """The edits of the take, latest first; those made together in one card."""

    def __init__(self, bridge: MarkersBridge) -> None:
        super().__init__()
        self.setObjectName("markers-edits")
        self.setWidgetResizable(True)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._bridge = bridge
        self._hint = Hint(self, "markers-edits-hint")
        bridge.changed.connect(self._follow)
        self.refresh()

    def refresh(self) -> None:
        """Build the cards anew."""
        shown = self._bridge.shown
        groups: dict[str, list[MarkerEdit]] = {}
        for edit in shown.edits:
            groups.setdefault(edit.group, []).append(edit)
        body = QWidget()
        column = QVBoxLayout(body)
        column.setContentsMargins(10, 10, 10, 10)
        column.setSpacing(6)
        if shown.result is not None:
            for edits in list(reversed(groups.values()))[:_MOST_CARDS]:
                column.addWidget(self._card(edits, shown.result))
        left = len(groups) - _MOST_CARDS
        if left > 0:
            column.addWidget(label(f"and {left} earlier ones", "muted"))
        column.addStretch(1)
        self.setWidget(body)
        self._hint.say("" if groups else "What is filled, exchanged or taken away\nis listed here.")

    def _follow(self, old: MarkersShown, new: MarkersShown) -> None:
        same = len(old.edits) == len(new.edits) and all(
            a is b for a, b in zip(old.edits, new.edits, strict=True)
        )
        if not same or old.source is not new.source:
            self.refresh()

    def _card(self, edits: Sequence[MarkerEdit], take: MarkerTake) -> QFrame:
        first = edits[0]
        muted = all(edit.muted for edit in edits)
        title = " ⇄ ".join(first.markers) if first.kind == "exchange" else ", ".join(first.markers)
        lines = [wording.span(take, first.start, first.end), _how(first)]
        if len(edits) > 1:
            title = f"{len(edits)} gaps"
            lines = [_how(first)]
        lines.append(f"{first.author}, {first.time.replace('T', ' ').removesuffix('Z')} UTC")
        card, row = make_card(title, lines, muted=muted)
        card.setObjectName(f"marker-edit-{first.id}")
        mute = icon_button(
            "eye-off" if muted else "eye",
            "Switch the edit on again" if muted else "Switch the edit off",
            "marker-edit-mute",
        )
        mute.clicked.connect(lambda: self._mute(edits, not muted))
        delete = icon_button("delete", "Delete the edit", "marker-edit-delete")
        ids = [edit.id for edit in edits]
        delete.clicked.connect(lambda: self._bridge.desk.document.delete_marker_edits(ids))
        row.addWidget(mute)
        row.addWidget(delete)
        return card

    def _mute(self, edits: Sequence[MarkerEdit], muted: bool) -> None:
        document = self._bridge.desk.document
        with document.group(f"{'Mute' if muted else 'Unmute'} {len(edits)} edits"):
            for edit in edits:
                document.mute_marker_edit(edit.id, muted)


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
        return f"{what} {wording.span(take, *gap)}{ends}"
    if shown.span is not None:
        return f"Chosen: {wording.span(take, *shown.span)}"
    if not one.gaps:
        return "Seen in every frame."
    return f"Seen here; {len(one.gaps)} gap{'' if len(one.gaps) == 1 else 's'} elsewhere."


def _how(edit: MarkerEdit) -> str:
    longest = edit.parameters.get("longest")
    up_to = "" if longest is None else f", up to {longest} frames"
    return f"filled: {edit.method}{up_to}" if edit.kind == "fill" else edit.method
