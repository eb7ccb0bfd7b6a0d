"""Text fields that share the keyboard with the desk."""

from __future__ import annotations

from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QLineEdit, QSpinBox

_LEAVING = (Qt.Key.Key_Escape, Qt.Key.Key_Return, Qt.Key.Key_Enter)


def _claims(event: QEvent) -> bool:
    """Whether a key that is also a command of the window belongs to the field that has it."""
    return (
        event.type() == QEvent.Type.ShortcutOverride
        and isinstance(event, QKeyEvent)
        and event.key() in _LEAVING
    )


class SearchField(QLineEdit):
    """Gives the keys back to the desk on Enter and on Escape, which also empties it."""

    def event(self, event: QEvent) -> bool:
        """Claim Escape and Enter."""
        if _claims(event):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Leave on Enter, empty and leave on Escape."""
        if event.key() == Qt.Key.Key_Escape:
            self.clear()
        if event.key() in _LEAVING:
            self.clearFocus()
        else:
            super().keyPressEvent(event)


class NumberField(QSpinBox):
    """Gives the keys back to the desk on Enter and on Escape, which also takes the typing back."""

    def event(self, event: QEvent) -> bool:
        """Claim Escape and Enter."""
        if _claims(event):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Leave on Enter, and on Escape with the number that stood there."""
        if event.key() == Qt.Key.Key_Escape:
            self.lineEdit().setText(self.textFromValue(self.value()))
        super().keyPressEvent(event)
        if event.key() in _LEAVING:
            self.clearFocus()
