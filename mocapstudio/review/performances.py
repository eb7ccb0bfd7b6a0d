"""The takes of a sitting as performances that can be compared: with what was edited of them."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take
from mocapstudio.review.document import Document

_Any = TypeVar("_Any", Take, MarkerTake)


def joint_performances(document: Document) -> list[Take]:
    """Return the performers of the scene, the active one first."""
    state = document.state
    edited = {one.performer for one in state.sitting.edits if not one.muted}
    return [
        _released(document.result(one.id), one.id in edited)
        for one in sorted(state.scene.performers, key=lambda one: one.id != state.active)
    ]


def marker_performances(document: Document) -> list[MarkerTake]:
    """Return the marker takes in the order in which they were opened."""
    return [marker_performance(document, one.id) for one in document.state.markers]


def marker_performance(document: Document, performer: str) -> MarkerTake:
    """Return one marker take.

    Raises
    ------
    MocapError
        If there is no such marker take.
    """
    edited = any(not one.muted for one in document.marker_edits(performer))
    return _released(document.marker_result(performer), edited)


def _released(take: _Any, edited: bool) -> _Any:
    # What was edited is no longer what its file holds.
    return replace(take, source=None) if edited else take
