"""How much each joint counts, as a bar chart, the heaviest first."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFontMetricsF, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QScrollArea, QVBoxLayout, QWidget

from mocapstudio.comparison.weights import JointWeights
from mocapstudio.gui import theme as themes
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.live_bridge import LiveBridge
from mocapstudio.gui.compare.weight_rows import WeightRow, weight_rows
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.axes import small_font
from mocapstudio.gui.widgets.parts import ElidedLabel, label
from mocapstudio.motion.errors import MocapError

_ROW = 19
_SIDE = 12.0
_NAMES = 0.42
_FIGURE = 40.0
_LEFT = int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
_RIGHT = int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)


class WeightBars(QWidget):
    """A row a joint: its name, a bar of two parts, and the sum."""

    picked = Signal(str)
    """Name of the row that was clicked."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("weight-bars")
        self._rows: tuple[WeightRow, ...] = ()
        self._chosen: str | None = None

    @property
    def rows(self) -> tuple[WeightRow, ...]:
        """What is shown, from above."""
        return self._rows

    def show_rows(self, rows: tuple[WeightRow, ...]) -> None:
        """Show other weights."""
        if rows != self._rows:
            self._rows = rows
            self.setMinimumHeight(_ROW * len(rows) + 8)
            self.updateGeometry()
            self.update()

    def choose(self, name: str | None) -> None:
        """Mark the row of the selected joint."""
        if name != self._chosen:
            self._chosen = name
            self.update()

    def sizeHint(self) -> QSize:
        """As high as the rows."""
        return QSize(200, _ROW * len(self._rows) + 8)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Pick a row."""
        at = int((event.position().y() - 4) // _ROW)
        if event.button() == Qt.MouseButton.LeftButton and 0 <= at < len(self._rows):
            self.picked.emit(self._rows[at].name)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw the rows in sight."""
        look = themes.current()
        p = QPainter(self)
        p.setRenderHint(QPainter.RenderHint.Antialiasing)
        p.fillRect(event.rect(), QColor(look.panel))
        p.setFont(small_font(11))
        most = max((row.total for row in self._rows), default=0.0) or 1.0
        first = max(0, (event.rect().top() - 4) // _ROW)
        last = min(len(self._rows), (event.rect().bottom() - 4) // _ROW + 1)
        for at in range(first, last):
            self._draw_row(p, QRectF(0, 4 + _ROW * at, self.width(), _ROW), self._rows[at], most)
        p.end()

    def _draw_row(self, p: QPainter, room: QRectF, row: WeightRow, most: float) -> None:
        look = themes.current()
        if row.name == self._chosen:
            p.fillRect(room, QColor(look.selection))
        names = _NAMES * room.width()
        text = QFontMetricsF(p.font()).elidedText(
            row.name, Qt.TextElideMode.ElideMiddle, names - _SIDE - 6
        )
        p.setPen(QColor(look.text if row.total > 0 else look.faint))
        p.drawText(QRectF(_SIDE, room.top(), names - _SIDE, _ROW), _LEFT, text)
        wide = room.width() - names - _FIGURE - _SIDE
        left = names
        pose, motion = weight_colours()
        p.setPen(Qt.PenStyle.NoPen)
        for value, colour in ((row.pose, pose), (row.motion, motion)):
            length = value / most * wide
            p.fillRect(QRectF(left, room.top() + 5, length, _ROW - 10), colour)
            left += length
        p.setPen(QColor(look.muted))
        place = QRectF(room.right() - _FIGURE - _SIDE, room.top(), _FIGURE, _ROW)
        p.drawText(place, _RIGHT, f"{row.total:.2f}")


class WeightsView(QFrame):
    """The weights in force, where they come from, and how well they did when they were learnt.

    Parameters
    ----------
    bridge, live
        Where state comes from and intents go.
    actions
        The commands behind the buttons.
    """

    def __init__(self, bridge: CompareBridge, live: LiveBridge, actions: Actions) -> None:
        super().__init__()
        self.setObjectName("compare-weights-view")
        self.setProperty("role", "panel")
        self._bridge, self._live = bridge, live
        self.bars = WeightBars()
        self.bars.setToolTip(
            "How much each joint counts in the online alignment, the heaviest first: its pose\n"
            "(left part) and its motion (right part). A click selects the joint."
        )
        self._file = ElidedLabel(Qt.TextElideMode.ElideMiddle)
        self._file.setObjectName("weights-file")
        self._quality = label("", "muted", "weights-quality", wrap=True)
        self._legend = _Legend()
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setFrameShape(QFrame.Shape.NoFrame)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setWidget(self.bars)
        buttons = QHBoxLayout()
        buttons.setSpacing(4)
        buttons.addWidget(self._file, 1)
        buttons.addWidget(actions.tool_button("weights-open"))
        buttons.addWidget(actions.tool_button("weights-none"))
        head = QVBoxLayout()
        head.setContentsMargins(12, 6, 8, 4)
        head.setSpacing(3)
        head.addLayout(buttons)
        head.addWidget(self._quality)
        head.addWidget(self._legend)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addLayout(head)
        column.addWidget(area, 1)
        self.bars.picked.connect(self._pick)
        live.changed.connect(lambda _old, _new: self._show())
        bridge.changed.connect(lambda _old, _new: self._show())
        self._of: tuple[object, object] | None = None
        self._show()

    def _show(self) -> None:
        shown, reference = self._live.shown, self._bridge.state.reference
        self.bars.choose(self._bridge.state.row)
        if self._of is not None and self._of == (shown.weights, reference):
            return
        self._of = shown.weights, reference
        try:
            rows = weight_rows(shown.weights, reference)
        except MocapError:
            rows = ()
        self.bars.show_rows(rows)
        self._file.show_text(shown.weights_file or "All joints count the same")
        self._quality.setText(quality_words(shown.weights))
        self._quality.setVisible(bool(self._quality.text()))

    def _pick(self, name: str) -> None:
        state = self._bridge.state
        rows = () if state.comparison is None else state.comparison.rows
        if state.row == name:
            self._bridge.sitting.select_row(None)
        elif name in rows or (state.comparison is None and "-" not in name):
            self._bridge.sitting.select_row(name)

    def changeEvent(self, event: QEvent) -> None:
        """Follow the theme."""
        super().changeEvent(event)
        if event.type() in (QEvent.Type.StyleChange, QEvent.Type.PaletteChange):
            self.bars.update()
            self._legend.update()


class _Legend(QWidget):
    """Which part of a bar is which."""

    def __init__(self) -> None:
        super().__init__()
        self.setFixedHeight(16)

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw two squares with words."""
        p = QPainter(self)
        p.setFont(small_font(10))
        left = 0.0
        for words, colour in zip(("pose", "motion"), weight_colours(), strict=True):
            p.fillRect(QRectF(left, 5, 8, 8), colour)
            p.setPen(QColor(themes.current().muted))
            p.drawText(QRectF(left + 12, 0, 60, 16), _LEFT, words)
            left += 64
        p.end()


def weight_colours() -> tuple[QColor, QColor]:
    """Colours of the weight of a pose and of a motion."""
    look = themes.current()
    return QColor(look.accent), colours.mixed(look.accent, look.deferred, 0.85)


def quality_words(weights: JointWeights | None) -> str:
    """How well weights found the segments of performers that they were not learnt from."""
    if weights is None:
        return "No weights are open: train-weights learns them from labelled takes."
    if not weights.folds:
        return f"For {weights.reference}." if weights.reference else ""
    folds = weights.folds
    with_them = 100 * sum(one.test for one in folds) / len(folds)
    without = 100 * sum(one.unweighted for one in folds) / len(folds)
    return f"Held out: {with_them:.1f} % of frames in the right segment, {without:.1f} % without."
