"""What the views around a time plot have in common."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt
from PySide6.QtWidgets import QHBoxLayout, QLabel, QStackedLayout, QWidget


class PlotView(QWidget):
    """A view in a native window of its own; `restyle` is called when the theme changes."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        # A native window of its own spares the desk from compositing itself at every play head.
        self.setAttribute(Qt.WidgetAttribute.WA_DontCreateNativeAncestors)
        self.setAttribute(Qt.WidgetAttribute.WA_NativeWindow)
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        raise NotImplementedError

    def changeEvent(self, event: QEvent) -> None:
        """Follow the theme."""
        super().changeEvent(event)
        if event.type() in (QEvent.Type.StyleChange, QEvent.Type.PaletteChange):
            self.restyle()


class HintedPlotView(PlotView):
    """A view that shows words, `empty`, in place of its plots while there is nothing to plot."""

    def stand(self, desk: QWidget, hint: str = "") -> None:
        """Fill the view with its plots and, in their place, the hint."""
        self.empty = QLabel(hint)
        self.empty.setProperty("role", "hint")
        self.empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._stack = QStackedLayout(self)
        self._stack.addWidget(desk)
        self._stack.addWidget(self.empty)

    def show_hint(self, shown: bool) -> None:
        """Show the hint, or the plots."""
        self._stack.setCurrentIndex(1 if shown else 0)


def in_a_row(left: QWidget, plot: QWidget, right: QWidget) -> QWidget:
    """Put a plot between what stands in its gutters."""
    desk = QWidget()
    row = QHBoxLayout(desk)
    row.setContentsMargins(0, 0, 0, 0)
    row.setSpacing(0)
    row.addWidget(left)
    row.addWidget(plot, 1)
    row.addWidget(right)
    return desk
