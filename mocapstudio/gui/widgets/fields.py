"""Text fields that share the keyboard with the desk."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QDoubleSpinBox, QLineEdit, QSizePolicy, QSpinBox

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


class _Leaving(QObject):
    """Lets a spin box leave on Enter, and on Escape with the number that stood there."""

    def __init__(self, field: QSpinBox | QDoubleSpinBox) -> None:
        super().__init__(field)
        self._field = field
        field.installEventFilter(self)

    def eventFilter(self, _watched: QObject, event: QEvent) -> bool:
        """Claim Escape and Enter, and leave on them."""
        if _claims(event):
            event.accept()
            return True
        if (
            event.type() == QEvent.Type.KeyPress
            and isinstance(event, QKeyEvent)
            and event.key() in _LEAVING
        ):
            field = self._field
            if event.key() == Qt.Key.Key_Escape:
                field.lineEdit().setText(_shown(field))
            field.clearFocus()
            return True
        return False


def _shown(field: QSpinBox | QDoubleSpinBox) -> str:
    value = field.value()
    text = field.textFromValue(value) if isinstance(field, QDoubleSpinBox) else str(value)
    return text + field.suffix()


class NumberField(QSpinBox):
    """A whole number; gives the keys back to the desk on Enter and on Escape."""

    def __init__(self) -> None:
        super().__init__()
        _Leaving(self)


class DecimalField(QDoubleSpinBox):
    """A number with decimals, told when the typing is done; leaves on Enter and on Escape.

    Parameters
    ----------
    low, high
        Bounds.
    step
        Of the arrows.
    decimals
        Shown.
    unit
        Shown after the number, or "".
    """

    def __init__(self, low: float, high: float, step: float, decimals: int, unit: str = "") -> None:
        super().__init__()
        self.setRange(low, high)
        self.setDecimals(decimals)
        self.setSingleStep(step)
        self.setSuffix(f" {unit}" if unit else "")
        self.setKeyboardTracking(False)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self.setAlignment(Qt.AlignmentFlag.AlignRight)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        _Leaving(self)
