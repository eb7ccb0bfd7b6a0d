"""A table of what was odd about a file."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtGui import QColor, QResizeEvent
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableWidget, QTableWidgetItem

from mocapstudio.formats import Problem
from mocapstudio.gui import theme
from mocapstudio.gui.dialogs.reading_form import FIELD_TEXTS
from mocapstudio.gui.widgets.parts import Hint

_HEADS = ("Line", "Found", "Done", "", "Decide by")
_LINE, _FOUND, _DONE, _KIND, _BY = range(5)


class ProblemTable(QTableWidget):
    """A row for each oddity: line, what was found, what was done, whether that is a guess."""

    override_wanted = Signal(str)
    """Emitted with a field of `ReadOptions` when its row is clicked."""

    def __init__(self) -> None:
        super().__init__(0, len(_HEADS))
        self.setObjectName("import-problems")
        self.setHorizontalHeaderLabels(list(_HEADS))
        self.verticalHeader().hide()
        self.setShowGrid(False)
        self.setWordWrap(True)
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        head = self.horizontalHeader()
        head.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        head.setHighlightSections(False)
        head.setSectionsClickable(False)
        for column in (_LINE, _KIND, _BY):
            head.setSectionResizeMode(column, QHeaderView.ResizeMode.ResizeToContents)
        for column in (_FOUND, _DONE):
            head.setSectionResizeMode(column, QHeaderView.ResizeMode.Stretch)
        self._problems: tuple[Problem, ...] = ()
        self._hint = Hint(self.viewport(), "import-hint")
        self.cellClicked.connect(self._point)

    def show_problems(self, problems: Sequence[Problem], otherwise: str) -> None:
        """Show oddities, or these words where there are none."""
        self._problems = tuple(problems)
        self.setRowCount(len(self._problems))
        for row, one in enumerate(self._problems):
            cells = {
                _LINE: "–" if one.line is None else str(one.line),
                _FOUND: one.what,
                _DONE: one.done,
                _KIND: "guess" if one.guess else "",
                _BY: FIELD_TEXTS.get(one.override or "", ""),
            }
            for column, text in cells.items():
                item = QTableWidgetItem(text)
                item.setTextAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
                self.setItem(row, column, item)
        self._colour()
        self.resizeRowsToContents()
        self._hint.say("" if self._problems else otherwise)

    def _colour(self) -> None:
        colours = theme.current()
        shown = {_LINE: colours.muted, _KIND: colours.open, _BY: colours.accent}
        for row in range(self.rowCount()):
            for column, colour in shown.items():
                item = self.item(row, column)
                if item is not None:
                    item.setForeground(QColor(colour))

    def _point(self, row: int, _column: int) -> None:
        override = self._problems[row].override
        if override:
            self.override_wanted.emit(override)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Wrap anew."""
        super().resizeEvent(event)
        self.resizeRowsToContents()

    def changeEvent(self, event: QEvent) -> None:
        """Follow the theme."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and hasattr(self, "_problems"):
            self._colour()
