"""Tables in the desk's style: columns with titles and tips, rows chosen whole."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from PySide6.QtCore import QAbstractItemModel, Qt
from PySide6.QtWidgets import QHeaderView, QTableView

from mocapstudio.gui import theme

Columns = Sequence[tuple[str, str]]
"""Title and tip of each column."""


def column_header(
    columns: Columns, numbers_from: int, section: int, orientation: Qt.Orientation, role: int
) -> Any:
    """Say what a model says of a column's head; numbers, and their titles, stand at the right."""
    if orientation is not Qt.Orientation.Horizontal:
        return None
    if role == Qt.ItemDataRole.DisplayRole:
        return columns[section][0]
    if role == Qt.ItemDataRole.ToolTipRole:
        return columns[section][1]
    if role == Qt.ItemDataRole.TextAlignmentRole:
        right, left = Qt.AlignmentFlag.AlignRight, Qt.AlignmentFlag.AlignLeft
        return int((right if section >= numbers_from else left) | Qt.AlignmentFlag.AlignVCenter)
    return None


def make_table(
    name: str, model: QAbstractItemModel, widths: Sequence[int], row_height: int
) -> QTableView:
    """Make a table without grid whose rows are chosen one at a time.

    Parameters
    ----------
    widths
        Of the columns, pixels; 0 for those that take what is left.
    """
    table = QTableView()
    table.setObjectName(name)
    table.setModel(model)
    table.setShowGrid(False)
    table.setSelectionBehavior(QTableView.SelectionBehavior.SelectRows)
    table.setSelectionMode(QTableView.SelectionMode.SingleSelection)
    table.setTextElideMode(Qt.TextElideMode.ElideMiddle)
    table.setWordWrap(False)
    table.setFont(theme.numbers_font())
    table.verticalHeader().hide()
    table.verticalHeader().setDefaultSectionSize(row_height)
    head = table.horizontalHeader()
    head.setHighlightSections(False)
    head.setMinimumSectionSize(20)
    modes = QHeaderView.ResizeMode
    for section, width in enumerate(widths):
        head.setSectionResizeMode(section, modes.Fixed if width else modes.Stretch)
        if width:
            head.resizeSection(section, width)
    return table
