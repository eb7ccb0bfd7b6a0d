"""The queue as a table model, and the filter over it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

from PySide6.QtCore import (
    QAbstractTableModel,
    QModelIndex,
    QObject,
    QPersistentModelIndex,
    QSortFilterProxyModel,
    Qt,
)
from PySide6.QtGui import QColor, QFont

from mocapstudio.gui import icons, theme, wording
from mocapstudio.motion.take import Take
from mocapstudio.review.model import QueueItem, Verdict

Index = QModelIndex | QPersistentModelIndex
_ROOT = QModelIndex()

ITEM_ROLE = int(Qt.ItemDataRole.UserRole)
SORT_ROLE = ITEM_ROLE + 1

VERDICT_ICONS = {
    Verdict.OPEN: "circle",
    Verdict.ACCEPTED: "accept",
    Verdict.REJECTED: "reject",
    Verdict.DEFERRED: "defer",
}


class Column(IntEnum):
    """Columns of the queue, left to right."""

    RANK = 0
    JOINT = 1
    TIME = 2
    FRAME = 3
    SCORE = 4
    KIND = 5
    VERDICT = 6


_TITLES = {
    Column.RANK: ("#", "Rank: 1 is the worst"),
    Column.JOINT: ("Joint", "The flagged joint or root row"),
    Column.TIME: ("Time", "Start of the flag, seconds"),
    Column.FRAME: ("Frame", "First frame, by the file's own numbers"),
    Column.SCORE: ("Score", "How surely it is an error, 0 to 1"),
    Column.KIND: ("Kind", "The likely cause"),
    Column.VERDICT: ("Verdict", "What was decided"),
}


class QueueModel(QAbstractTableModel):
    """Shows the queue of the performer under review, worst first."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._items: tuple[QueueItem, ...] = ()
        self._take: Take | None = None

    @property
    def items(self) -> tuple[QueueItem, ...]:
        """The items shown, in the order of their rank."""
        return self._items

    def show(self, items: tuple[QueueItem, ...], take: Take | None) -> None:
        """Show another queue; selections survive where the flags stay the same."""
        ids = [item.flag.id for item in items]
        same = ids == [item.flag.id for item in self._items] and take is self._take
        if not same:
            self.beginResetModel()
        self._items, self._take = items, take
        if not same:
            self.endResetModel()
        elif items:
            self.dataChanged.emit(self.index(0, 0), self.index(len(items) - 1, Column.VERDICT))

    def row_of(self, flag_id: str | None) -> int | None:
        """Row of a flag, or None."""
        for row, item in enumerate(self._items):
            if item.flag.id == flag_id:
                return row
        return None

    def rowCount(self, parent: Index = _ROOT) -> int:
        """Number of items."""
        return 0 if parent.isValid() else len(self._items)

    def columnCount(self, parent: Index = _ROOT) -> int:
        """Number of columns."""
        return 0 if parent.isValid() else len(Column)

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> Any:
        """Title and explanation of a column."""
        if orientation is not Qt.Orientation.Horizontal:
            return None
        title, tip = _TITLES[Column(section)]
        if role == Qt.ItemDataRole.DisplayRole:
            return title
        if role == Qt.ItemDataRole.ToolTipRole:
            return tip
        if role == Qt.ItemDataRole.TextAlignmentRole:
            return _alignment(Column(section))
        return None

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        """Text, colour and so on of one cell."""
        if not index.isValid() or self._take is None:
            return None
        item, column = self._items[index.row()], Column(index.column())
        if role == Qt.ItemDataRole.DisplayRole:
            return self._text(item, column, index.row())
        if role == ITEM_ROLE:
            return item
        if role == SORT_ROLE:
            return self._sort_key(item, column, index.row())
        if role == Qt.ItemDataRole.TextAlignmentRole:
            return _alignment(column)
        if role == Qt.ItemDataRole.ToolTipRole:
            return self._tip(item)
        return _decoration(item, column, role)

    def _text(self, item: QueueItem, column: Column, row: int) -> str:
        assert self._take is not None
        flag = item.flag
        texts = {
            Column.RANK: str(row + 1),
            Column.JOINT: flag.joint,
            Column.TIME: wording.seconds(self._take, flag.start),
            Column.FRAME: str(wording.number(self._take, flag.start)),
            Column.SCORE: f"{flag.score:.2f}",
            Column.KIND: str(flag.kind),
            Column.VERDICT: str(item.verdict),
        }
        return texts[column]

    def _sort_key(self, item: QueueItem, column: Column, row: int) -> Any:
        flag = item.flag
        keys: dict[Column, Any] = {
            Column.RANK: row,
            Column.JOINT: flag.joint.lower(),
            Column.TIME: flag.start,
            Column.FRAME: flag.start,
            Column.SCORE: flag.score,
            Column.KIND: str(flag.kind),
            Column.VERDICT: list(Verdict).index(item.verdict),
        }
        return keys[column]

    def _tip(self, item: QueueItem) -> str:
        assert self._take is not None
        flag = item.flag
        tip = f"{flag.joint}: {flag.kind}, {wording.span(self._take, flag.start, flag.end)}"
        if not item.current:
            tip += "\nNo longer flagged: decided earlier, kept for the record"
        return tip


