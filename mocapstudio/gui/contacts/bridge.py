"""What the Contacts workspace shows for now, and what its views read of the document."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from PySide6.QtCore import QObject, Signal

from mocapstudio.cleaning.contacts.model import Contact
from mocapstudio.cleaning.ik.foot_skate import Unreached
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.review.model import Edit
from mocapstudio.review.state import DocumentState


@dataclass(frozen=True)
class ContactsUi:
    """What is neither undoable nor saved.

    Parameters
    ----------
    chosen
        Ids of the chosen contacts, the one chosen last at the end.
    held
        A contact as it looks while it is dragged, before it is let go.
    along
        Contacts that go with it, as they look meanwhile.
    snap
        Whether dragged targets snap.
    posing
        Whether hands and feet themselves are dragged in the viewport.
    unreached
        What the last solve could not meet.
    """

    chosen: tuple[str, ...] = ()
    held: Contact | None = None
    along: tuple[Contact, ...] = ()
    snap: bool = True
    posing: bool = False
    unreached: tuple[Unreached, ...] = ()


class ContactsBridge(QObject):
    """Tells the views of the workspace what is chosen and dragged.

    Parameters
    ----------
    desk
        The document's door.
    parent
        Qt's parent.
    """

    ui_changed = Signal(object, object)
    """Emitted with the old and the new `ContactsUi`, only where they differ."""

    def __init__(self, desk: DocumentBridge, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.desk = desk
        self._ui = ContactsUi()
        self._known: tuple[object, str, tuple[Contact, ...]] = ((), "", ())
        desk.changed.connect(self._follow)

    @property
    def ui(self) -> ContactsUi:
        """The frozen transient state."""
        return self._ui

    @property
    def kept(self) -> tuple[Contact, ...]:
        """Contacts of the take under review as the document has them, by their start."""
        state = self.desk.state
        if self._known[0] is not state.sitting.contacts or self._known[1] != state.active:
            found = self.desk.document.contacts(state.active) if state.active else ()
            self._known = (state.sitting.contacts, state.active, found)
        return self._known[2]

    @property
    def repairs(self) -> tuple[Edit, ...]:
        """Accepted repairs in force of the take under review."""
        state = self.desk.state
        return tuple(
            one
            for one in state.sitting.edits
            if one.performer == state.active and one.flag is not None and not one.muted
        )

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """Contacts as they are shown: what is dragged, where it is dragged to."""
        held = self._ui.held
        if held is None:
            return self.kept
        moving = (*self._ui.along, held)
        ids = {one.id for one in moving}
        return (*(one for one in self.kept if one.id not in ids), *moving)

    @property
    def chosen(self) -> Contact | None:
        """The contact chosen last, as it is shown, or None."""
        return self.contact(self._ui.chosen[-1]) if self._ui.chosen else None

    def contact(self, contact_id: str) -> Contact | None:
        """Return a contact as it is shown, or None where there is none of that id."""
        return next((one for one in self.contacts if one.id == contact_id), None)

    def set_ui(self, **changes: Any) -> None:
        """Change fields of the transient state; equal values are not announced.

        What is held goes alone, unless it is said what goes along.
        """
        if "held" in changes:
            changes.setdefault("along", ())
        old, new = self._ui, replace(self._ui, **changes)
        if new != old:
            self._ui = new
            self.ui_changed.emit(old, new)

    def choose(self, contact_id: str | None, extend: bool = False) -> None:
        """Choose a contact, or none; with `extend` one more, or one less."""
        if contact_id is None:
            self.set_ui(chosen=())
            self.desk.document.clear_selection()
            return
        chosen = tuple(one for one in self._ui.chosen if one != contact_id)
        if not extend:
            chosen = (contact_id,)
        elif contact_id not in self._ui.chosen:
            chosen = (*chosen, contact_id)
        self.set_ui(chosen=chosen)
        contact = self.chosen
        if contact is not None:
            span = (contact.start, contact.end)
            self.desk.document.select(joints={contact.joint}, span=span, flag="")

    def _follow(self, old: DocumentState, new: DocumentState) -> None:
        if old.active != new.active or old.scene is not new.scene:
            self.set_ui(held=None, unreached=())
        if old.sitting is not new.sitting or old.active != new.active:
            there = {one.id for one in self.kept}
            self.set_ui(
                chosen=tuple(one for one in self._ui.chosen if one in there),
                unreached=tuple(one for one in self._ui.unreached if one.contact in there),
            )
