"""Lanes of end effectors over time, their names left of them."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QPointF, QRectF, Qt, QTimer, Signal
from PySide6.QtGui import QColor, QFontMetricsF, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QHBoxLayout, QToolTip, QWidget

from mocapstudio.cleaning.contacts.model import Contact, Fixed
from mocapstudio.gui import theme as themes
from mocapstudio.gui import wording
from mocapstudio.gui.contacts.bridge import ContactsBridge, ContactsUi
from mocapstudio.gui.contacts.lane_drawing import ROW, kind_words, row_height
from mocapstudio.gui.contacts.lane_gestures import Part
from mocapstudio.gui.contacts.lane_plot import LanePlot
from mocapstudio.gui.contacts.lanes import Key, Lane, key_of, lanes_of
from mocapstudio.gui.contacts.measuring import lane_slides
from mocapstudio.gui.contacts.reading import Readings
from mocapstudio.gui.contacts.troubles import contradicted, unmet_words
from mocapstudio.gui.plots.axes import TIME_AXIS_HEIGHT, small_font
from mocapstudio.gui.plots.time_plot import LEFT_GUTTER, RIGHT_GUTTER
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.gui.widgets.native import NativeView
from mocapstudio.gui.widgets.parts import Hint
from mocapstudio.review.state import DocumentState

_DWELL = 350
_ROOM, _FEWEST = 4, 4
_NONE = (
    "Nothing is in contact yet.  F5 detects what feet and hands touch;  or drag along a lane to "
    "draw a contact."
)
_NO_LANES = (
    "This skeleton has neither feet nor hands that could be told apart; contacts of other joints "
    "can be loaded from a file."
)


class LanesView(NativeView):
    """A lane for each heel, ball, toe and palm, with its contacts.

    Parameters
    ----------
    bridge
        What is chosen and dragged.
    readings
        Points of the take under review.
    time_range
        The visible frames, shared with the curves.
    """

    draw_wanted = Signal(object, int, int)
    """Key of a lane, and a half-open span in which a contact was drawn by hand."""

    def __init__(self, bridge: ContactsBridge, readings: Readings, time_range: TimeRange) -> None:
        super().__init__()
        self.setObjectName("contacts-lanes")
        # A native window of its own spares the desk from compositing itself at every play head.
        self.setProperty("role", "panel")
        self._bridge, self._readings = bridge, readings
        self.time_range = time_range
        self.plot = LanePlot(time_range)
        self.names = _Gutter(self.plot, LEFT_GUTTER, right=True)
        self.figures = _Gutter(self.plot, RIGHT_GUTTER, right=False)
        self.figures.setToolTip("Mean slide in contact, cm/s: before, and after the solve")
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        for part in (self.names, self.plot, self.figures):
            row.addWidget(part, 1 if part is self.plot else 0)
        self.hint = Hint(self.plot, "contacts-hint")
        self.setMinimumHeight(96)
        self._slides: dict[Key, str] = {}
        self._pointer: QPointF | None = None
        self._dwell = QTimer(self)
        self._dwell.setSingleShot(True)
        self._dwell.setInterval(_DWELL)
        self._dwell.timeout.connect(self._show_tip)
        self._connect()
        self._show()

    def _connect(self) -> None:
        bridge, plot = self._bridge, self.plot
        plot.scrubbed.connect(lambda frame: bridge.desk.document.set_frame(frame))
        plot.picked.connect(bridge.choose)
        plot.shaped.connect(self._shape)
        plot.drawn.connect(self._draw)
        plot.hovered.connect(self._hover)
        plot.focus_wanted.connect(self.zoom_to_chosen)
        self.names.chosen.connect(self._choose_lane)
        bridge.desk.changed.connect(self._follow)
        bridge.ui_changed.connect(self._follow_ui)
        self._readings.changed.connect(self._show)

    @property
    def lanes(self) -> tuple[Lane, ...]:
        """The lanes that are shown."""
        return self.plot.lanes

    @property
    def full_height(self) -> int:
        """Pixels in which all lanes are as high as they can be."""
        return TIME_AXIS_HEIGHT + round(ROW * max(len(self.lanes), _FEWEST)) + _ROOM

    def zoom_to_chosen(self) -> None:
        """Zoom to the chosen contact."""
        chosen = self._bridge.chosen
        if chosen is not None:
            self.time_range.focus(chosen.start, chosen.end)

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        self.plot.restyle()
        self.names.update()
        self.figures.update()

    # -- state

    def _follow(self, old: DocumentState, new: DocumentState) -> None:
        if old.frame != new.frame or old.take is not new.take:
            self.plot.set_frame(new.frame)
            self.time_range.reveal(new.frame)
        if old.sitting is not new.sitting or old.take is not new.take:
            self._show()

    def _follow_ui(self, old: ContactsUi, new: ContactsUi) -> None:
        if new.held is None and old.held is not None:
            self.plot.let_go()
        self._show()

    def _show(self) -> None:
        state, bridge, reading = self._bridge.desk.state, self._bridge, self._readings.now
        take = state.take
        lanes: tuple[Lane, ...] = ()
        if take is not None:
            self.time_range.set_frames(take.frames)
            self.plot.time_axis.set_clock(float(take.rate), take.first_frame)
            points = () if reading is None else reading.points
            lanes = lanes_of(take.skeleton, points, bridge.contacts)
        trim = dict(state.sitting.trims).get(state.active, None if take is None else take.trim)
        chosen = frozenset(bridge.ui.chosen)
        unmet = frozenset(one.contact for one in bridge.ui.unreached)
        if reading is not None:
            unmet |= {one.id for one in bridge.contacts if reading.trouble(one)}
        self.plot.show_contacts(lanes, bridge.contacts, chosen, unmet, trim)
        self.plot.set_frame(state.frame)
        keys = {key_of(one) for one in bridge.contacts if one.id in chosen}
        self.names.show_words({lane.key: lane.name for lane in lanes}, keys)
        # Measured again once it is let go: the curves show the lane that is dragged.
        if bridge.ui.held is None:
            self._slides = {} if reading is None else lane_slides(reading, bridge.contacts)
        slides = self._slides
        self.figures.show_words({lane.key: slides.get(lane.key, "") for lane in lanes}, keys)
        words = ""
        if take is not None and reading is not None:
            words = _NO_LANES if not lanes else ("" if bridge.contacts else _NONE)
        self.hint.say(words)

    # -- intents

    def _shape(self, contact: Contact, part: Part, done: bool) -> None:
        if not done:
            self._bridge.set_ui(held=contact)
            if part is not Part.BODY:
                # What lies at the edge shows whether the edge is right.
                frame = contact.start if part is Part.START else contact.end - 1
                self._bridge.desk.document.set_frame(frame)
            return
        self._bridge.set_ui(held=None)
        label = "Move contact" if part is Part.BODY else "Resize contact"
        self._bridge.desk.document.change_contact(
            contact.id, label, start=contact.start, end=contact.end
        )

    def _draw(self, key: Key, start: int, end: int, done: bool) -> None:
        if done:
            self._bridge.set_ui(held=None)
            self.draw_wanted.emit(key, start, end)
            return
        ghost = Contact("", key[0], key[1], start, end, Fixed((0.0, 0.0, 0.0)), 1.0, True)
        self._bridge.set_ui(held=ghost)

    def _choose_lane(self, key: Key) -> None:
        """Choose the lane's contact at the play head, or the next one."""
        frame = self._bridge.desk.state.frame
        own = [one for one in self._bridge.contacts if key_of(one) == key]
        here = next((one for one in own if one.end > frame), own[-1] if own else None)
        if here is not None:
            self._bridge.choose(here.id)
        else:
            self._bridge.desk.document.select(joints={key[0]}, flag="")

    # -- reading off

    def _hover(self, at: QPointF | None) -> None:
        self.plot.hover(at)
        self._pointer = at
        if at is None or self.plot.hit(at) is None:
            self._dwell.stop()
            QToolTip.hideText()
        else:
            self._dwell.start()

    def _show_tip(self) -> None:
        words = "" if self._pointer is None else self.read_out(self._pointer)
        if words and self._pointer is not None:
            at = self.plot.viewport().mapToGlobal(self._pointer.toPoint()) + QPoint(10, 6)
            QToolTip.showText(at, words, self.plot)

    def read_out(self, at: QPointF) -> str:
        """Say in words what lies at a place of the plot, or "" where nothing does."""
        hit, take = self.plot.hit(at), self._bridge.desk.state.take
        if hit is None or take is None:
            return ""
        contact = hit[0]
        lane = next(one.name for one in self.lanes if one.key == key_of(contact))
        sure = "drawn by hand" if contact.drawn else f"confidence {contact.confidence:.2f}"
        words = [f"{lane} · {kind_words(contact.target)} · {sure}"]
        words.append(wording.span(take, contact.start, contact.end))
        trouble = "" if self._readings.now is None else self._readings.now.trouble(contact)
        short = next((u for u in self._bridge.ui.unreached if u.contact == contact.id), None)
        if trouble:
            words.append(trouble)
        elif short is not None:
            words.append(unmet_words(short))
        against = contradicted(contact, self._bridge.contacts)
        if against:
            words.append(against)
        return "\n".join(words)


