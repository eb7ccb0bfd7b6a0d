"""The inspector's second page: accepted repairs and protected spans, each of which can go."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QScrollArea, QVBoxLayout, QWidget

from mocapstudio.gui import wording
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.widgets.cards import icon_button, make_card
from mocapstudio.gui.widgets.parts import Hint, label
from mocapstudio.motion.take import Take
from mocapstudio.review.model import Edit, Protected
from mocapstudio.review.state import DocumentState


class EditsPage(QScrollArea):
    """Lists the edits of the performer under review, latest first.

    Parameters
    ----------
    bridge
        The document's door.
    """

    def __init__(self, bridge: DocumentBridge) -> None:
        super().__init__()
        self.setObjectName("inspector-edits")
        self.setWidgetResizable(True)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._bridge = bridge
        self._shown: tuple[object, ...] = ()
        self._hint = Hint(self, "edits-hint")
        bridge.changed.connect(lambda old, new: self._show(new))
        bridge.ui_changed.connect(lambda old, new: self._show(bridge.state, old.theme != new.theme))
        self._show(bridge.state)

    def reveal(self, flag_id: str) -> None:
        """Scroll to the edit that a flag was accepted with."""
        for card in self.findChildren(QFrame):
            if card.property("flag") == flag_id:
                self.ensureWidgetVisible(card)
                card.setStyleSheet("QFrame { border-width: 2px; }")

    def _show(self, state: DocumentState, anew: bool = False) -> None:
        wanted = (state.active, state.sitting.edits, state.sitting.protected)
        if wanted == self._shown and not anew:
            return
        self._shown = wanted
        body = QWidget()
        column = QVBoxLayout(body)
        column.setContentsMargins(10, 10, 10, 10)
        column.setSpacing(6)
        take = state.take
        edits = [one for one in reversed(state.sitting.edits) if one.performer == state.active]
        spans = [one for one in state.sitting.protected if one.performer == state.active]
        if take is not None:
            for edit in edits:
                column.addWidget(self._edit_card(edit, take))
            if spans:
                column.addWidget(label("PROTECTED", "section"))
            for one in spans:
                column.addWidget(self._protected_card(one, take))
        column.addStretch(1)
        self.setWidget(body)
        nothing = not edits and not spans
        self._hint.say("Accepted repairs and protected spans\nare listed here." if nothing else "")

    def _edit_card(self, edit: Edit, take: Take) -> QFrame:
        flag = next(
            (d.flag.id for d in self._bridge.state.sitting.decisions if d.edit == edit.id), None
        )
        title = ", ".join(edit.rows)
        lines = [wording.span(take, edit.start, edit.end), wording.method(edit.method)]
        if edit.donor is not None:
            lines[-1] += f" ({edit.donor.take})"
        lines.append(f"{edit.author}, {edit.time.replace('T', ' ').removesuffix('Z')} UTC")
        card, row = make_card(title, lines, muted=edit.muted)
        card.setObjectName(f"edit-{edit.id}")
        card.setProperty("flag", flag)
        document = self._bridge.document
        mute = icon_button(
            "eye-off" if edit.muted else "eye",
            "Switch the repair on again" if edit.muted else "Switch the repair off",
            "edit-mute",
        )
        mute.clicked.connect(lambda: document.mute_edit(edit.id, not edit.muted))
        delete = icon_button(
            "delete", "Delete the repair; its flag becomes open again", "edit-delete"
        )
        delete.clicked.connect(lambda: document.delete_edit(edit.id))
        row.addWidget(mute)
        row.addWidget(delete)
        return card

    def _protected_card(self, one: Protected, take: Take) -> QFrame:
        title = ", ".join(sorted(one.joints)) if one.joints else "All joints"
        card, row = make_card(title, [wording.span(take, one.start, one.end)])
        card.setObjectName("protected-span")
        lift = icon_button("unprotect", "Lift the protection", "protected-lift")
        document = self._bridge.document
        lift.clicked.connect(lambda: document.unprotect(one.joints, one.start, one.end))
        row.addWidget(lift)
        return card
