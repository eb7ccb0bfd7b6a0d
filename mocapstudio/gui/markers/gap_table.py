"""The list of markers with their gaps, worst first."""

from __future__ import annotations

from enum import IntEnum
from typing import Any

from PySide6.QtCore import (
    QAbstractTableModel,
    QItemSelectionModel,
    QModelIndex,
    QObject,
    QPersistentModelIndex,
    QSignalBlocker,
    Qt,
)
from PySide6.QtGui import QColor, QResizeEvent
from PySide6.QtWidgets import QAbstractItemView, QFrame, QHeaderView, QTableView, QVBoxLayout

from mocapstudio.gui import theme
from mocapstudio.gui.markers.bridge import MarkersBridge, MarkersShown
from mocapstudio.gui.markers.chooser import TakeChooser
from mocapstudio.gui.widgets.parts import header, label
from mocapstudio.gui.widgets.tables import column_header
from mocapstudio.review.marker_gaps import MarkerGaps

Index = QModelIndex | QPersistentModelIndex
_ROOT = QModelIndex()


class Column(IntEnum):
    """Columns of the list, left to right."""

    MARKER = 0
    GAPS = 1
    LONGEST = 2
    MISSING = 3
    FILLED = 4


_TITLES = {
    Column.MARKER: ("Marker", "Its label in the file"),
    Column.GAPS: ("Gaps", "How many gaps are left"),
    Column.LONGEST: ("Longest", "Frames of the longest gap"),
    Column.MISSING: ("Missing", "Share of the frames in which it is missing"),
    Column.FILLED: ("Filled", "Share of the frames in which it was filled, not measured"),
}
_WIDTHS = {Column.GAPS: 46, Column.LONGEST: 62, Column.MISSING: 62, Column.FILLED: 62}


_ROOMY = 340
"""Pixels from which there is room for the last column."""


class GapModel(QAbstractTableModel):
    """Shows what is missing of each marker."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._markers: tuple[MarkerGaps, ...] = ()

    def show(self, markers: tuple[MarkerGaps, ...]) -> None:
        """Show other markers."""
        if markers != self._markers:
            self.beginResetModel()
            self._markers = markers
            self.endResetModel()

    def row_of(self, label: str | None) -> int | None:
        """Row of a marker, or None."""
        return next((i for i, one in enumerate(self._markers) if one.label == label), None)

    def label(self, row: int) -> str:
        """Label of a row's marker."""
        return self._markers[row].label

    def rowCount(self, parent: Index = _ROOT) -> int:
        """Number of markers."""
        return 0 if parent.isValid() else len(self._markers)

    def columnCount(self, parent: Index = _ROOT) -> int:
        """Number of columns."""
        return 0 if parent.isValid() else len(Column)

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> Any:
        """Title and explanation of a column."""
        return column_header(tuple(_TITLES.values()), Column.GAPS, section, orientation, role)

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        """Text, colour and so on of one cell."""
        if not index.isValid():
            return None
        one, look = self._markers[index.row()], theme.current()
        if role == Qt.ItemDataRole.DisplayRole:
            return _text(one, Column(index.column()))
        if role == Qt.ItemDataRole.TextAlignmentRole:
            return _alignment(index.column())
        if role == Qt.ItemDataRole.ToolTipRole:
            never = " is never seen: nothing can bring it back" if one.never_seen else ""
            return f"{one.label}{never}"
        if role == Qt.ItemDataRole.ForegroundRole:
            if one.never_seen:
                return QColor(look.faint)
            if index.column() == Column.FILLED and one.filled:
                return QColor(look.result)
            whole = not one.gaps and index.column() != Column.MARKER
            return QColor(look.faint if whole else look.text)
        return None


class GapTable(QFrame):
    """Lists the markers; a row chooses its marker, and the first gap of it after the play head.

    Parameters
    ----------
    bridge
        What is shown and chosen.
    """

    def __init__(self, bridge: MarkersBridge) -> None:
        super().__init__()
        self.setObjectName("markers-list")
        self.setProperty("role", "panel")
        self.setMinimumWidth(290)
        self._bridge = bridge
        self._model = GapModel(self)
        self._count = label("", "muted", "markers-count")
        self._table = self._make_table()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(header("Markers", self._count, TakeChooser(bridge)))
        column.addWidget(self._table, 1)
        self._table.clicked.connect(lambda index: self._choose(index.row()))
        bridge.changed.connect(self._follow)
        self._show(bridge.shown)

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        self._table.viewport().update()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Leave out the column that there is no room for."""
        super().resizeEvent(event)
        self._show(self._bridge.shown)

    def _make_table(self) -> QTableView:
        table = QTableView()
        table.setObjectName("markers-table")
        table.setModel(self._model)
        table.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        table.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        table.setShowGrid(False)
        table.setTextElideMode(Qt.TextElideMode.ElideMiddle)
        table.setWordWrap(False)
        table.verticalHeader().hide()
        table.verticalHeader().setDefaultSectionSize(24)
        head = table.horizontalHeader()
        head.setHighlightSections(False)
        head.setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        head.setSectionResizeMode(Column.MARKER, QHeaderView.ResizeMode.Stretch)
        for column, width in _WIDTHS.items():
            table.setColumnWidth(column, width)
        return table

    def _choose(self, row: int) -> None:
        name, shown = self._model.label(row), self._bridge.shown
        one = shown.gaps.by_label[name]
        spans = sorted(one.gaps or one.filled)
        if one.never_seen or not spans:
            self._bridge.choose(name)
            return
        again = shown.marker == name and shown.span in spans
        first = shown.frame + 1 if again else shown.frame
        gap = next((span for span in spans if span[0] >= first), spans[0])
        self._bridge.choose(name, gap[0])

    def _follow(self, old: MarkersShown, new: MarkersShown) -> None:
        if (old.gaps, old.marker) != (new.gaps, new.marker):
            self._show(new)

    def _show(self, shown: MarkersShown) -> None:
        self._model.show(shown.gaps.markers)
        anything = any(one.filled for one in shown.gaps.markers)
        narrow = self.width() < _ROOMY
        self._table.setColumnHidden(Column.FILLED, narrow or not anything)
        left = len(shown.gaps.in_time)
        self._count.setText(f"{left} gap{'' if left == 1 else 's'}" if shown.result else "")
        row = self._model.row_of(shown.marker)
        selection = self._table.selectionModel()
        with QSignalBlocker(selection):
            selection.clearSelection()
            if row is not None:
                index = self._model.index(row, 0)
                flags = QItemSelectionModel.SelectionFlag
                selection.select(index, flags.ClearAndSelect | flags.Rows)
                self._table.scrollTo(index)
        self._table.viewport().update()


def _text(one: MarkerGaps, column: Column) -> str:
    if column is Column.MARKER:
        return one.label
    if one.never_seen:
        return "never" if column is Column.MISSING else ""
    return {
        Column.GAPS: str(len(one.gaps)) if one.gaps else "–",
        Column.LONGEST: str(one.longest) if one.gaps else "–",
        Column.MISSING: _share(one.share),
        Column.FILLED: _share(one.share_filled),
    }[column]


def _share(share: float) -> str:
    if share == 0:
        return "–"
    return f"{share:.1%}" if share >= 0.001 else "<0.1%"


def _alignment(column: int) -> Qt.AlignmentFlag:
    side = Qt.AlignmentFlag.AlignLeft if column == Column.MARKER else Qt.AlignmentFlag.AlignRight
    return side | Qt.AlignmentFlag.AlignVCenter
