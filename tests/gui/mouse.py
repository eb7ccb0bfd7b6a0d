"""Mouse gestures with buttons held, as a window system sends them."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent, QWheelEvent
from PySide6.QtWidgets import QApplication, QWidget

LEFT = Qt.MouseButton.LeftButton
NOTHING = Qt.MouseButton.NoButton
PLAIN = Qt.KeyboardModifier.NoModifier


def send(widget: QWidget, kind: QEvent.Type, at: QPointF, button, held, modifiers=PLAIN) -> None:
    everywhere = QPointF(widget.mapToGlobal(at))
    QApplication.sendEvent(widget, QMouseEvent(kind, at, everywhere, button, held, modifiers))


def move(widget: QWidget, at: QPointF) -> None:
    send(widget, QEvent.Type.MouseMove, at, NOTHING, NOTHING)


def click(widget: QWidget, at: QPointF, button=LEFT, modifiers=PLAIN) -> None:
    send(widget, QEvent.Type.MouseButtonPress, at, button, button, modifiers)
    send(widget, QEvent.Type.MouseButtonRelease, at, button, NOTHING, modifiers)


def double_click(widget: QWidget, at: QPointF) -> None:
    click(widget, at)
    send(widget, QEvent.Type.MouseButtonDblClick, at, LEFT, LEFT)
    send(widget, QEvent.Type.MouseButtonRelease, at, LEFT, NOTHING)


def drag(widget: QWidget, begin: QPointF, end: QPointF, button=LEFT, modifiers=PLAIN) -> None:
    send(widget, QEvent.Type.MouseButtonPress, begin, button, button, modifiers)
    for share in (0.25, 0.5, 0.75, 1.0):
        at = begin + (end - begin) * share
        send(widget, QEvent.Type.MouseMove, at, NOTHING, button, modifiers)
    send(widget, QEvent.Type.MouseButtonRelease, end, button, NOTHING, modifiers)


def wheel(widget: QWidget, at: QPointF, notches: int, modifiers=PLAIN) -> None:
    event = QWheelEvent(
        at,
        QPointF(widget.mapToGlobal(at)),
        QPoint(),
        QPoint(0, 120 * notches),
        NOTHING,
        modifiers,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(widget, event)
