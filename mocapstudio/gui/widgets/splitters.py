"""Splitters of a workspace: columns above further rows, their sizes remembered."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QSplitter, QVBoxLayout, QWidget

from mocapstudio.gui import settings

Stretched = tuple[QWidget, int]
"""A part, and its share of the room that a larger window has."""


class Splitters:
    """Columns, and rows of which the columns are the first.

    Parameters
    ----------
    prefix
        Begins the names under which the splitters are found and their sizes remembered.
    """

    def __init__(self, prefix: str = "") -> None:
        self.columns = QSplitter(Qt.Orientation.Horizontal)
        self.rows = QSplitter(Qt.Orientation.Vertical)
        for splitter, name in ((self.columns, "columns"), (self.rows, "rows")):
            splitter.setObjectName(f"{prefix}{name}")
            splitter.setHandleWidth(4)
            splitter.setChildrenCollapsible(False)

    def fill(self, columns: Sequence[Stretched], stretch: int, rows: Sequence[Stretched]) -> None:
        """Put parts into place.

        Parameters
        ----------
        columns
            The columns, from left to right.
        stretch
            That of the columns' row.
        rows
            The rows below the columns.
        """
        _add(self.columns, columns)
        _add(self.rows, ((self.columns, stretch), *rows))

    def remember(self) -> None:
        """Remember sizes."""
        for splitter in (self.columns, self.rows):
            settings.set_layout(splitter.objectName(), splitter.saveState())

    def restore(self) -> bool:
        """Size as remembered; tells whether there was anything to go by."""
        states = [(one, settings.layout(one.objectName())) for one in (self.columns, self.rows)]
        done = [one.restoreState(state) for one, state in states if state is not None]
        return any(done)


def above(stage: QWidget, transport: QWidget) -> QFrame:
    """Return a column of a stage and the transport below it."""
    frame = QFrame()
    column = QVBoxLayout(frame)
    column.setContentsMargins(0, 0, 0, 0)
    column.setSpacing(0)
    column.addWidget(stage, 1)
    column.addWidget(transport)
    return frame


def _add(splitter: QSplitter, parts: Sequence[Stretched]) -> None:
    for index, (part, stretch) in enumerate(parts):
        splitter.addWidget(part)
        splitter.setStretchFactor(index, stretch)
