"""The viewport of the workspace: the performers, and the targets of their contacts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QPointF, Qt, Signal
from PySide6.QtWidgets import QToolTip

from mocapstudio.cleaning.contacts.model import Contact
from mocapstudio.gui import theme
from mocapstudio.gui.contacts.bending import Bending
from mocapstudio.gui.contacts.bridge import ContactsBridge, ContactsUi
from mocapstudio.gui.contacts.dragging import Dragging
from mocapstudio.gui.contacts.holding import Holding
from mocapstudio.gui.contacts.lane_drawing import kind_colour, kind_words
from mocapstudio.gui.contacts.overlay3d import Mark, Overlay
from mocapstudio.gui.contacts.posing import Posing
from mocapstudio.gui.contacts.reading import Readings
from mocapstudio.gui.viewport.palette import rgb
from mocapstudio.gui.viewport.world import StandIn, WorldMotion
from mocapstudio.gui.views.viewport import Viewport
from mocapstudio.review.state import DocumentState

Array = NDArray[np.float64]


class ContactsStage(Viewport):
    """Shows targets of the contacts at the current frame; they are dragged by the mouse.

    A ring is a target, filled where it is chosen; a line leads to it from a point that is not
    there. With key poses on, hands and feet themselves are dragged.

    Parameters
    ----------
    bridge
        What is chosen and dragged.
    readings
        Points of the take under review.
    """

    target_dropped = Signal(object, object)
    """Emitted once a target is let go, with its contact as it was dragged and the `KeptFrame`."""

    def __init__(self, bridge: ContactsBridge, readings: Readings) -> None:
        self._contacts, self._readings = bridge, readings
        self._said = ""
        self.overlay: Overlay | None = None
        self.dragging: Dragging | None = None
        super().__init__(bridge.desk)
        self.setObjectName("contacts-viewport")
        self.bending = Bending(self._motion, self._stand_in)
        self.holding = Holding(bridge, readings, self.bending, self.camera, self._picture_size)
        self.posing = Posing(bridge, readings, self.bending)
        if self._canvas is not None:
            self.overlay = Overlay(self._canvas.renderer)
            self.dragging = Dragging(self._canvas, self.camera, self, self._stir)
        bridge.ui_changed.connect(self._follow_contacts)
        readings.changed.connect(self._stir)

    # -- what can be dragged

    def places(self) -> tuple[Sequence[str], Array]:
        """Targets at the current frame, the chosen first; with key poses on, hands and feet."""
        if self._contacts.ui.posing:
            return self.posing.places(self._bridge.state.frame)
        here = self._here()
        return [one.id for one, _ in here], np.array([place for _, place in here]).reshape(-1, 3)

    def taken(self, name: str, alone: bool) -> bool:
        """Take hold of a target, `alone` or with what stands with it; or of a hand or foot."""
        self._said = ""
        if self._contacts.ui.posing:
            return self.posing.taken(name)
        self._contacts.choose(name)
        return self.holding.taken(name, alone)

    def dragged(self, name: str, place: Array, lock: int | None, mouse: QPointF) -> None:
        """Bring what is held to a place."""
        if self._contacts.ui.posing:
            words = self.posing.dragged(place)
        else:
            words = self.holding.dragged(place, lock, (mouse.x(), mouse.y()))
        # A window of its own costs as much as the frame: it is moved only when it says more.
        if words == self._said or self._canvas is None:
            return
        self._said = words
        if words:
            QToolTip.showText(self._canvas.mapToGlobal(mouse.toPoint()), words, self._canvas)
        else:
            QToolTip.hideText()

    def dropped(self, name: str) -> None:
        """Let it become an edit."""
        QToolTip.hideText()
        if self._contacts.ui.posing:
            self.posing.dropped()
            return
        held = self.holding.dropped()
        if held is not None:
            self.target_dropped.emit(held, self.bending.kept)

    def cancelled(self, name: str) -> None:
        """Leave everything as it was."""
        self.posing.cancelled()
        self.holding.cancelled()

    # -- the picture

    def pixel_of(self, place: Array) -> QPointF | None:
        """Where a place of the world is in the picture, or None behind the camera."""
        pixels, _ = self.camera.project(np.asarray(place)[None], self._picture_size())
        x, y = pixels[0]
        return None if np.isnan(x) else QPointF(float(x), float(y))

    def _picture_size(self) -> tuple[int, int]:
        widget = self if self._canvas is None else self._canvas
        return widget.width(), max(widget.height(), 1)

    def _here(self) -> list[tuple[Contact, Array]]:
        """Contacts with their targets at the current frame; the chosen one at every frame."""
        reading, frame = self._readings.now, self._bridge.state.frame
        if reading is None or reading.source is not self._bridge.state.take:
            return []
        chosen = self._contacts.chosen
        found = []
        for contact in self._contacts.contacts:
            mine = chosen is not None and contact.id == chosen.id
            if contact.id and (mine or contact.start <= frame < contact.end):
                place = self.holding.place(contact, frame)
                if place is not None:
                    found.append((contact, place))
        return sorted(found, key=lambda one: chosen is None or one[0].id != chosen.id)

    def _cast(self, state: DocumentState) -> None:
        # The body's colours are the digression map's elsewhere; here they would say nothing.
        super()._cast(replace(state, analyses={}))
        if self.bending.shown is not None:
            self._stand_in(self.bending.shown)

    def _prepare(self) -> None:
        super()._prepare()
        if self.overlay is None:
            return
        marks = [self._mark(contact, place) for contact, place in reversed(self._here())]
        handles = []
        if self._contacts.ui.posing:
            _, places = self.posing.places(self._bridge.state.frame)
            handles = [(place, self._palette.accent) for place in places]
        self.overlay.draw(marks, handles, self._axes(), self.camera, self._picture_size()[1])

    def _mark(self, contact: Contact, place: Array) -> Mark:
        reading, frame = self._readings.now, self._bridge.state.frame
        chosen = self._contacts.chosen
        point = None
        held = self._contacts.ui.held
        if held is not None and contact.id == held.id:
            point = self.bending.place_at(frame)
        elif reading is not None and contact in self._contacts.ui.along:
            point = self.bending.place_at(frame, reading.point(contact))
        if point is None and reading is not None and contact.start <= frame < contact.end:
            point = reading.place(contact, after=True)[frame - contact.start]
        colour = rgb(kind_colour(theme.current(), contact.target))
        return Mark(place, point, colour, chosen is not None and contact.id == chosen.id)

    def _axes(self) -> tuple[Array, Sequence[int]] | None:
        drag = self.dragging
        if drag is None or drag.holding is None or drag.lock is None:
            return None
        names, places = self.places()
        if drag.holding not in names:
            return None
        return places[list(names).index(drag.holding)], (drag.lock,)

    def _motion(self) -> WorldMotion | None:
        roles = self.director.roles
        return roles[0].motion if roles else None

    def _stand_in(self, motion: StandIn | None) -> None:
        """Show the body as it is dragged, or as it is."""
        if motion is None:
            self._recast()
        else:
            self.director.stand_in(motion)
            if self._scene is not None:
                self._scene.stand_in(motion)
            self._stir()

    def _follow_contacts(self, old: ContactsUi, new: ContactsUi) -> None:
        if old.held is not None and new.held is None:
            self.bending.end()
        self._stir()

    def _hover(self, at: QPointF) -> None:
        name = None if self.dragging is None else self.dragging.handle_at(at)
        contact = None if name is None else self._contacts.contact(name)
        if name is None or self._canvas is None:
            super()._hover(at)
            return
        self._canvas.setCursor(Qt.CursorShape.OpenHandCursor)
        words = name if contact is None else f"{contact.joint} {contact.point or ''}".strip()
        if contact is not None:
            words += f" · {kind_words(contact.target)} · {self._drag_words(contact)}"
        QToolTip.showText(self._canvas.mapToGlobal(at.toPoint()), words, self._canvas)

    def _drag_words(self, contact: Contact) -> str:
        alone = ", with Ctrl this point alone" if self.holding.company(contact) else ""
        end = "hand" if contact.point == "palm" else "foot"
        whole = f"drag to move the {end}" if alone else "drag to move"
        return f"{whole}{alone}; X Y Z lock an axis"
