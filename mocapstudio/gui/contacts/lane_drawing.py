"""How lanes and contacts look."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPen, QPolygonF

from mocapstudio.cleaning.contacts.model import Contact, Fixed, Floor, Following, Line, Target
from mocapstudio.gui import theme as themes
from mocapstudio.gui.contacts.lanes import Lane
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.axes import small_font

ROW = 24.0
"""Pixels a lane is high at most."""

_INSET = 3.0


@dataclass(frozen=True)
class Bar:
    """A contact as it is drawn, pixels of the plot."""

    contact: Contact
    box: QRectF


def kind_colour(look: themes.Theme, target: Target) -> str:
    """Colour that stands for a kind of target; told apart by the colour-blind as well."""
    match target:
        case Floor():
            return look.accent
        case Fixed():
            return look.open
        case Line():
            return look.rejected
        case Following():
            return look.deferred


def kind_words(target: Target) -> str:
    """Name a target in a word or two."""
    match target:
        case Floor():
            return "floor"
        case Fixed():
            return "fixed point"
        case Line():
            return "line"
        case Following(performer, joint):
            return f"{joint} of {performer}"


def row_height(area: QRectF, lanes: int) -> float:
    """Pixels of a lane."""
    return min(ROW, area.height() / max(lanes, 1))


def draw_rows(p: QPainter, area: QRectF, lanes: Sequence[Lane], chosen: Collection[object]) -> None:
    """Draw the ground of the lanes."""
    look, height = themes.current(), row_height(area, len(lanes))
    for number, lane in enumerate(lanes):
        row = QRectF(area.left(), area.top() + number * height, area.width(), height)
        if lane.key in chosen:
            p.fillRect(row, colours.faded(look.selection, 0.55))
        elif number % 2:
            p.fillRect(row, colours.faded(look.raised, 0.45))
        p.setPen(QPen(QColor(look.border), 1))
        p.drawLine(row.bottomLeft(), row.bottomRight())


def seen_of(contact: Contact) -> tuple[object, ...]:
    """Return what a contact's bar depends on."""
    kind = type(contact.target), kind_words(contact.target)
    span = contact.id, contact.joint, contact.point, contact.start, contact.end
    return *span, *kind, contact.confidence, contact.drawn


def draw_bar(p: QPainter, bar: Bar, *, chosen: bool, hovered: bool, unmet: bool) -> None:
    """Draw one contact: its colour tells the target's kind, its strength how sure it is."""
    look = themes.current()
    box = bar.box.adjusted(0, _INSET, 0, -_INSET)
    hue = kind_colour(look, bar.contact.target)
    sure = 1.0 if bar.contact.drawn else 0.25 + 0.75 * max(0.0, bar.contact.confidence - 0.5) * 2
    fill = colours.faded(hue, 0.22 + 0.33 * sure + (0.12 if hovered or chosen else 0.0))
    p.setRenderHint(QPainter.RenderHint.Antialiasing)
    edge = QPen(QColor(look.text if chosen else hue), 2 if chosen else 1)
    if not bar.contact.drawn and not chosen:
        edge.setColor(colours.faded(hue, 0.7))
    p.setPen(edge)
    p.setBrush(fill)
    p.drawRoundedRect(box.adjusted(0.5, 0.5, -0.5, -0.5), 3, 3)
    if bar.contact.drawn and box.width() > 8:
        p.setPen(Qt.PenStyle.NoPen)
        p.setBrush(QColor(hue))
        p.drawRoundedRect(QRectF(box.left() + 1, box.top() + 1, 3, box.height() - 2), 1.5, 1.5)
    p.setRenderHint(QPainter.RenderHint.Antialiasing, False)
    _draw_words(p, bar, box, look)
    if unmet:
        _draw_warning(p, box, look)


def _draw_words(p: QPainter, bar: Bar, box: QRectF, look: themes.Theme) -> None:
    if isinstance(bar.contact.target, Floor) or box.width() < 34:
        return
    font = small_font(10)
    room = box.adjusted(7, 0, -5, 0)
    words = QFontMetricsF(font).elidedText(
        kind_words(bar.contact.target), Qt.TextElideMode.ElideRight, room.width()
    )
    p.setFont(font)
    p.setPen(QColor(look.text))
    p.drawText(room, int(Qt.AlignmentFlag.AlignVCenter), words)


def _draw_warning(p: QPainter, box: QRectF, look: themes.Theme) -> None:
    x, y = box.right() - 6, box.center().y()
    p.setRenderHint(QPainter.RenderHint.Antialiasing)
    p.setPen(Qt.PenStyle.NoPen)
    p.setBrush(QColor(look.rejected))
    p.drawPolygon(QPolygonF([QPointF(x - 5, y + 4), QPointF(x + 5, y + 4), QPointF(x, y - 5)]))
    p.setRenderHint(QPainter.RenderHint.Antialiasing, False)
