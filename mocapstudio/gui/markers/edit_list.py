"""The inspector's second page: the edits of the take, each of which can go."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QScrollArea, QVBoxLayout, QWidget

from mocapstudio.gui import wording
from mocapstudio.gui.document import UiState
from mocapstudio.gui.markers.bridge import MarkersBridge, MarkersShown
from mocapstudio.gui.markers.working import Working
from mocapstudio.gui.widgets.cards import icon_button, make_card
from mocapstudio.gui.widgets.parts import Hint, label
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.review.marker_model import MarkerEdit

_MOST_CARDS = 60


class EditList(QScrollArea):
    """The edits of the take, latest first; those made together in one card."""

    def __init__(self, bridge: MarkersBridge, working: Working) -> None:
        super().__init__()
        self.setObjectName("markers-edits")
        self.setWidgetResizable(True)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._bridge, self._working = bridge, working
        self._hint = Hint(self, "markers-edits-hint")
        bridge.changed.connect(self._follow)
        # Not from within the change of style: cards must not go while Qt walks over them.
        bridge.desk.ui_changed.connect(self._follow_ui)
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

    def _follow_ui(self, old: UiState, new: UiState) -> None:
        if old.theme != new.theme:
            self.refresh()

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
        mute.clicked.connect(lambda: self._working.mute(edits, not muted))
        delete = icon_button("delete", "Delete the edit", "marker-edit-delete")
        delete.clicked.connect(lambda: self._working.delete(edits))
        row.addWidget(mute)
        row.addWidget(delete)
        return card


def _how(edit: MarkerEdit) -> str:
    longest = edit.parameters.get("longest")
    up_to = "" if longest is None else f", up to {longest} frames"
    return f"filled: {edit.method}{up_to}" if edit.kind == "fill" else edit.method
