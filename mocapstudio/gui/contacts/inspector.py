"""The chosen contact: its span, its target, what it measures; or the contacts as a whole."""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker, Qt, QTimer
from PySide6.QtWidgets import (
    QComboBox,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QScrollArea,
    QSizePolicy,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from mocapstudio.cleaning.contacts.model import Contact, Target
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.contacts.bridge import ContactsBridge, ContactsUi
from mocapstudio.gui.contacts.lanes import key_of, lanes_of
from mocapstudio.gui.contacts.measuring import measured
from mocapstudio.gui.contacts.reading import Readings
from mocapstudio.gui.contacts.target_fields import TargetFields
from mocapstudio.gui.contacts.targets import KINDS, converted, kind_of
from mocapstudio.gui.contacts.troubles import contradicted, unmet_words
from mocapstudio.gui.widgets.fields import NumberField
from mocapstudio.gui.widgets.parts import header, label, panel, rule
from mocapstudio.motion.take import Take
from mocapstudio.review.state import DocumentState

_DRAGGED = 100
"""Milliseconds between two looks at a contact that is being dragged."""
_KINDS = {
    "fixed": "Fixed point",
    "floor": "Floor",
    "line": "Line",
    "following": "Partner's joint",
}
_TIPS = {
    "fixed": "The point stays at one place of the world",
    "floor": "The point stands still on a plane; where on it, is chosen so that least is disturbed",
    "line": "The point may slide along a line",
    "following": "The point stays with a joint of another performer",
}


class ContactInspector(QFrame):
    """Right of the viewport: everything about the chosen contact.

    Parameters
    ----------
    bridge
        What is chosen and dragged.
    readings
        Points of the take under review.
    actions
        The commands behind the buttons.
    """

    def __init__(self, bridge: ContactsBridge, readings: Readings, actions: Actions) -> None:
        super().__init__()
        self.setObjectName("contact-inspector")
        self.setProperty("role", "panel")
        self.setMinimumWidth(250)
        self._bridge, self._readings = bridge, readings
        self._name = label("", "heading", "contact-name")
        self._how = label("", "muted", "contact-how", wrap=True)
        self._first, self._last = _frame_field("contact-first"), _frame_field("contact-last")
        self._length = label("", "muted", "contact-length")
        self._kind = QComboBox()
        self._fields = TargetFields()
        self._figures = _Figures()
        self._trouble = label("", "muted", "contact-trouble", wrap=True)
        self._summary = label("", "muted", "contacts-summary", wrap=True)
        self._whole = _Figures()
        self._soon = QTimer(self)
        self._soon.setSingleShot(True)
        self._soon.setInterval(_DRAGGED)
        self._soon.timeout.connect(self._show)
        self._pages = QStackedWidget()
        self._pages.addWidget(self._make_summary(actions))
        self._pages.addWidget(self._make_contact(actions))
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(header("Contact"))
        column.addWidget(self._pages, 1)
        bridge.desk.changed.connect(self._follow)
        bridge.ui_changed.connect(self._follow_ui)
        readings.changed.connect(self._show)
        self._show()

    # -- state

    def _follow(self, old: DocumentState, new: DocumentState) -> None:
        if old.sitting is not new.sitting or old.take is not new.take:
            self._show()

    def _follow_ui(self, old: ContactsUi, new: ContactsUi) -> None:
        if old.held is None or new.held is None:
            self._show()
        elif not self._soon.isActive():
            self._soon.start()

    def _show(self) -> None:
        self._soon.stop()
        contact, take = self._bridge.chosen, self._bridge.desk.state.take
        if contact is None or take is None:
            self._pages.setCurrentIndex(0)
            self._show_summary()
        else:
            self._pages.setCurrentIndex(1)
            self._show_contact(contact, take)

    def _show_summary(self) -> None:
        contacts, reading = self._bridge.kept, self._readings.now
        drawn = sum(one.drawn for one in contacts)
        lines = ["Choose a contact on the lanes to see its target."]
        if contacts:
            count = f"{len(contacts)} contact{'' if len(contacts) == 1 else 's'}"
            lines.insert(0, f"{count}, {drawn} drawn by hand." if drawn else f"{count}.")
        else:
            lines = [
                "Contacts say what a heel, ball, toe or palm touches, and when. Solve then bends"
                " the motion so that nothing slides and hands stay together."
            ]
        short = self._bridge.ui.unreached
        if short:
            worst = max(one.millimetres for one in short)
            lines.append(f"{len(short)} out of reach, by {worst:.0f} mm at most: the nearest pose"
                         " was taken.")  # fmt: skip
        self._summary.setText("\n\n".join(lines))
        self._whole.setVisible(bool(contacts))
        if reading is not None and contacts:
            before = measured(reading, contacts, after=False)
            after = measured(reading, contacts, after=True) if reading.solved else None
            self._whole.tell(before.mean_slide, before.worst_gap,
                             *((None, None) if after is None
                               else (after.mean_slide, after.worst_gap)))  # fmt: skip

    def _show_contact(self, contact: Contact, take: Take) -> None:
        reading = self._readings.now
        points = () if reading is None else reading.points
        lanes = lanes_of(take.skeleton, points, [contact])
        self._name.setText(next(one.name for one in lanes if one.key == key_of(contact)))
        sure = f"detected, confidence {contact.confidence:.2f}"
        if contact.drawn:
            sure = "drawn by hand"
        self._how.setToolTip("Detecting again leaves it alone" if contact.drawn else "")
        count = len(self._bridge.ui.chosen)
        more = f" · {count} chosen" if count > 1 else ""
        self._how.setText(f"{contact.joint} · {sure}{more}")
        first = take.first_frame
        for field, value, low, high in (
            (self._first, contact.start, 0, contact.end - 1),
            (self._last, contact.end - 1, contact.start, take.frames - 1),
        ):
            with QSignalBlocker(field):
                field.setRange(first + low, first + high)
                field.setValue(first + value)
        self._length.setText(f"{take.seconds(contact.end - contact.start):.2f} s")
        with QSignalBlocker(self._kind):
            self._kind.setCurrentIndex(KINDS.index(kind_of(contact.target)))
        self._kind.setToolTip(_TIPS[kind_of(contact.target)])
        others = {} if reading is None else reading.others
        self._offer_partner(bool(others))
        self._fields.show_target(contact.target, others)
        trouble = ""
        if reading is not None:
            trouble = reading.trouble(contact)
            before = measured(reading, [contact], after=False)
            after = measured(reading, [contact], after=True) if reading.solved else None
            self._figures.tell(before.mean_slide, before.worst_gap,
                               *((None, None) if after is None
                                 else (after.mean_slide, after.worst_gap)))  # fmt: skip
        short = next((u for u in self._bridge.ui.unreached if u.contact == contact.id), None)
        if short is not None and not trouble:
            trouble = f"{_sentence(unmet_words(short))}: the nearest pose was taken."
        against = contradicted(contact, self._bridge.contacts)
        if against:
            trouble = f"{trouble} {_sentence(against)}: they cannot both be met.".strip()
        self._trouble.setText(trouble)
        self._trouble.setVisible(bool(trouble))

    def _offer_partner(self, there: bool) -> None:
        item = self._kind.model().item(KINDS.index("following"))  # type: ignore[attr-defined]
        item.setEnabled(there)
        item.setToolTip(_TIPS["following"] if there else "No other performer is open")

    # -- intents

    def _set_span(self) -> None:
        contact, take = self._bridge.chosen, self._bridge.desk.state.take
        if contact is None or take is None:
            return
        start, end = self._first.value() - take.first_frame, self._last.value() + 1
        end -= take.first_frame
        if (start, end) != (contact.start, contact.end) and start < end:
            self._bridge.desk.document.change_contact(
                contact.id, "Resize contact", start=start, end=end
            )

    def _set_kind(self, number: int) -> None:
        contact, reading = self._bridge.chosen, self._readings.now
        if contact is None or reading is None or kind_of(contact.target) == KINDS[number]:
            return
        target = converted(reading, contact, KINDS[number], self._bridge.desk.state.frame)
        if target is not None:
            self._set_target(target)
        else:
            self._show()

    def _set_target(self, target: Target) -> None:
        contact = self._bridge.chosen
        if contact is not None and target != contact.target:
            label_ = "Move target"
            if type(target) is not type(contact.target):
                label_ = "Change target"
            self._bridge.desk.document.change_contact(contact.id, label_, target=target)

    # -- layout

    def _make_summary(self, actions: Actions) -> QWidget:
        page, column = _page()
        column.addWidget(self._summary)
        column.addWidget(self._whole)
        column.addStretch(1)
        for name, text in (("contacts-detect", "Detect"), ("contacts-solve", "Solve")):
            column.addWidget(actions.push_button(name, text))
        return page

    def _make_contact(self, actions: Actions) -> QWidget:
        page, column = _page()
        column.addWidget(self._name)
        column.addWidget(self._how)
        column.addWidget(self._trouble)
        column.addLayout(self._make_span())
        column.addWidget(rule())
        column.addWidget(label("TARGET", "section"))
        self._kind.setObjectName("contact-kind")
        self._kind.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._kind.addItems([_KINDS[kind] for kind in KINDS])
        self._kind.activated.connect(self._set_kind)
        self._fields.changed.connect(self._set_target)
        column.addWidget(self._kind)
        column.addWidget(self._fields)
        column.addWidget(rule())
        column.addWidget(label("MEASURED", "section"))
        column.addWidget(self._figures)
        column.addStretch(1)
        return _with_foot(
            page,
            actions.push_button("contacts-split", "Split"),
            actions.push_button("contacts-merge", "Merge"),
            actions.push_button("contacts-delete", "Delete"),
        )

    def _make_span(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(6)
        self._first.setToolTip("First frame in contact, by the file's own numbers")
        self._last.setToolTip("Last frame in contact, by the file's own numbers")
        for field in (self._first, self._last):
            field.valueChanged.connect(lambda _: self._set_span())
        row.addWidget(label("Frames", "muted"))
        row.addWidget(self._first, 1)
        row.addWidget(label("–", "muted"))
        row.addWidget(self._last, 1)
        row.addWidget(self._length)
        return row


class _Figures(QWidget):
    """Slide and gap, before and after."""

    def __init__(self) -> None:
        super().__init__()
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 2, 0, 2)
        grid.setHorizontalSpacing(10)
        grid.setVerticalSpacing(4)
        for column, words in enumerate(("before", "after"), 1):
            grid.addWidget(label(words, "faint"), 0, column, Qt.AlignmentFlag.AlignRight)
        rows = (
            ("slide", "Mean slide", "How fast the point moves against what it touches, cm/s"),
            ("gap", "Largest gap", "How far the point is from its target, mm"),
        )
        self._cells: dict[str, tuple[QWidget, ...]] = {}
        for number, (name, words, tip) in enumerate(rows, 1):
            caption = label(words, "muted")
            cells = tuple(label("–", "readout", f"contact-{name}-{when}")
                          for when in ("before", "after"))  # fmt: skip
            grid.addWidget(caption, number, 0)
            for column, cell in enumerate(cells, 1):
                cell.setToolTip(tip)
                grid.addWidget(cell, number, column, Qt.AlignmentFlag.AlignRight)
            caption.setToolTip(tip)
            self._cells[name] = cells
        grid.setColumnStretch(0, 1)

    def tell(
        self,
        slide: float,
        gap: float,
        slide_after: float | None = None,
        gap_after: float | None = None,
    ) -> None:
        """Show cm/s and mm."""
        lines = {"slide": ("cm/s", 1, slide, slide_after), "gap": ("mm", 1, gap, gap_after)}
        for name, (unit, digits, *values) in lines.items():
            for cell, value in zip(self._cells[name], values, strict=True):
                cell.setText("–" if value is None else f"{value:.{digits}f} {unit}")  # type: ignore[attr-defined]


def _with_foot(page: QWidget, *buttons: QWidget) -> QWidget:
    """Put buttons under a page where they stay in sight however long it is."""
    whole, foot = QWidget(), panel("contact-foot")
    column, row = QVBoxLayout(whole), QHBoxLayout(foot)
    column.setContentsMargins(0, 0, 0, 0)
    column.setSpacing(0)
    row.setContentsMargins(12, 8, 12, 10)
    row.setSpacing(6)
    column.addWidget(page, 1)
    column.addWidget(foot)
    for one in buttons:
        row.addWidget(one)
    return whole


def _sentence(words: str) -> str:
    return words[:1].upper() + words[1:]


def _frame_field(name: str) -> NumberField:
    field = NumberField()
    field.setObjectName(name)
    field.setKeyboardTracking(False)
    field.setAlignment(Qt.AlignmentFlag.AlignRight)
    field.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
    field.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
    return field


def _page() -> tuple[QScrollArea, QVBoxLayout]:
    area = QScrollArea()
    area.setWidgetResizable(True)
    area.setFrameShape(QFrame.Shape.NoFrame)
    area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    inner = QFrame()
    inner.setProperty("role", "panel")
    column = QVBoxLayout(inner)
    column.setContentsMargins(12, 10, 12, 12)
    column.setSpacing(9)
    area.setWidget(inner)
    return area, column
