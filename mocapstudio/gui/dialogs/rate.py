"""Asks for the frame rate that files do not state."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QInputDialog, QWidget

from mocapstudio.formats.options import parse_rate
from mocapstudio.gui import settings
from mocapstudio.motion.errors import ParameterError


def ask_rate(parent: QWidget, files: Sequence[Path], done: Callable[[Fraction], object]) -> None:
    """Ask how many frames a second files have; asked again where the answer is no rate."""
    _ask(parent, files, done, "")


def _ask(
    parent: QWidget, files: Sequence[Path], done: Callable[[Fraction], object], wrong: str
) -> None:
    name = files[0].name if len(files) == 1 else f"{len(files)} files"
    state = "states" if len(files) == 1 else "state"
    dialog = QInputDialog(parent)
    dialog.setObjectName("rate-dialog")
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.setWindowTitle("Frame rate")
    words = f"{name} {state} no frame rate. How many frames a second are there?"
    dialog.setLabelText(f"{wrong}\n\n{words}" if wrong else words)
    dialog.setTextValue(settings.text("rate", "100"))

    def answered(text: str) -> None:
        try:
            rate = parse_rate(text.strip())
        except ParameterError as error:
            _ask(parent, files, done, str(error))
            return
        settings.set_text("rate", text.strip())
        done(rate)

    dialog.textValueSelected.connect(answered)
    dialog.open()
