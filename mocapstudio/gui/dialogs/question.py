"""Questions with a few answers."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QMessageBox, QWidget

_BUTTONS = QMessageBox.StandardButton


def ask_to_save(
    parent: QWidget, save: Callable[[], object], discard: Callable[[], object]
) -> QMessageBox:
    """Ask what becomes of decisions that are not saved; cancelling calls neither."""
    box = _box(
        parent,
        "Save the session first?",
        "Decisions and repairs since the last save would be lost.",
        _BUTTONS.Save | _BUTTONS.Discard | _BUTTONS.Cancel,
    )
    box.setObjectName("save-question")

    def answered(button: object) -> None:
        chosen = box.standardButton(button)  # type: ignore[arg-type]
        if chosen == _BUTTONS.Save:
            save()
        elif chosen == _BUTTONS.Discard:
            discard()

    box.buttonClicked.connect(answered)
    box.open()
    return box


def confirm(parent: QWidget, title: str, words: str, verb: str, do: Callable[[], object]) -> None:
    """Ask before something that cannot be taken back."""
    box = _box(parent, title, words, _BUTTONS.Ok | _BUTTONS.Cancel)
    box.setObjectName("confirm-question")
    box.button(_BUTTONS.Ok).setText(verb)
    box.accepted.connect(do)
    box.open()


def _box(
    parent: QWidget, title: str, words: str, buttons: QMessageBox.StandardButton
) -> QMessageBox:
    box = QMessageBox(parent)
    box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    box.setWindowTitle("mocapstudio")
    box.setIcon(QMessageBox.Icon.Question)
    box.setText(f"<b>{title}</b>")
    box.setInformativeText(words)
    box.setStandardButtons(buttons)
    return box
