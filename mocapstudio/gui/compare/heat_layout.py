"""Where what stands in the plot of colours: bands, rows, lanes, and the reference's own axis."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, auto
from typing import Any

from PySide6.QtCore import QPointF, QRectF
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen
from PySide6.QtWidgets import QGraphicsItem

from mocapstudio.comparison.model import Comparison
from mocapstudio.gui import theme as themes
from mocapstudio.gui.compare.layout import Stretch
from mocapstudio.gui.plots.axes import TimeAxis
from mocapstudio.gui.plots.rows import Group

LANE = 17
_LEAST_BETWEEN = 30.0


class Side(Enum):
    """Whose band of the plot a place lies in."""

    SOURCE = auto()
    BETWEEN = auto()
    REFERENCE = auto()
    LANE = auto()


@dataclass(frozen=True)
class Bands:
    """The plot cut into bands, from above: carried segments, source, lines, reference, segments.

    Parameters
    ----------
    area
        The plot, pixels.
    rows
        Height of the rows of one performance, pixels.
    """

    area: QRectF
    rows: int

    @property
    def carried(self) -> QRectF:
        """Lane of the segments as carried over to the source."""
        return QRectF(self.area.left(), self.area.top(), self.area.width(), LANE)

    @property
    def source(self) -> QRectF:
        """The source's rows."""
        top = self.area.top() + LANE
        return QRectF(self.area.left(), top, self.area.width(), self.rows)

    @property
    def reference(self) -> QRectF:
        """The reference's rows."""
        top = self.area.bottom() - LANE - self.rows
        return QRectF(self.area.left(), top, self.area.width(), self.rows)

    @property
    def between(self) -> QRectF:
        """Where lines join what matches."""
        return QRectF(self.source.bottomLeft(), self.reference.topRight())

    @property
    def lane(self) -> QRectF:
        """Lane of the segments of the reference."""
        left, top = self.area.left(), self.area.bottom() - LANE
        return QRectF(left, top, self.area.width(), LANE)

    def side(self, y: float) -> Side:
        """Whose band a height lies in; the carried lane belongs to the source."""
        if y < self.source.bottom():
            return Side.SOURCE
        if y < self.reference.top():
            return Side.BETWEEN
        return Side.REFERENCE if y < self.lane.top() else Side.LANE

    @staticmethod
    def room(height: float) -> int:
        """Pixels that the rows of one performance may take in a plot of that height."""
        between = max(_LEAST_BETWEEN, 0.17 * height)
        return max(int((height - 2 * LANE - between) / 2), 1)


def limb_groups(comparison: Comparison) -> tuple[Group, ...]:
    """Rows of a comparison by limb, in the order of the body."""
    limbs: dict[str, list[str]] = {}
    for row, limb in zip(comparison.rows, comparison.limbs, strict=True):
        limbs.setdefault(limb, []).append(row)
    return tuple(Group(name, tuple(rows)) for name, rows in limbs.items())


class ReferenceAxis(TimeAxis):
    """A time axis of the reference's frames, whatever the plot's own x axis is."""

    def __init__(self) -> None:
        super().__init__("bottom")
        self._stretch = Stretch(-0.5, 0.5)

    def set_stretch(self, stretch: Stretch) -> None:
        """Say which reference frames stand at the plot's edges."""
        if stretch != self._stretch:
            self._stretch = stretch
            self.setRange(stretch.start, stretch.end)
            self.update()

    def linkedViewChanged(self, _view: Any, _range: Any = None) -> None:
        """Keep to the reference."""


class TwinHead(QGraphicsItem):
    """The two play heads and the line that joins them."""

    def __init__(self) -> None:
        super().__init__()
        self._bands: Bands | None = None
        self._source = self._reference = 0.0
        self.setZValue(100)

    def place(self, bands: Bands, source: float, reference: float) -> None:
        """Put the heads at two x pixels."""
        if (bands, source, reference) != (self._bands, self._source, self._reference):
            self.prepareGeometryChange()
            self._bands, self._source, self._reference = bands, source, reference

    def boundingRect(self) -> QRectF:
        """Both heads and what is between them, within the plot."""
        if self._bands is None:
            return QRectF()
        left, right = sorted((self._source, self._reference))
        area = self._bands.area
        return QRectF(left - 5, area.top(), right - left + 10, area.height()) & area

    def shape(self) -> QPainterPath:
        """Nothing: the plot itself decides what a click means."""
        return QPainterPath()

    def paint(self, painter: QPainter, _option: Any, _widget: Any = None) -> None:
        """Draw both heads."""
        if self._bands is None:
            return
        bands = self._bands
        painter.setClipRect(bands.area)
        painter.setPen(QPen(QColor(themes.current().playhead), 1))
        top, bottom = bands.source.bottom(), bands.reference.top()
        painter.drawLine(QPointF(self._source, bands.area.top()), QPointF(self._source, top))
        painter.drawLine(
            QPointF(self._reference, bottom), QPointF(self._reference, bands.area.bottom())
        )
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(QColor(themes.current().playhead), 1.6))
        painter.drawLine(QPointF(self._source, top), QPointF(self._reference, bottom))
