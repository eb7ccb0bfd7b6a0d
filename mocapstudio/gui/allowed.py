"""Which commands the document allows."""

from __future__ import annotations

from mocapstudio.gui.document import UiState
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.review.model import Verdict
from mocapstudio.review.state import DocumentState

GENERAL = frozenset(
    {"open", "recent", "new", "quit", "cancel", "theme", "full-screen", "reset-layout",
     "shortcuts", "about", "save", "save-as"}
)  # fmt: skip
"""Commands that have a place in every workspace, whether or not it knows the document."""


def allowed(state: DocumentState) -> dict[str, bool]:
    """Tell of each command about the document whether it can be done; others always can."""
    take, some = state.take is not None, bool(state.everyone)
    some = some or state.comparison.reference is not None
    item = state.selected
    span = state.selection.span is not None
    decided = item is not None and item.verdict is not Verdict.OPEN
    accepted = item is not None and item.verdict is Verdict.ACCEPTED
    found = {
        "partner": take, "export": take, "report": take, "import-report": take, "close-take": take,
        "save": some, "save-as": some,
        "analyse": take, "play": take, "frame-back": take, "frame-on": take,
        "ten-back": take, "ten-on": take, "first": take, "last": take, "loop": take,
        "trim-in": take, "trim-out": take,
        "trim-clear": take and any(one == state.active for one, _ in state.sitting.trims),
        "next": bool(state.queue), "previous": bool(state.queue),
        "select-all": bool(state.queue),
        "deselect": bool(state.selection.joints) or span or item is not None,
        "accept": item is not None, "reject": item is not None, "defer": item is not None,
        "reopen": decided, "reject-like": item is not None, "edit": accepted,
        "protect": take and span,
        "unprotect": any(one.performer == state.active for one in state.sitting.protected),
        "frame-joint": take, "zoom-flag": item is not None or span, "whole-take": take,
        "new": some,
        "undo": state.can_undo is not None, "redo": state.can_redo is not None,
    }  # fmt: skip
    for k in range(6):
        found[f"neighbour-{k}"] = item is not None and item.flag.joint not in ROOT_ROWS
    found["neighbour-alignment"] = item is not None and state.analysis is not None
    return found


def checked(state: DocumentState, ui: UiState) -> dict[str, bool]:
    """Tell of each switch of the document's desk whether it is on."""
    return {
        "calibrated": state.mode == "calibrated",
        "paper": state.mode == "paper",
        "loop": ui.loop,
        "ghosts": ui.ghosts,
        "onion": ui.onion,
        "keep-ends": state.keep_ends,
        "follow": ui.follow,
        "trails": ui.trails,
        "theme": ui.theme == "light",
        "learning": ui.learning,
        "distances": ui.distances,
        "beside-texture": ui.beside == "texture",
        "beside-map": ui.beside == "map",
    }
