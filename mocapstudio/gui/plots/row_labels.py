"""Names left of the digression map: limbs always, rows as far as there is room."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QFontMetricsF,
    QHelpEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
)
from PySide6.QtWidgets import QToolTip, QWidget

from mocapstudio.gui import theme as themes
from mocapstudio.gui.plots.axes import small_font
from mocapstudio.gui.plots.rows import Group, RowLayout
from mocapstudio.gui.plots.time_plot import LEFT_GUTTER

_LIMB_ROOM = 66.0
_LEGIBLE = 11
_LINE = 13.0
_LIMB_LINE = 10.0
_FOOT = 13.0
"""Height of the notes below the rows."""


class RowLabels(QWidget):
    """Limb names and row names beside the map.

    Where rows are too thin for all names, the selected row, the one under the mouse and the rows
    with the worst flags keep theirs, as far as they do not cover each other; the tool tip gives
    the rest.
    """

    rows_clicked = Signal(object, bool)
    """Names of the rows (frozenset), and whether they add to the selection."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setFixedWidth(LEFT_GUTTER)
        self.setMouseTracking(True)
        self._rows = RowLayout((), 0)
        self._top = 0
        self._selected: frozenset[str] = frozenset()
        self._hovered: str | None = None
        self._worst: tuple[str, ...] = ()
        self._edits = False
        self._left_out: tuple[str, ...] = ()

    def sizeHint(self) -> QSize:
        """As wide as the gutter."""
        return QSize(LEFT_GUTTER, 120)

    def set_rows(self, rows: RowLayout, top: int) -> None:
        """Say which rows there are, and how far down the first begins."""
        self._rows, self._top = rows, top
        self.update()

    def set_marks(
        self, selected: frozenset[str], worst: Sequence[str], hovered: str | None, edits: bool
    ) -> None:
        """Say which rows matter: selected, flagged (worst first), under the mouse; any edits."""
        marks = (selected, tuple(worst), hovered, edits)
        if marks != (self._selected, self._worst, self._hovered, self._edits):
            self._selected, self._worst, self._hovered, self._edits = marks
            self.update()

    def set_left_out(self, names: tuple[str, ...]) -> None:
        """Say which joints have no row, because they were not analysed."""
        if names != self._left_out:
            self._left_out = names
            self.update()

    def shown_names(self) -> tuple[str, ...]:
        """Rows whose names are drawn."""
        if self._rows.row_height >= _LEGIBLE:
            return self._rows.names
        placed: list[float] = []
        chosen = []
        hovered = () if self._hovered is None else (self._hovered,)
        picked = [name for name in self._rows.names if name in self._selected]
        for name in (*hovered, *picked, *self._worst):
            middle = self._middle(name)
            if middle is not None and all(abs(middle - other) >= _LINE for other in placed):
                placed.append(middle)
                chosen.append(name)
        return tuple(chosen)

    def _middle(self, name: str) -> float | None:
        if name not in self._rows.index:
            return None
        top = float(self._rows.tops[self._rows.index[name]])
        return self._top + top + 0.5 * self._rows.row_height

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw the names."""
        look = themes.current()
        p = QPainter(self)
        p.fillRect(self.rect(), QColor(look.panel))
        p.setFont(small_font())
        last = -_LINE
        for group in self._rows.groups:
            last = self._draw_limb(p, look, group, last)
        metrics = QFontMetricsF(small_font())
        for name in self.shown_names():
            self._draw_name(p, look, metrics, name)
        left = _LIMB_ROOM + 12
        if self._edits:
            self._draw_note(p, look, QRectF(0, self._foot(), _LIMB_ROOM, _FOOT), "edits")
        if self._left_out:
            room = QRectF(left, self._foot(), self.width() - left - 8, _FOOT)
            self._draw_note(p, look, room, f"{len(self._left_out)} not analysed")
        p.end()

    def _foot(self) -> float:
        return self.height() - _FOOT

    def _draw_note(self, p: QPainter, look: themes.Theme, room: QRectF, text: str) -> None:
        p.setFont(small_font(10))
        p.setPen(QColor(look.faint))
        p.drawText(room, int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter), text)

    def _draw_limb(self, p: QPainter, look: themes.Theme, group: Group, last: float) -> float:
        """Draw a limb's name where it has room below the one at height `last`."""
        top, bottom = (self._top + edge for edge in self._rows.extent(group))
        chosen = bool(self._selected) and bool(self._selected & set(group.rows))
        p.setPen(QPen(QColor(look.faint if chosen else look.border), 1))
        edge = _LIMB_ROOM + 6
        p.drawLine(QPointF(edge, top), QPointF(edge, max(bottom - 1, top)))
        p.setPen(QColor(look.text if chosen else look.muted))
        middle = 0.5 * (top + bottom)
        if middle - last < _LIMB_LINE:
            return last
        room = QRectF(0, middle - 8, _LIMB_ROOM, 16)
        flags = int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        p.drawText(room, flags, group.name)
        return middle

    def _draw_name(
        self, p: QPainter, look: themes.Theme, metrics: QFontMetricsF, name: str
    ) -> None:
        middle = self._middle(name)
        if middle is None:
            return
        left = _LIMB_ROOM + 12
        room = QRectF(left, middle - 8, self.width() - left - 6, 16)
        text = metrics.elidedText(name, Qt.TextElideMode.ElideMiddle, room.width() - 6)
        selected, hovered = name in self._selected, name == self._hovered
        if selected or hovered:
            width = metrics.horizontalAdvance(text) + 10
            pill = QRectF(room.right() - width + 3, middle - 7.5, width, 15)
            p.setRenderHint(QPainter.RenderHint.Antialiasing)
            p.setPen(Qt.PenStyle.NoPen)
            p.setBrush(QColor(look.selection if selected else look.raised))
            p.drawRoundedRect(pill, 4, 4)
            p.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        p.setPen(QColor(look.text if selected or hovered else look.muted))
        flags = int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        p.drawText(room.adjusted(0, 0, -2, 0), flags, text)

    def _rows_at(self, at: QPointF) -> tuple[str, ...]:
        y = at.y() - self._top
        if at.x() <= _LIMB_ROOM + 6:
            group = self._rows.group_at(y)
            return group.rows if group is not None else ()
        shown = [(abs((self._middle(n) or 0.0) - at.y()), n) for n in self.shown_names()]
        if self._rows.row_height < _LEGIBLE and shown and min(shown)[0] <= 0.5 * _LINE:
            return (min(shown)[1],)
        row = self._rows.row_at(y)
        return (row,) if row is not None else ()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Select a row or a limb; with Ctrl in addition."""
        rows = self._rows_at(event.position())
        if event.button() == Qt.MouseButton.LeftButton and rows:
            adds = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
            self.rows_clicked.emit(frozenset(rows), adds)

    def event(self, event: QEvent) -> bool:
        """Answer with full names where the tool tip is asked for."""
        if isinstance(event, QHelpEvent) and event.type() == QEvent.Type.ToolTip:
            at = QPointF(event.pos())
            words = "\n".join(self._rows_at(at))
            if self._left_out and at.y() >= self._foot():
                words = f"Not analysed: {', '.join(self._left_out)}"
            QToolTip.showText(event.globalPos(), words, self)
            return True
        return super().event(event)
