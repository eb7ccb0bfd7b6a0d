"""The one door between Qt and the document of a comparison sitting."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any

from PySide6.QtCore import QObject, Signal

from mocapstudio.review.comparing import Comparing, ComparingState
from mocapstudio.review.matrix_model import Picture


class Alignment(StrEnum):
    """How sources are put beside the reference in space."""

    RECORDED = "recorded"
    HERE = "here"
    THROUGHOUT = "throughout"


@dataclass(frozen=True)
class CompareUi:
    """What the workspace shows for now; not part of the sitting.

    Parameters
    ----------
    playing
        Whether the play heads run.
    loop
        Whether playing stays within the selected segment, or begins anew at the end.
    speed
        Share of real time at which they run.
    along_path
        Whether they run along the warping path, or each at its own true speed.
    overlay
        Whether reference and sources stand in one viewport, or in two.
    alignment
        How sources are put beside the reference in space.
    anchor
        Reference frame at which they are aligned, for `Alignment.HERE`.
    differences
        Whether the chosen source is tinted by how far each joint differs.
    others
        Whether the other sources are drawn as well.
    follow
        Whether the camera goes along.
    parameters
        Whether the form of parameters stands in the place of the performances.
    matrix
        Whether the pose distances stand in the place of the table of segments.
    matrix_online, matrix_picture
        Whether it is that of the online alignment, and what of it is drawn.
    multiples
        Whether the pictures show all sources instead of the chosen one.
    """

    playing: bool = False
    loop: bool = False
    speed: float = 1.0
    along_path: bool = True
    overlay: bool = False
    alignment: Alignment = Alignment.HERE
    anchor: int = 0
    differences: bool = True
    others: bool = False
    follow: bool = True
    parameters: bool = False
    matrix: bool = False
    matrix_online: bool = False
    matrix_picture: Picture = Picture.DISTANCES
    multiples: bool = False


class CompareBridge(QObject):
    """Tells views what the sitting says, as Qt signals.

    Views read `state` and `ui`, send intents to `sitting` and `set_ui`, and follow the signals.

    Parameters
    ----------
    parent
        Qt's parent.
    """

    changed = Signal(object, object)
    """Emitted with the old and the new `ComparingState`, only where they differ."""

    ui_changed = Signal(object, object)
    """Emitted with the old and the new `CompareUi`, only where they differ."""

    restyled = Signal()
    """Emitted after another theme came into force."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.sitting = Comparing()
        self._ui = CompareUi()
        self.sitting.subscribe(self.changed.emit)

    @property
    def state(self) -> ComparingState:
        """The sitting's frozen state."""
        return self.sitting.state

    @property
    def ui(self) -> CompareUi:
        """The workspace's frozen transient state."""
        return self._ui

    def set_ui(self, **changes: Any) -> None:
        """Change fields of the transient state; equal values are not announced."""
        old, new = self._ui, replace(self._ui, **changes)
        if new != old:
            self._ui = new
            self.ui_changed.emit(old, new)
