"""How cells of the queue are drawn: a verdict edge at each row, scores as number and bar."""

from __future__ import annotations

from PySide6.QtCore import QModelIndex, QPersistentModelIndex, QRectF, Qt
from PySide6.QtGui import QColor, QPainter
from PySide6.QtWidgets import QStyledItemDelegate, QStyleOptionViewItem

from mocapstudio.gui import theme
from mocapstudio.gui.queue.model import ITEM_ROLE, Column
from mocapstudio.review.model import Verdict


class QueueDelegate(QStyledItemDelegate):
    """Draws the edge in the verdict's colour, and under each score a bar of its length."""

    def paint(
        self,
        painter: QPainter,
        option: QStyleOptionViewItem,
        index: QModelIndex | QPersistentModelIndex,
    ) -> None:
        """Draw one cell."""
        super().paint(painter, option, index)
        item = index.data(ITEM_ROLE)
        if item is None:
            return
        now = theme.current()
        area = QRectF(option.rect)
        if index.column() == Column.RANK and item.verdict is not Verdict.OPEN:
            edge = QRectF(area.left(), area.top() + 2, 3, area.height() - 4)
            painter.fillRect(edge, QColor(now.verdict(item.verdict)))
        if index.column() == Column.SCORE:
            track = QRectF(area.left() + 6, area.bottom() - 4, area.width() - 12, 2)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.fillRect(track, QColor(now.border))
            decided = item.verdict in (Verdict.ACCEPTED, Verdict.REJECTED)
            track.setWidth(track.width() * min(1.0, max(0.0, item.flag.score)))
            painter.fillRect(track, QColor(now.muted if decided else now.accent))
