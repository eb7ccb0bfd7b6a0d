"""What stands left and right of the pictures: names, values at the play head, legends."""

from __future__ import annotations

from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from mocapstudio.gui import theme as themes
from mocapstudio.gui.compare import colours as kinds
from mocapstudio.gui.compare.curve_plots import AXIS_WIDTH
from mocapstudio.gui.compare.heat_layout import Bands
from mocapstudio.gui.plots.axes import small_font
from mocapstudio.gui.plots.row_labels import RowLabels
from mocapstudio.gui.plots.rows import RowLayout
from mocapstudio.gui.plots.time_plot import LEFT_GUTTER, RIGHT_GUTTER

_LEFT = int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)


class ReadOutPanel(QWidget):
    """Name of a curve, its value at the play head, and what it means in words."""

    def __init__(self, title: str, tip: str) -> None:
        super().__init__()
        self.setFixedWidth(LEFT_GUTTER - AXIS_WIDTH)
        self.setToolTip(tip)
        # It changes at every frame: what lies behind need not be painted with it.
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self._title, self._value, self._words = title, "", ""
        self._colour: QColor | None = None

    def tell(self, value: str, words: str = "", colour: QColor | None = None) -> None:
        """Show another value, and words below it in a colour."""
        if (value, words, colour) != (self._value, self._words, self._colour):
            self._value, self._words, self._colour = value, words, colour
            self.update()

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw the words."""
        look = themes.current()
        p = QPainter(self)
        p.fillRect(self.rect(), QColor(look.panel))
        room = QRectF(10, 6, self.width() - 12, 17)
        font = themes.numbers_font()
        font.setBold(True)
        p.setFont(font)
        p.setPen(QColor(look.text))
        p.drawText(room, _LEFT, self._title)
        if self.height() >= 44:
            p.setFont(themes.numbers_font())
            p.setPen(QColor(look.text))
            p.drawText(room.translated(0, 19), _LEFT, self._value)
        if self.height() >= 62:
            p.setFont(small_font())
            p.setPen(self._colour or QColor(look.muted))
            p.drawText(room.translated(0, 36), _LEFT, self._words)
        p.end()


class TimingLegend(QWidget):
    """What the colours of the curves mean."""

    def __init__(self) -> None:
        super().__init__()
        self.setFixedWidth(RIGHT_GUTTER)
        self.setToolTip(
            "Blue: the source gains on the reference. Red: it loses. Yellow: neither, within the"
            " tolerance."
        )

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw three dots with words."""
        look = themes.current()
        p = QPainter(self)
        p.fillRect(self.rect(), QColor(look.panel))
        p.setFont(small_font(10))
        p.setRenderHint(QPainter.RenderHint.Antialiasing)
        line_height = min(17.0, self.height() / 3.6)
        for line, kind in enumerate((1, 0, -1)):
            middle = min(28.0, 0.7 * line_height) + line_height * line
            p.setPen(Qt.PenStyle.NoPen)
            p.setBrush(kinds.timing(look, kind))
            p.drawEllipse(QRectF(8, middle - 3.5, 7, 7))
            p.setPen(QColor(look.muted))
            room = QRectF(20, middle - 8, self.width() - 20, 16)
            p.drawText(room, _LEFT, kinds.TIMING_WORDS[kind])
        p.end()


class AxesLegend(QWidget):
    """What red, green and blue mean in the colours of poses."""

    def __init__(self) -> None:
        super().__init__()
        self.setFixedWidth(RIGHT_GUTTER)
        self.setToolTip(
            "The colour of a cell is the place of that joint in the body's own box: red grows\n"
            "along its first axis, green along its second, blue along its third. Both are\n"
            "drawn by one scale: equal colours are equal poses."
        )

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw three bars with words."""
        look = themes.current()
        p = QPainter(self)
        p.fillRect(self.rect(), QColor(look.panel))
        p.setFont(small_font(10))
        middle = 0.5 * self.height()
        for line, (name, colour) in enumerate(
            zip("xyz", ("#e05050", "#50b050", "#5a78f0"), strict=True)
        ):
            y = middle + 17.0 * (line - 1)
            p.fillRect(QRectF(8, y - 3.5, 7, 7), QColor(colour))
            p.setPen(QColor(look.muted))
            p.drawText(QRectF(20, y - 8, self.width() - 20, 16), _LEFT, f"{name} in box")
        p.end()


class HeatMargin(QWidget):
    """Names of limbs and rows beside both performances, and whose they are."""

    rows_clicked = Signal(object, bool)
    """Names of the rows (frozenset), and whether they add to the selection."""

    def __init__(self) -> None:
        super().__init__()
        self.setFixedWidth(LEFT_GUTTER)
        self._source, self._reference = RowLabels(self), RowLabels(self)
        self._names = ("", "")
        self._bands: Bands | None = None
        for one in (self._source, self._reference):
            one.rows_clicked.connect(self.rows_clicked)

    def arrange(self, rows: RowLayout, bands: Bands) -> None:
        """Put the names beside the bands."""
        self._bands = bands
        for one, band in ((self._source, bands.source), (self._reference, bands.reference)):
            one.setGeometry(0, int(band.top()), LEFT_GUTTER, int(band.height()) + 6)
            one.set_rows(rows, 0)
        self.update()

    def tell(self, source: str, reference: str) -> None:
        """Say whose performances they are."""
        if (source, reference) != self._names:
            self._names = source, reference
            self.update()

    def mark(self, row: str | None) -> None:
        """Show which row is selected."""
        chosen = frozenset() if row is None else frozenset({row})
        for one in (self._source, self._reference):
            one.set_marks(chosen, (), None, False)

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        for one in (self, self._source, self._reference):
            one.update()

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw the names of the performances, between the bands."""
        look = themes.current()
        p = QPainter(self)
        p.fillRect(self.rect(), QColor(look.panel))
        if self._bands is not None:
            between = self._bands.between
            font = small_font()
            metrics = QFontMetricsF(font)
            p.setFont(font)
            right = int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            room = self.width() - 34.0
            places = (between.top() + 10, between.bottom() - 8)
            for name, mark, y in zip(self._names, ("↑", "↓"), places, strict=True):
                text = metrics.elidedText(name, Qt.TextElideMode.ElideMiddle, room)
                p.setPen(QColor(look.text))
                p.drawText(QRectF(4, y - 8, self.width() - 26, 16), right, text)
                p.setPen(QPen(QColor(look.faint)))
                p.drawText(QRectF(self.width() - 20, y - 8, 14, 16), right, mark)
            p.setPen(QColor(look.faint))
            p.setFont(small_font(10))
            for lane in (self._bands.carried, self._bands.lane):
                room_ = QRectF(0, lane.top(), self.width() - 8, lane.height())
                p.drawText(room_, right, "segments")
        p.end()
