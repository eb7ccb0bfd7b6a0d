"""The one door between Qt and the document of the sitting."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

if TYPE_CHECKING:
    from mocapstudio.review.document import Document, DocumentState


@dataclass(frozen=True)
class UiState:
    """What the desk shows for now: neither undoable nor saved with the session.

    Parameters
    ----------
    ghosts
        Whether the proposal (or previewed neighbour) is drawn beside the take.
    follow
        Whether the camera follows the performer.
    preview
        0-based index of the neighbour shown as proposal, or None for the engine's own choice.
    playing
        Whether the play head runs.
    loop
        Whether playing stays within the selected flag and half a second around it.
    speed
        Share of real time at which the take plays: 0.25, 0.5 or 1.
    trails
        Whether end effectors of the selection leave trails.
    onion
        Whether the selected limb, or the body, is also shown some frames before and after.
    learning
        Whether the first map is refined by what is learnt from the context.
    analysing
        Whether the take under review is being analysed.
    distances
        Whether distance over time is shown in the place of the curves.
    beside
        What is shown under the digression map: ``"texture"``, ``"map"`` (that of another
        context) or nothing, ``""``.
    theme
        Name of the theme, ``"dark"`` or ``"light"``.
    """

    ghosts: bool = True
    follow: bool = True
    preview: int | None = None
    playing: bool = False
    loop: bool = False
    speed: float = 1.0
    trails: bool = True
    onion: bool = False
    learning: bool = True
    analysing: bool = False
    distances: bool = False
    beside: str = ""
    theme: str = "dark"


def only_frame_differs(old: DocumentState, new: DocumentState) -> bool:
    """Tell whether two states differ in the current frame at most, as while playing."""
    return all(
        getattr(old, one.name) is getattr(new, one.name)
        for one in fields(new)
        if one.name != "frame"
    )


class DocumentBridge(QObject):
    """Tells views what the document says, as Qt signals.

    Views read `state` and `ui`, send intents to `document` and `set_ui`, and follow the two
    signals; they never hold the document itself, since opening a session replaces it.

    Parameters
    ----------
    document
        The document of the sitting.
    parent
        Qt's parent.
    """

    changed = Signal(object, object)
    """Emitted with the old and the new `DocumentState`, only where they differ."""

    ui_changed = Signal(object, object)
    """Emitted with the old and the new `UiState`, only where they differ."""

    def __init__(self, document: Document, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self._ui = UiState()
        self._unsubscribe: Callable[[], None] = document.subscribe(self._announce)

    @property
    def document(self) -> Document:
        """The document, for intents."""
        return self._document

    @property
    def state(self) -> DocumentState:
        """The document's frozen state."""
        return self._document.state

    @property
    def ui(self) -> UiState:
        """The desk's frozen transient state."""
        return self._ui

    def set_ui(self, **changes: Any) -> None:
        """Change fields of the transient state; equal values are not announced."""
        old, new = self._ui, replace(self._ui, **changes)
        if new != old:
            self._ui = new
            self.ui_changed.emit(old, new)

    def replace(self, document: Document) -> None:
        """Put another document, such as an opened session, in the place of this one."""
        old = self._document.state
        self._unsubscribe()
        self._document = document
        self._unsubscribe = document.subscribe(self._announce)
        self.set_ui(preview=None, playing=False, loop=False)
        self.changed.emit(old, document.state)

    def _announce(self, old: DocumentState, new: DocumentState) -> None:
        self.changed.emit(old, new)
