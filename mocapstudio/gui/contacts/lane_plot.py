"""The plot of the lanes: contacts are drawn, moved and resized by the mouse."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QCursor, QMouseEvent, QPainter

from mocapstudio.cleaning.contacts.model import Contact
from mocapstudio.gui.contacts import lane_drawing
from mocapstudio.gui.contacts.lane_drawing import Bar
from mocapstudio.gui.contacts.lane_gestures import (
    Part,
    Room,
    others_of,
    reshaped,
    room_for,
    swept,
)
from mocapstudio.gui.contacts.lanes import Key, Lane, key_of
from mocapstudio.gui.plots.layers import Layer, draw_trim
from mocapstudio.gui.plots.time_plot import TimePlot
from mocapstudio.gui.plots.time_range import TimeRange

_EDGE = 5.0
_STILL = 3.0
_WIDE = 14.0


@dataclass
class _Grip:
    """What the pressed mouse holds: a contact's part, or a place in an empty lane."""

    at: QPointF
    contact: Contact | None
    part: Part
    room: Room
    lane: Lane | None = None
    extend: bool = False
    moved: bool = False


class LanePlot(TimePlot):
    """Lanes under a time axis.

    A drag in an empty lane draws a contact, a drag of a contact or of its edge moves it, a click
    chooses it (Ctrl: one more); a click elsewhere moves the play head.

    Parameters
    ----------
    time_range
        The visible frames.
    """

    picked = Signal(object, bool)
    """The id of the contact that was clicked or None, and whether it is one more."""

    shaped = Signal(object, object, bool)
    """The contact as it is dragged to, the `Part` that is held, and whether it was let go."""

    drawn = Signal(object, int, int, bool)
    """Key of a lane, start, end, and whether the mouse was let go."""

    def __init__(self, time_range: TimeRange) -> None:
        self.lanes: tuple[Lane, ...] = ()
        self.contacts: tuple[Contact, ...] = ()
        self._seen: list[tuple[object, ...]] = []
        self._chosen: frozenset[str] = frozenset()
        self._unmet: frozenset[str] = frozenset()
        self._trim: tuple[int, int] | None = None
        self._hovered: str | None = None
        self._grip: _Grip | None = None
        super().__init__(time_range, axis="top")
        self._ground = self.add_layer(Layer(self._draw_ground, cached=True), -1)
        self._bars = self.add_layer(Layer(self._draw_bars, cached=True), 1)

    def show_contacts(
        self,
        lanes: tuple[Lane, ...],
        contacts: tuple[Contact, ...],
        chosen: frozenset[str],
        unmet: frozenset[str],
        trim: tuple[int, int] | None,
    ) -> None:
        """Show other lanes, contacts, choice, or trim."""
        if (lanes, chosen, trim) != (self.lanes, self._chosen, self._trim):
            self._ground.refresh()
        # Where a target is does not show on a lane, and is dragged at every move of the mouse.
        bars = [lane_drawing.seen_of(one) for one in contacts]
        changed = (bars, chosen, unmet, lanes, trim) != (
            self._seen, self._chosen, self._unmet, self.lanes, self._trim
        )  # fmt: skip
        self._seen = bars
        self.lanes, self.contacts = lanes, contacts
        self._chosen, self._unmet, self._trim = chosen, unmet, trim
        if changed:
            self._bars.refresh()

    def let_go(self) -> None:
        """Forget what is held; nothing comes of it."""
        self._grip = None

    @property
    def holding(self) -> bool:
        """Whether something is being dragged."""
        return self._grip is not None

    # -- geometry

    def lane_at(self, at: QPointF) -> Lane | None:
        """Return the lane at a place of the widget, or None."""
        area = self.area
        if not area.contains(at) or not self.lanes:
            return None
        row = int((at.y() - area.top()) / lane_drawing.row_height(area, len(self.lanes)))
        return self.lanes[row] if row < len(self.lanes) else None

    def box_of(self, contact: Contact) -> QRectF:
        """Pixels that a contact takes up."""
        area = self.area
        height = lane_drawing.row_height(area, len(self.lanes))
        keys = [lane.key for lane in self.lanes]
        row = keys.index(key_of(contact))
        left, right = self.x_of(contact.start - 0.5), self.x_of(contact.end - 0.5)
        return QRectF(left, area.top() + row * height, max(right - left, 2.0), height)

    def hit(self, at: QPointF) -> tuple[Contact, Part] | None:
        """Return the contact at a place and which part of it, or None."""
        lane = self.lane_at(at)
        if lane is None:
            return None
        best: tuple[float, Contact, Part] | None = None
        for contact in self.contacts:
            if key_of(contact) != lane.key:
                continue
            box = self.box_of(contact)
            # A short one can still be taken by its middle.
            inner = _EDGE if box.width() > _WIDE else 0.25 * box.width()
            away = max(box.left() - at.x(), at.x() - box.right(), 0.0)
            if away > _EDGE:
                continue
            part = Part.BODY
            if at.x() < box.left() + inner:
                part = Part.START
            elif at.x() > box.right() - inner:
                part = Part.END
            if best is None or away < best[0]:
                best = away, contact, part
        return None if best is None else best[1:]

    # -- mouse

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take hold of a contact or of an empty place, or do what every plot does."""
        at = event.position()
        lane = self.lane_at(at)
        plain = event.button() == Qt.MouseButton.LeftButton
        if not plain or lane is None or self._near_head_grip(at):
            super().mousePressEvent(event)
            return
        extend = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
        hit, frames = self.hit(at), self.time_range.frames
        if hit is None:
            self._grip = _Grip(at, None, Part.BODY, Room(0, frames), lane, extend)
        else:
            contact, part = hit
            others = others_of(contact, self.contacts)
            room = room_for(contact.start, contact.end, others, frames)
            self._grip = _Grip(at, contact, part, room, lane, extend)
            if not extend and contact.id not in self._chosen:
                self.picked.emit(contact.id, False)
        event.accept()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Drag what is held, or hover."""
        if self._grip is None:
            super().mouseMoveEvent(event)
            return
        at, grip = event.position(), self._grip
        grip.moved |= abs(at.x() - grip.at.x()) > _STILL
        if grip.moved:
            self._drag(at, done=False)
        event.accept()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let go."""
        if self._grip is None:
            super().mouseReleaseEvent(event)
            return
        if event.button() == Qt.MouseButton.LeftButton:
            grip = self._grip
            if grip.moved:
                self._drag(event.position(), done=True)
            elif grip.contact is not None:
                self.picked.emit(grip.contact.id, grip.extend)
            else:
                self.picked.emit(None, False)
                self.scrubbed.emit(self.whole_frame_at(event.position().x()))
            self._grip = None
        event.accept()

    def _drag(self, at: QPointF, *, done: bool) -> None:
        grip = self._grip
        assert grip is not None
        if grip.contact is not None:
            by = round(self.frame_at(at.x()) - self.frame_at(grip.at.x()))
            self.shaped.emit(reshaped(grip.contact, grip.part, by, grip.room), grip.part, done)
        elif grip.lane is not None:
            own = [one for one in self.contacts if key_of(one) == grip.lane.key and one.id]
            a, b = self.whole_frame_at(grip.at.x()), self.whole_frame_at(at.x())
            span = swept(a, b, own, self.time_range.frames)
            if span is not None:
                self.drawn.emit(grip.lane.key, *span, done)

    def _near_head_grip(self, at: QPointF) -> bool:
        return at.y() < self.area.top()

    def holds(self, at: QPointF) -> bool:
        """Tell whether something is here that a click is meant for."""
        return self.hit(at) is not None

    def hover(self, at: QPointF | None) -> None:
        """Mark the contact under the mouse, and show what would be held of it."""
        hit = None if at is None else self.hit(at)
        found = None if hit is None else hit[0].id
        if found != self._hovered:
            self._hovered = found
            self._bars.refresh()
        if at is None or self.lane_at(at) is None:
            return
        shape = Qt.CursorShape.CrossCursor
        if hit is not None:
            shape = Qt.CursorShape.OpenHandCursor
            if hit[1] is not Part.BODY:
                shape = Qt.CursorShape.SizeHorCursor
        if self.viewport().cursor().shape() != shape:
            self.viewport().setCursor(QCursor(shape))

    # -- drawing

    def _draw_ground(self, p: QPainter, area: QRectF) -> None:
        keys: set[Key] = {key_of(one) for one in self.contacts if one.id in self._chosen}
        lane_drawing.draw_rows(p, area, self.lanes, keys)

    def _draw_bars(self, p: QPainter, area: QRectF) -> None:
        known = {lane.key for lane in self.lanes}
        for contact in _chosen_last(self.contacts, self._chosen):
            if key_of(contact) not in known:
                continue
            box = self.box_of(contact)
            if box.right() < area.left() or box.left() > area.right():
                continue
            lane_drawing.draw_bar(
                p,
                Bar(contact, box),
                chosen=contact.id in self._chosen,
                hovered=contact.id == self._hovered,
                unmet=contact.id in self._unmet,
            )
        if self._trim is not None:
            left, right = self.x_of(self._trim[0] - 0.5), self.x_of(self._trim[1] - 0.5)
            draw_trim(p, area, left, right)


def _chosen_last(contacts: Sequence[Contact], chosen: frozenset[str]) -> list[Contact]:
    return sorted(contacts, key=lambda one: one.id in chosen)
