"""With which other marker labels are exchanged, and over which frames."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QVBoxLayout,
    QWidget,
)

from mocapstudio.gui.widgets.parts import label

Choice = tuple[str, tuple[int, int]]


class ExchangeDialog(QDialog):
    """Asks for the other marker and the span.

    Parameters
    ----------
    marker
        The one that is chosen.
    others
        Labels and words beside them, the likeliest first.
    spans
        Words and half-open span of each choice, the likeliest first.
    parent
        The window.
    """

    answered = Signal(str, int, int)
    """Emitted with the other marker, and the span's start and end."""

    def __init__(
        self,
        marker: str,
        others: Sequence[tuple[str, str]],
        spans: Sequence[Choice],
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("exchange-dialog")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle("Exchange Labels")
        self.setMinimumWidth(440)
        self._spans = [span for _, span in spans]
        column = QVBoxLayout(self)
        column.setContentsMargins(22, 20, 22, 16)
        column.setSpacing(12)
        column.addWidget(label(f"Exchange {marker} with", "heading", "exchange-title"))
        self._box = QComboBox()
        self._box.setObjectName("exchange-other")
        self._box.setToolTip("The nearest at this frame come first")
        for name, beside in others:
            self._box.addItem(f"{name}   {beside}" if beside else name, name)
        column.addWidget(self._box)
        self._span = QComboBox()
        self._span.setObjectName("exchange-span")
        self._span.setToolTip("Where both change places")
        self._span.addItems([words for words, _ in spans])
        column.addWidget(self._span)
        words = "Both courses change places there; it is one edit, and can be taken back."
        column.addWidget(label(words, "muted", wrap=True))
        column.addWidget(self._answers())

    def _answers(self) -> QDialogButtonBox:
        standard = QDialogButtonBox.StandardButton
        box = QDialogButtonBox(standard.Ok | standard.Cancel)
        box.button(standard.Ok).setText("Exchange")
        box.button(standard.Ok).setObjectName("exchange-ok")
        box.button(standard.Cancel).setObjectName("exchange-cancel")
        box.accepted.connect(self._answer)
        box.rejected.connect(self.reject)
        return box

    def _answer(self) -> None:
        start, end = self._spans[self._span.currentIndex()]
        self.accept()
        self.answered.emit(str(self._box.currentData()), start, end)
