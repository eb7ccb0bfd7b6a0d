"""The desk's line icons, recoloured to the theme in force."""

from __future__ import annotations

from functools import cache

from PySide6.QtCore import QByteArray, QRectF, Qt
from PySide6.QtGui import QIcon, QPainter, QPixmap
from PySide6.QtSvg import QSvgRenderer

from mocapstudio.gui import theme
from mocapstudio.resource_files import resource

_SIZES = (16, 20, 24, 32, 48)


def icon(name: str, colour: str | None = None) -> QIcon:
    """Return an icon of `resources/icons`, in the theme's text colour unless told otherwise."""
    now = theme.current()
    return _icon(name, colour or now.text, now.faint)


def pixmap(name: str, size: int, colour: str | None = None) -> QPixmap:
    """Return one icon as a picture of `size` x `size` pixels."""
    return _pixmap(name, size, colour or theme.current().text)


def application_icon() -> QIcon:
    """Return the icon of the window."""
    return _icon("mocapstudio", "", "")


@cache
def _icon(name: str, colour: str, disabled: str) -> QIcon:
    made = QIcon()
    for size in _SIZES:
        made.addPixmap(_pixmap(name, size, colour))
        made.addPixmap(_pixmap(name, size, disabled), QIcon.Mode.Disabled)
    return made


@cache
def _pixmap(name: str, size: int, colour: str) -> QPixmap:
    drawing = resource("icons", f"{name}.svg").read_text("utf-8").replace("currentColor", colour)
    made = QPixmap(size, size)
    made.fill(Qt.GlobalColor.transparent)
    painter = QPainter(made)
    QSvgRenderer(QByteArray(drawing.encode())).render(painter, QRectF(0, 0, size, size))
    painter.end()
    return made
