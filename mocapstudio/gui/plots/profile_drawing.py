"""How distance over time is painted: the curve, what is barred, the chosen minima."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen, QPolygonF

from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.axes import small_font
from mocapstudio.gui.plots.profile_curve import F64, envelope
from mocapstudio.gui.theme import Theme
from mocapstudio.motion.runs import runs

if TYPE_CHECKING:
    from mocapstudio.cleaning.distance_profile import TakeDistances

_DOT = 3.0
_BADGE = 7.5
_LIFT = 14.0
NEAR = 9.0
"""Pixels within which a chosen minimum is hit."""


def draw_curve(p: QPainter, look: Theme, part: TakeDistances, x: F64, y: F64) -> None:
    """Draw the distances of one take; where it is barred the curve is faint.

    Parameters
    ----------
    x, y
        (n,) pixels of each value.
    """
    p.setRenderHint(QPainter.RenderHint.Antialiasing)
    _polyline(p, x, y, QPen(QColor(look.faint), 1))
    for first, last in runs(~part.barred):
        _polyline(p, x[first:last], y[first:last], QPen(QColor(look.neighbour), 1.2))
    p.setRenderHint(QPainter.RenderHint.Antialiasing, False)


def _polyline(p: QPainter, x: F64, y: F64, pen: QPen) -> None:
    p.setPen(pen)
    across, down = envelope(x, y)
    pairs = zip(across.tolist(), down.tolist(), strict=True)
    p.drawPolyline(QPolygonF([QPointF(a, b) for a, b in pairs]))


def badge_centres(marks: Iterable[tuple[int, QPointF]], area: QRectF) -> dict[int, QPointF]:
    """Where the numbers of minima go: above them, within the area, side by side where crowded."""
    placed = sorted(marks, key=lambda one: one[1].x())
    if not placed:
        return {}
    room = 2 * _BADGE + 2
    low, high = area.left() + _BADGE + 1, area.right() - _BADGE - 1
    x = np.array([at.x() for _, at in placed])
    # Each pushed to the right of the one before, and as far to the left of the one after; the
    # middle of both keeps a crowd above its minima.
    steps = room * np.arange(len(x))
    right = np.maximum.accumulate(x - steps) + steps
    left = np.minimum.accumulate((x - steps)[::-1])[::-1] + steps
    x = 0.5 * (right + left)
    x = np.maximum(x, low + steps)
    x = np.minimum(x, high - steps[::-1])
    heights = [max(at.y() - _LIFT, area.top() + _BADGE + 1) for _, at in placed]
    return {
        number: QPointF(across, height)
        for (number, _), across, height in zip(placed, x.tolist(), heights, strict=True)
    }


def draw_marks(
    p: QPainter,
    look: Theme,
    area: QRectF,
    marks: Iterable[tuple[int, QPointF]],
    chosen: int | None,
) -> None:
    """Draw the chosen minima with their numbers, the nearest and the chosen one on top."""
    p.setRenderHint(QPainter.RenderHint.Antialiasing)
    p.setFont(small_font(10))
    marks = sorted(marks, key=lambda one: (one[0] == chosen, -one[0]))
    centres = badge_centres(marks, area)
    for number, at in marks:
        p.setPen(QPen(QColor(look.neighbour), 1))
        p.drawLine(at, centres[number])
    for number, at in marks:
        lit, centre = number == chosen, centres[number]
        p.setPen(QPen(QColor(look.field), 1.5))
        p.setBrush(QColor(look.accent if lit else look.neighbour))
        p.drawEllipse(at, _DOT, _DOT)
        p.setBrush(QColor(look.accent if lit else look.raised))
        p.setPen(QPen(QColor(look.accent if lit else look.neighbour), 1))
        p.drawEllipse(centre, _BADGE, _BADGE)
        p.setPen(QColor(look.accent_text if lit else look.text))
        box = QRectF(centre.x() - 10, centre.y() - 8, 20, 16)
        p.drawText(box, int(Qt.AlignmentFlag.AlignCenter), str(number + 1))
    p.setBrush(Qt.BrushStyle.NoBrush)
    p.setRenderHint(QPainter.RenderHint.Antialiasing, False)


def hit(at: QPointF, marks: Iterable[tuple[int, QPointF]], area: QRectF) -> int | None:
    """Return the number of the minimum at a place, the nearest of several, or None."""
    found = []
    marks = list(marks)
    centres = badge_centres(marks, area)
    for number, place in marks:
        for one in (place, centres[number]):
            away = float(np.hypot(at.x() - one.x(), at.y() - one.y()))
            if away <= NEAR:
                found.append((away, number))
    return min(found)[1] if found else None


def draw_levels(p: QPainter, look: Theme, area: QRectF, heights: Iterable[float]) -> None:
    """Draw thin lines across at heights in pixels."""
    p.setPen(QPen(colours.mixed(look.field, look.border, 0.5), 1))
    for y in heights:
        p.drawLine(QPointF(area.left(), y), QPointF(area.right(), y))