class _Gutter(QWidget):
    """Words beside the lanes."""

    chosen = Signal(object)
    """The key of the lane that was clicked."""

    def __init__(self, plot: LanePlot, width: int, *, right: bool) -> None:
        super().__init__()
        self._plot, self._right = plot, right
        self._words: dict[Key, str] = {}
        self._marked: set[Key] = set()
        self.setFixedWidth(width)

    def show_words(self, words: dict[Key, str], marked: set[Key]) -> None:
        """Show a line for each lane."""
        if (words, marked) != (self._words, self._marked):
            self._words, self._marked = words, marked
            self.update()

    def _box(self, row: int) -> QRectF:
        # The plot's own layout may lag behind by one event.
        area = QRectF(0, TIME_AXIS_HEIGHT, self.width(), self.height() - TIME_AXIS_HEIGHT)
        height = row_height(area, len(self._words))
        return QRectF(0, area.top() + row * height, area.width(), height)

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw the words."""
        look = themes.current()
        p = QPainter(self)
        p.fillRect(self.rect(), QColor(look.panel))
        p.setFont(small_font())
        side = Qt.AlignmentFlag.AlignRight if self._right else Qt.AlignmentFlag.AlignLeft
        metrics = QFontMetricsF(small_font())
        for row, (key, words) in enumerate(self._words.items()):
            p.setPen(QColor(look.text if key in self._marked else look.muted))
            room = self._box(row).adjusted(*((8, 0, -10, 0) if self._right else (6, 0, -1, 0)))
            text = metrics.elidedText(words, Qt.TextElideMode.ElideRight, room.width())
            p.drawText(room, int(side | Qt.AlignmentFlag.AlignVCenter), text)
        p.end()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose the lane."""
        for row, key in enumerate(self._words):
            if self._box(row).contains(event.position()):
                self.chosen.emit(key)
