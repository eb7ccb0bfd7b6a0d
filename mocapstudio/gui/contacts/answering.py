"""What each command does in the Contacts workspace, and whether it can be done now."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from mocapstudio.gui.contacts.bridge import ContactsBridge
from mocapstudio.gui.contacts.filing import Filing
from mocapstudio.gui.contacts.lanes import key_of
from mocapstudio.gui.workspaces.workspace import Answers

if TYPE_CHECKING:
    from mocapstudio.gui.workspaces.contacts import ContactsWorkspace
    from mocapstudio.review.document import Document

Slots = dict[str, Callable[[], object]]
_ELSEWHERE = ("view-queue", "view-inspector", "view-map", "view-curves", "find", "select-all")


class Answering(QObject):
    """Connects the commands with the sitting.

    Parameters
    ----------
    workspace
        The workspace.
    filing
        Loads and saves contacts.
    """

    def __init__(self, workspace: ContactsWorkspace, filing: Filing) -> None:
        super().__init__(workspace)
        self._workspace, self._filing = workspace, filing
        self._bridge: ContactsBridge = workspace.bridge
        self._slots = self._work() | self._edits() | self._views()
        self._slots |= dict.fromkeys(_ELSEWHERE, _nothing)

    def answers(self) -> Answers:
        """Say what is answered, and what of it can be done now."""
        ui = self._bridge.ui
        return Answers(
            slots=self._slots,
            allowed=self._allowed(),
            checked={"contacts-snap": ui.snap, "contacts-pose": ui.posing},
        )

    def _allowed(self) -> dict[str, bool]:
        bridge, state = self._bridge, self._bridge.desk.state
        take, frame = state.take is not None, state.frame
        ready = self._workspace.readings.now is not None
        chosen, some = bridge.chosen, bool(bridge.kept)
        several = [one for one in map(bridge.contact, bridge.ui.chosen) if one is not None]
        found = dict.fromkeys(self._slots, take)
        found |= dict.fromkeys(_ELSEWHERE, False)
        return found | {
            "contacts-detect": ready,
            "contacts-solve": ready and some,
            "contacts-around": ready and bool(bridge.repairs),
            "contacts-unsolve": ready and self._solved(),
            "contacts-next": some, "contacts-previous": some,
            "contacts-begin": chosen is not None and frame < chosen.end,
            "contacts-end": chosen is not None and frame >= chosen.start,
            "contacts-split": chosen is not None and chosen.start < frame < chosen.end,
            "contacts-merge": len(several) > 1 and len({key_of(one) for one in several}) == 1,
            "contacts-delete": chosen is not None,
            "contacts-load": ready, "contacts-save": ready and some,
            "zoom-flag": chosen is not None,
            "deselect": chosen is not None or bool(state.selection.joints)
            or bridge.ui.held is not None,
        }  # fmt: skip

    def _solved(self) -> bool:
        reading = self._workspace.readings.now
        return reading is not None and reading.solved

    def _work(self) -> Slots:
        working, bridge = self._workspace.working, self._bridge
        return {
            "contacts-detect": working.detect,
            "contacts-solve": working.solve,
            "contacts-around": working.solve_around,
            "contacts-unsolve": lambda: bridge.desk.document.set_corrections(
                bridge.desk.state.active, ()
            ),
            "contacts-load": self._filing.ask_load,
            "contacts-save": self._filing.ask_save,
            "contacts-snap": lambda: bridge.set_ui(snap=not bridge.ui.snap),
            "contacts-pose": lambda: bridge.set_ui(posing=not bridge.ui.posing),
        }

    def _edits(self) -> Slots:
        return {
            "contacts-next": lambda: self._go(1),
            "contacts-previous": lambda: self._go(-1),
            "contacts-begin": lambda: self._edge("start", self._frame),
            "contacts-end": lambda: self._edge("end", self._frame + 1),
            "contacts-split": self._split,
            "contacts-merge": self._merge,
            "contacts-delete": lambda: self._document.delete_contacts(self._bridge.ui.chosen),
            "deselect": self._deselect,
        }

    def _views(self) -> Slots:
        workspace = self._workspace
        return {
            "zoom-flag": workspace.lanes.zoom_to_chosen,
            "whole-take": workspace.time_range.whole,
            "frame-joint": lambda: workspace.stage.frame_joint(None),
            "reset-layout": workspace.share_out,
        }

    @property
    def _document(self) -> Document:
        return self._bridge.desk.document

    @property
    def _frame(self) -> int:
        return self._bridge.desk.state.frame

    def _go(self, by: int) -> None:
        contacts, chosen = self._bridge.kept, self._bridge.chosen
        if not contacts:
            return
        if chosen is not None:
            ids = [one.id for one in contacts]
            at = (ids.index(chosen.id) + by) % len(ids)
        else:
            later = [i for i, one in enumerate(contacts) if one.start >= self._frame]
            at = (later[0] if later else 0) if by > 0 else (later[0] - 1 if later else -1)
        self._bridge.choose(contacts[at].id)
        self._document.set_frame(contacts[at].start)

    def _edge(self, name: str, frame: int) -> None:
        chosen = self._bridge.chosen
        if chosen is not None:
            self._document.change_contact(chosen.id, "Resize contact", **{name: frame})

    def _split(self) -> None:
        chosen = self._bridge.chosen
        if chosen is not None:
            _, second = self._document.split_contact(chosen.id, self._frame)
            self._bridge.choose(second)

    def _merge(self) -> None:
        self._bridge.choose(self._document.merge_contacts(self._bridge.ui.chosen))

    def _deselect(self) -> None:
        if self._bridge.ui.held is not None:
            self._bridge.set_ui(held=None)
        else:
            self._bridge.choose(None)


def _nothing() -> None:
    """Leave a command of another workspace without effect."""
