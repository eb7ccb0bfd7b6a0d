"""The neighbours of a flag as a list of buttons: which takes, when, how near."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QContextMenuEvent, QFontMetrics, QPainter, QPaintEvent
from PySide6.QtWidgets import QAbstractButton, QMenu, QSizePolicy, QVBoxLayout, QWidget

from mocapstudio.cleaning.model import Neighbour
from mocapstudio.gui import theme
from mocapstudio.gui.widgets.parts import label

_HEIGHT = 28


class NeighbourButton(QAbstractButton):
    """One neighbour: its key, take, time and distance; checked while it is the proposal."""

    def __init__(
        self, number: int, neighbour: Neighbour, when: str, share: float, choosable: bool
    ) -> None:
        super().__init__()
        self._number, self._neighbour, self._when, self._share = number, neighbour, when, share
        self.setObjectName(f"neighbour-{number}")
        self.setCheckable(True)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setEnabled(choosable)
        if choosable:
            self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setText(neighbour.take)
        use = f"Click, or press {number}, to preview it as the proposal; right click for more"
        if not choosable:
            use = "The path of the root is mended from its own frames, not from a neighbour"
        self.setToolTip(
            f"{neighbour.take}, from {when}\n{neighbour.distance:.1f}° root mean square joint angle"
            f" from the flagged motion\n{use}"
        )

    def sizeHint(self) -> QSize:
        """As wide as the inspector, one line high."""
        return QSize(200, _HEIGHT)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Draw key, take, time, distance and a bar for the distance."""
        now = theme.current()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        area = QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5)
        ground = now.selection if self.isChecked() else now.raised
        lit = self.isChecked() or (self.isEnabled() and self.underMouse())
        edge = now.accent if lit else now.border
        painter.setPen(QColor(edge))
        painter.setBrush(QColor(ground))
        painter.drawRoundedRect(area, 5, 5)
        key = QRectF(area.left() + 7, area.center().y() - 9, 18, 18)
        painter.setPen(QColor(now.border))
        painter.setBrush(QColor(now.field))
        painter.drawRoundedRect(key, 4, 4)
        painter.setPen(QColor(now.muted))
        painter.drawText(key, Qt.AlignmentFlag.AlignCenter, str(self._number))
        self._draw_words(painter, area)

    def _draw_words(self, painter: QPainter, area: QRectF) -> None:
        now, middle = theme.current(), Qt.AlignmentFlag.AlignVCenter
        font = theme.numbers_font()
        painter.setFont(font)
        metrics = QFontMetrics(font)
        distance = f"{self._neighbour.distance:.1f}°"
        far = QRectF(area.right() - 58, area.top(), 50, area.height() - 4)
        painter.setPen(QColor(now.text))
        painter.drawText(far, middle | Qt.AlignmentFlag.AlignRight, distance)
        bar = QRectF(far.left() + 6, area.bottom() - 7, far.width() - 6, 2)
        painter.fillRect(bar, QColor(now.border))
        bar.setWidth(bar.width() * self._share)
        painter.fillRect(bar, QColor(now.accent))
        width = metrics.horizontalAdvance(self._when)
        when = QRectF(far.left() - width - 4, area.top(), width, area.height())
        painter.setPen(QColor(now.muted))
        painter.drawText(when, middle, self._when)
        name = QRectF(area.left() + 33, area.top(), when.left() - area.left() - 41, area.height())
        text = metrics.elidedText(
            self._neighbour.take, Qt.TextElideMode.ElideMiddle, int(name.width())
        )
        painter.setPen(QColor(now.text))
        painter.drawText(name, middle, text)


class NeighbourList(QWidget):
    """The K neighbours, nearest first."""

    chosen = Signal(int)
    """Emitted with the 0-based index of the neighbour that was clicked."""

    alignment_wanted = Signal(int)
    """Emitted with the 0-based index of the neighbour whose alignment is to be shown."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("neighbours")
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(4)
        self._buttons: list[NeighbourButton] = []
        self._note = label("", "muted", "neighbours-note", wrap=True)
        self._column.addWidget(self._note)
        self._shown: tuple[object, ...] = ()

    def show_neighbours(
        self,
        neighbours: Sequence[Neighbour],
        times: Sequence[str],
        note: str,
        choosable: bool,
    ) -> None:
        """List the neighbours, or say `note` where there are none.

        Parameters
        ----------
        times
            When each neighbour starts in its take, in words.
        choosable
            Whether a neighbour can be made the proposal.
        """
        wanted = (tuple(neighbours), tuple(times), note, choosable)
        if wanted == self._shown:
            return
        self._shown = wanted
        for button in self._buttons:
            self._column.removeWidget(button)
            button.deleteLater()
        self._buttons = []
        largest = max((one.distance for one in neighbours), default=0.0) or 1.0
        for k, (one, when) in enumerate(zip(neighbours, times, strict=True)):
            button = NeighbourButton(k + 1, one, when, one.distance / largest, choosable)
            button.clicked.connect(lambda _=False, k=k: self.chosen.emit(k))
            self._buttons.append(button)
            self._column.addWidget(button)
        self._note.setText(note)
        self._note.setVisible(not self._buttons)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Offer what can be done with a neighbour."""
        button = self.childAt(event.pos())
        if not isinstance(button, NeighbourButton):
            return
        which = self._buttons.index(button)
        menu = QMenu(self)
        menu.setObjectName("neighbour-menu")
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        if button.isEnabled():
            menu.addAction("Preview as Proposal", button.click)
        menu.addAction("Show the Alignment…", lambda: self.alignment_wanted.emit(which))
        menu.popup(event.globalPos())

    def mark(self, choice: int | None) -> None:
        """Check the neighbour whose motion is the proposal."""
        for k, button in enumerate(self._buttons):
            button.setChecked(k == choice)
