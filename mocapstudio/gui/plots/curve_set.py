"""The curves of one row: three components each of original, result and proposal."""

from __future__ import annotations

from enum import StrEnum

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QPen
from PySide6.QtWidgets import QGraphicsItem

from mocapstudio.gui import theme as themes
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.quantities import Curves

_MOST_COMPONENTS = 3
_PADDING = 0.08


class Role(StrEnum):
    """Whose motion a curve shows."""

    ORIGINAL = "original"
    RESULT = "result"
    PROPOSAL = "proposal"


def pen(theme: themes.Theme, role: Role, name: str, alone: bool) -> QPen:
    """Pen of a component: the original faint beside a result, the proposal dashed."""
    colour = colours.component(theme, name)
    if role is Role.ORIGINAL and not alone:
        colour = colours.mixed(colour, theme.field, 0.55)
    if role is Role.PROPOSAL:
        colour = colours.mixed(colour, QColor(theme.text), 0.45)
    line = QPen(colour, 1)
    line.setCosmetic(True)
    if role is Role.PROPOSAL:
        line.setStyle(Qt.PenStyle.CustomDashLine)
        line.setDashPattern([5, 3])
    return line


class CurveSet:
    """Curve items of one plot, one for each role and component, kept and given other data.

    Parameters
    ----------
    plot
        Where they are added.
    """

    def __init__(self, plot: pg.PlotItem) -> None:
        self._items: dict[Role, list[pg.PlotDataItem]] = {}
        self._data: dict[Role, tuple[int, Curves] | None] = dict.fromkeys(Role)
        for z, role in enumerate(Role):
            self._items[role] = [_curve_item(z) for _ in range(_MOST_COMPONENTS)]
            for item in self._items[role]:
                plot.addItem(item)

    def set(self, role: Role, curves: Curves | None, start: int = 0) -> None:
        """Show curves whose first value lies at frame `start`, or none."""
        self._data[role] = None if curves is None else (start, curves)
        for number, item in enumerate(self._items[role]):
            shown = curves is not None and number < curves.values.shape[1]
            item.setVisible(shown)
            if shown and curves is not None:
                frames = np.arange(start, start + len(curves.values), dtype=np.float64)
                item.setData(frames, curves.values[:, number])
            else:
                item.setData([], [])
        self.restyle()

    def curves(self, role: Role) -> Curves | None:
        """What a role shows."""
        data = self._data[role]
        return None if data is None else data[1]

    def start(self, role: Role) -> int:
        """Frame of the first value of a role."""
        data = self._data[role]
        return 0 if data is None else data[0]

    def value(self, role: Role, frame: int) -> NDArray[np.float64] | None:
        """(C,) values of a role at a frame, or None where it has none."""
        data = self._data[role]
        if data is None or not 0 <= frame - data[0] < len(data[1].values):
            return None
        values: NDArray[np.float64] = data[1].values[frame - data[0]]
        return values

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        look = themes.current()
        alone = self._data[Role.RESULT] is None
        for role, items in self._items.items():
            curves = self.curves(role)
            for item, name in zip(items, () if curves is None else curves.names, strict=False):
                item.setPen(pen(look, role, name, alone))

    def extent(self, start: float, end: float, least: float) -> tuple[float, float] | None:
        """Lowest and highest value between two frames, padded, at least `least` apart."""
        lows, highs = [], []
        for data in self._data.values():
            if data is None:
                continue
            first = max(int(np.floor(start)) - data[0], 0)
            part = data[1].values[first : max(int(np.ceil(end)) + 1 - data[0], 0)]
            part = part[np.isfinite(part)]
            if part.size:
                lows.append(float(part.min()))
                highs.append(float(part.max()))
        if not lows:
            return None
        low, high = min(lows), max(highs)
        missing = max(least - (high - low), 0.0)
        pad = _PADDING * max(high - low, least)
        return low - 0.5 * missing - pad, high + 0.5 * missing + pad


def differing(a: Curves, b: Curves) -> tuple[int, int]:
    """Half-open span, a frame wider on both sides, outside of which two motions are the same."""
    apart = np.flatnonzero((np.abs(a.values - b.values) > 1e-9).any(axis=1))
    if not apart.size:
        return 0, 0
    return max(int(apart[0]) - 1, 0), min(int(apart[-1]) + 2, len(a.values))


def _curve_item(z: int) -> pg.PlotDataItem:
    item = pg.PlotDataItem(
        clipToView=True,
        autoDownsample=True,
        downsampleMethod="peak",
        autoDownsampleFactor=2.0,
        antialias=True,
        skipFiniteCheck=False,
    )
    item.setZValue(z)
    # Kept as a picture, so that a moving play head does not trace every curve again.
    item.curve.setCacheMode(QGraphicsItem.CacheMode.DeviceCoordinateCache)
    return item
