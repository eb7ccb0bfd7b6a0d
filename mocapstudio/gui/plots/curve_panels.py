"""Left and right of the curves: what is shown, and its values at the play head."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QRectF, QSignalBlocker, Qt, Signal
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPaintEvent
from PySide6.QtWidgets import QComboBox, QLabel, QSizePolicy, QVBoxLayout, QWidget

from mocapstudio.gui import theme as themes
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.axes import small_font
from mocapstudio.gui.plots.curve_set import Role, pen
from mocapstudio.gui.plots.quantities import Quantity
from mocapstudio.gui.plots.time_plot import LEFT_GUTTER, RIGHT_GUTTER

VALUE_AXIS_WIDTH = 46
PANEL_WIDTH = LEFT_GUTTER - VALUE_AXIS_WIDTH
_LINE = 15


class CurvePanel(QWidget):
    """Name of the row, chooser of the quantity, and which line is whose."""

    chosen = Signal(object)
    """The `Quantity` that the user wants to see."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setFixedWidth(PANEL_WIDTH)
        self._full = ""
        self.name = QLabel()
        self.name.setProperty("role", "title")
        self.name.setTextFormat(Qt.TextFormat.PlainText)
        self.chooser = QComboBox()
        self.chooser.setToolTip("What the curves show")
        self.chooser.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.chooser.setFont(small_font())
        self.chooser.activated.connect(self._choose)
        self.legend = Legend()
        column = QVBoxLayout(self)
        column.setContentsMargins(8, 7, 2, 4)
        column.setSpacing(6)
        column.addWidget(self.name)
        column.addWidget(self.chooser)
        column.addWidget(self.legend)
        column.addStretch(1)

    def show_row(self, name: str, others: int) -> None:
        """Name the row, and say how many more are selected."""
        full = name if not others else f"{name} +{others}"
        if full != self._full:
            self._full = full
            room = PANEL_WIDTH - 16
            metrics = QFontMetricsF(self.name.font())
            self.name.setText(metrics.elidedText(full, Qt.TextElideMode.ElideMiddle, room))
            self.name.setToolTip(full)

    def offer(self, quantities: Sequence[Quantity], chosen: Quantity) -> None:
        """Offer quantities, one of them chosen."""
        with QSignalBlocker(self.chooser):
            offered = [self.chooser.itemData(i) for i in range(self.chooser.count())]
            if offered != list(quantities):
                self.chooser.clear()
                for one in quantities:
                    self.chooser.addItem(str(one), one)
            self.chooser.setCurrentIndex(list(quantities).index(chosen))

    def _choose(self, number: int) -> None:
        self.chosen.emit(Quantity(self.chooser.itemData(number)))


class Legend(QWidget):
    """Which line is original, result, proposal; only those that are drawn."""

    def __init__(self) -> None:
        super().__init__()
        self._roles: tuple[Role, ...] = ()
        self._names: tuple[str, ...] = ()
        self.setFixedHeight(3 * _LINE)

    @property
    def roles(self) -> tuple[Role, ...]:
        """What is drawn."""
        return self._roles

    def set_roles(self, roles: tuple[Role, ...], names: tuple[str, ...]) -> None:
        """Say what is drawn, and the names of the components."""
        if (roles, names) != (self._roles, self._names):
            self._roles, self._names = roles, names
            self.update()

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw a piece of each line and its name."""
        look = themes.current()
        alone = Role.RESULT not in self._roles
        p = QPainter(self)
        p.setFont(small_font())
        for number, role in enumerate(self._roles):
            top = number * _LINE + _LINE // 2 - 3 * (len(self._names) - 1) // 2
            for place, name in enumerate(self._names):
                p.setPen(pen(look, role, name, alone))
                p.drawLine(2, top + 3 * place, 26, top + 3 * place)
            p.setPen(QColor(look.muted))
            room = QRectF(34, number * _LINE, self.width() - 34, _LINE)
            p.drawText(room, int(Qt.AlignmentFlag.AlignVCenter), role)
        p.end()


class ReadOut(QWidget):
    """Values at the play head, in the colours of the curves."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setFixedWidth(RIGHT_GUTTER)
        # It changes at every frame: what lies behind need not be painted with it.
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self._lines: tuple[tuple[str, str], ...] = ()

    @property
    def lines(self) -> tuple[tuple[str, str], ...]:
        """Component and value, as drawn."""
        return self._lines

    def show_values(self, lines: tuple[tuple[str, str], ...]) -> None:
        """Say what the values are; equal ones cost nothing."""
        if lines != self._lines:
            self._lines = lines
            self.update()

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw the values under one another."""
        look = themes.current()
        p = QPainter(self)
        p.fillRect(self.rect(), QColor(look.panel))
        font = small_font(12)
        p.setFont(font)
        right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        left = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
        top = 8.0
        for name, value in self._lines:
            room = QRectF(8, top, self.width() - 16, 17)
            p.setPen(colours.component(look, name))
            if len(name) == 1:
                p.drawText(room, int(left), name)
            p.drawText(room, int(right), value)
            top += 18
        p.end()