@dataclass(frozen=True)
class Filter:
    """Which items the queue shows; None lets all pass."""

    verdict: Verdict | None = None
    kind: str | None = None
    limb: str | None = None
    text: str = ""


class QueueFilter(QSortFilterProxyModel):
    """Filters and sorts the queue."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.setSortRole(SORT_ROLE)
        self._filter = Filter()
        self._limb_of: Mapping[str, str] = {}

    @property
    def filter(self) -> Filter:
        """The filter in force."""
        return self._filter

    def set_filter(self, chosen: Filter, limb_of: Mapping[str, str]) -> None:
        """Show only items that pass.

        Parameters
        ----------
        limb_of
            Name of the limb by row.
        """
        self._filter, self._limb_of = chosen, limb_of
        self.invalidate()

    def filterAcceptsRow(self, row: int, parent: Index) -> bool:
        """Tell whether an item passes."""
        model = self.sourceModel()
        assert isinstance(model, QueueModel)
        return self.passes(model.items[row])

    def passes(self, item: QueueItem) -> bool:
        """Tell whether an item passes the filter in force."""
        chosen, flag = self._filter, item.flag
        if chosen.verdict is not None and item.verdict is not chosen.verdict:
            return False
        if chosen.kind is not None and str(flag.kind) != chosen.kind:
            return False
        if chosen.limb is not None and self._limb_of.get(flag.joint) != chosen.limb:
            return False
        words = chosen.text.lower().split()
        text = f"{flag.joint} {flag.kind} {item.verdict}".lower()
        return all(word in text for word in words)


def _alignment(column: Column) -> Qt.AlignmentFlag:
    right = column in (Column.RANK, Column.TIME, Column.FRAME, Column.SCORE)
    side = Qt.AlignmentFlag.AlignRight if right else Qt.AlignmentFlag.AlignLeft
    return side | Qt.AlignmentFlag.AlignVCenter


def _decoration(item: QueueItem, column: Column, role: int) -> Any:
    now = theme.current()
    if role == Qt.ItemDataRole.FontRole:
        font = QFont(theme.numbers_font())
        font.setItalic(not item.current)
        return font
    if role == Qt.ItemDataRole.ForegroundRole:
        if column is Column.VERDICT:
            return QColor(now.verdict(item.verdict))
        decided = item.verdict in (Verdict.ACCEPTED, Verdict.REJECTED)
        faded = column in (Column.RANK, Column.FRAME) or decided or not item.current
        return QColor(now.muted if faded else now.text)
    if role == Qt.ItemDataRole.DecorationRole and column is Column.VERDICT:
        return icons.pixmap(VERDICT_ICONS[item.verdict], 14, now.verdict(item.verdict))
    return None
