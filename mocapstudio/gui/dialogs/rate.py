"""Asks for the frame rate that files do not state."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QLineEdit,
    QVBoxLayout,
    QWidget,
)

from mocapstudio.formats.options import parse_rate
from mocapstudio.gui import settings
from mocapstudio.gui.dialogs.reading_form import RATES
from mocapstudio.gui.widgets.parts import label
from mocapstudio.motion.errors import ParameterError

_LISTED = 6


def ask_rate(parent: QWidget, files: Sequence[Path], done: Callable[[Fraction], object]) -> None:
    """Ask once how many frames a second files have; cancelling leaves them unread."""
    dialog = RateDialog(files, parent)
    dialog.answered.connect(done)
    dialog.open()


class RateDialog(QDialog):
    """The usual rates to choose from, and a field for any other.

    Parameters
    ----------
    files
        At least one.
    parent
        The window.
    """

    answered = Signal(object)
    """Emitted with the rate, a Fraction."""

    def __init__(self, files: Sequence[Path], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("rate-dialog")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle("Frame Rate")
        self.setMinimumWidth(440)
        one = len(files) == 1
        title = (
            f"{files[0].name} states no frame rate"
            if one
            else (f"{len(files)} files state no frame rate")
        )
        column = QVBoxLayout(self)
        column.setContentsMargins(22, 20, 22, 16)
        column.setSpacing(12)
        column.addWidget(label(title, "heading", "rate-title", wrap=True))
        if not one:
            names = [path.name for path in files[:_LISTED]]
            more = len(files) - len(names)
            listed = ", ".join(names) + (f" and {more} more" if more else "")
            column.addWidget(label(listed, "muted", "rate-files", wrap=True))
        words = (
            "How many frames a second are there? Nothing in the file tells; a wrong rate makes all"
            " speeds wrong. It can be changed later in the import report."
        )
        column.addWidget(label(words, "muted", wrap=True))
        column.addLayout(self._field())
        self._wrong = label("", "guess", "rate-wrong", wrap=True)
        self._wrong.hide()
        column.addWidget(self._wrong)
        column.addWidget(self._buttons())

    def _field(self) -> QHBoxLayout:
        self._box = QComboBox()
        self._box.setObjectName("rate-box")
        field = QLineEdit()
        field.setObjectName("rate-text")
        self._box.setEditable(True)
        self._box.setLineEdit(field)
        self._box.setInsertPolicy(QComboBox.InsertPolicy.NoInsert)
        self._box.setToolTip("A number such as 30 or 119.88, or a fraction such as 120000/1001")
        self._box.addItems(RATES)
        field.setText(settings.text("rate", "100"))
        field.selectAll()
        row = QHBoxLayout()
        row.setSpacing(8)
        row.addWidget(self._box)
        row.addWidget(label("frames a second", "muted"))
        row.addStretch(1)
        return row

    def _buttons(self) -> QDialogButtonBox:
        standard = QDialogButtonBox.StandardButton
        box = QDialogButtonBox(standard.Open | standard.Cancel)
        box.button(standard.Open).setObjectName("rate-ok")
        box.button(standard.Cancel).setObjectName("rate-cancel")
        box.accepted.connect(self._answer)
        box.rejected.connect(self.reject)
        return box

    def _answer(self) -> None:
        text = self._box.currentText().strip()
        try:
            rate = parse_rate(text)
        except ParameterError as error:
            self._wrong.setText(str(error))
            self._wrong.show()
            return
        settings.set_text("rate", text)
        self.accept()
        self.answered.emit(rate)
