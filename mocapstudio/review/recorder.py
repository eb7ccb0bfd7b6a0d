"""Who is told of everything that a crash must not cost."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

from mocapstudio.review.comparing_kept import KeptComparison
from mocapstudio.review.marker_model import MarkerPerformer
from mocapstudio.review.model import Performer, Sitting
from mocapstudio.review.state import DocumentState

if TYPE_CHECKING:
    from mocapstudio.review.document import Document


@dataclass(frozen=True)
class Recovered:
    """The journal that a document was recovered from, and how many of its bytes are sound."""

    path: Path
    length: int


class Recorder(Protocol):
    """Writes down what the document does, as it does it; see `review.journal`."""

    def opened(self, performer: Performer | MarkerPerformer) -> None:
        """A take was opened."""

    def closed(self, performer: str) -> None:
        """A performer was closed, and all about it forgotten."""

    def stepped(self, label: str, before: Sitting, after: Sitting) -> None:
        """A step was done."""

    def undone(self, label: str, before: Sitting, after: Sitting) -> None:
        """The last step was undone."""

    def redone(self, label: str, before: Sitting, after: Sitting) -> None:
        """The last undone step was done again."""

    def settled(self, state: DocumentState) -> None:
        """Something that lasts but cannot be undone changed, such as context or threshold."""

    def compared(self, kept: KeptComparison) -> None:
        """Other performances are compared, or otherwise."""

    def saved(self, document: Document) -> None:
        """All was written to the session file `document.state.path`."""


class Nobody:
    """A recorder that writes nothing down."""

    def opened(self, performer: Performer | MarkerPerformer) -> None:
        """Ignore it."""

    def closed(self, performer: str) -> None:
        """Ignore it."""

    def stepped(self, label: str, before: Sitting, after: Sitting) -> None:
        """Ignore it."""

    def undone(self, label: str, before: Sitting, after: Sitting) -> None:
        """Ignore it."""

    def redone(self, label: str, before: Sitting, after: Sitting) -> None:
        """Ignore it."""

    def settled(self, state: DocumentState) -> None:
        """Ignore it."""

    def compared(self, kept: KeptComparison) -> None:
        """Ignore it."""

    def saved(self, document: Document) -> None:
        """Ignore it."""
