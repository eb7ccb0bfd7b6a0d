"""The plot of the lanes: where each marker is measured, filled, missing."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QBrush, QColor, QImage, QPainter, QPen

from mocapstudio.gui import theme as themes
from mocapstudio.gui.markers.lane_drawing import Cell, cell_colour, pooled
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.layers import Layer
from mocapstudio.gui.plots.rows import Group, RowLayout
from mocapstudio.gui.plots.time_plot import TimePlot
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.motion.declared import Declared


class LanePlot(TimePlot):
    """Markers × frames under a time axis; a click goes there, Shift and drag chooses a span.

    Parameters
    ----------
    time_range
        The visible frames.
    """

    def __init__(self, time_range: TimeRange) -> None:
        self.rows = RowLayout((), 0)
        self._groups: tuple[Group, ...] = ()
        self._cells: NDArray[np.uint8] = np.zeros((1, 0), np.uint8)
        self._order: list[int] = []
        self._marker: str | None = None
        self._span: tuple[int, int] | None = None
        self._protected: Sequence[Declared] = ()
        super().__init__(time_range, axis="top")
        self.setObjectName("markers-lanes-plot")
        self._picture = self.add_layer(Layer(self._draw_cells, cached=True), -1)
        self._marks = self.add_layer(Layer(self._draw_marks, cached=True), 1)

    def show_cells(
        self, found: NDArray[np.uint8], labels: tuple[str, ...], groups: tuple[Group, ...]
    ) -> None:
        """Show (F, M) cells of markers, in the order of their groups."""
        index = {label: i for i, label in enumerate(labels)}
        self._groups = groups
        self._order = [index[name] for group in groups for name in group.rows]
        self._cells = np.ascontiguousarray(found[:, self._order])
        self._lay_out()
        self._picture.refresh()
        self._marks.refresh()

    def mark(self, marker: str | None, span: tuple[int, int] | None) -> None:
        """Mark the chosen marker and span."""
        if (marker, span) != (self._marker, self._span):
            self._marker, self._span = marker, span
            self._marks.refresh()

    def protect(self, protected: Sequence[Declared]) -> None:
        """Mark what nothing may change."""
        if protected != self._protected:
            self._protected = protected
            self._marks.refresh()

    def marker_at(self, at: QPointF) -> str | None:
        """Label of the marker at a place of the widget, or None."""
        return self.rows.row_at(at.y() - self.area.top())

    def cell_at(self, marker: str, frame: int) -> Cell:
        """What is known of a marker in a frame."""
        return Cell(int(self._cells[frame, self.rows.index[marker]]))

    def holds(self, at: QPointF) -> bool:
        """Every lane is something that a click is meant for."""
        return self.marker_at(at) is not None

    def _lay_out(self) -> None:
        self.rows = RowLayout(self._groups, int(self.area.height()))

    def _draw_cells(self, p: QPainter, area: QRectF) -> None:
        self._lay_out()
        width, height = int(area.width()), self.rows.bottom
        if not self._order or width < 1 or height < 1:
            return
        look, shown = themes.current(), self.time_range
        table = np.array([cell_colour(look, cell).rgb() for cell in Cell], dtype=np.uint32)
        rows = table[pooled(self._cells, shown.start, shown.length, width)].T
        image = np.full((height, width), QColor(look.field).rgb(), dtype=np.uint32)
        thick = max(self.rows.row_height - (1 if self.rows.row_height > 5 else 0), 1)
        for row, top in enumerate(self.rows.tops):
            image[top : top + thick] = rows[row]
        picture = QImage(image.data, width, height, 4 * width, QImage.Format.Format_RGB32)
        p.drawImage(QPointF(area.left(), area.top()), picture)

    def _draw_marks(self, p: QPainter, area: QRectF) -> None:
        look = themes.current()
        height = max(self.rows.row_height - 1, 2)
        for one in self._protected:
            top = area.top() + float(self.rows.tops[self.rows.index[one.row]])
            left, right = self.x_of(one.start - 0.5), self.x_of(one.end - 0.5)
            box = QRectF(left, top, max(right - left, 2), height)
            p.fillRect(box, colours.faded(look.protected, 0.35))
            p.fillRect(box, QBrush(QColor(look.protected), Qt.BrushStyle.BDiagPattern))
        if self._marker not in self.rows.index:
            return
        top = area.top() + float(self.rows.tops[self.rows.index[self._marker]])
        p.setPen(QPen(QColor(look.accent), 1))
        row = QRectF(area.left(), top - 1, area.width() - 1, height + 1)
        p.drawLine(row.topLeft(), row.topRight())
        p.drawLine(row.bottomLeft(), row.bottomRight())
        if self._span is None:
            return
        left = self.x_of(self._span[0] - 0.5)
        right = max(self.x_of(self._span[1] - 0.5), left + 2)
        box = QRectF(left, area.top(), right - left, self.rows.bottom)
        p.fillRect(box, colours.faded(look.accent, 0.12))
        p.setPen(QPen(QColor(look.text), 2))
        p.drawRect(QRectF(left - 1, top - 2, right - left + 2, height + 3))
