"""The fields of a target: numbers and joints, as its kind has them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QSizePolicy,
    QWidget,
)

from mocapstudio.cleaning.contacts.model import Fixed, Floor, Following, Line, Target
from mocapstudio.gui.widgets.fields import DecimalField
from mocapstudio.gui.widgets.parts import label
from mocapstudio.motion.take import Take

_AXES = ("X", "Y", "Z")


class MetresField(DecimalField):
    """A length in metres."""

    def __init__(self, tip: str) -> None:
        super().__init__(-1000.0, 1000.0, 0.01, 3)
        self.setToolTip(tip)


class TargetFields(QWidget):
    """Shows a target and lets it be changed by number or name."""

    changed = Signal(object)
    """Emitted with the `Target` that the user made."""

    def __init__(self) -> None:
        super().__init__()
        self._target: Target | None = None
        self._others: Mapping[str, Take] = {}
        self._place = self._triple("target", "{} of the target in the world, metres")
        self._way = self._triple("direction", "{} of the line's direction")
        self._offset = self._triple("offset", "{} of the point in the joint's frame, metres")
        self._height = MetresField("Height of the floor above the world's zero, metres")
        self._height.setObjectName("contact-height")
        self._performer, self._joint = _combo("contact-performer"), _combo("contact-followed")
        self._performer.setToolTip("Whose joint the point stays with")
        self._joint.setToolTip("The joint that the point stays with")
        self._rows: list[tuple[QWidget, QWidget, Callable[[Target], bool]]] = []
        self._lay_out()
        self._connect()

    def show_target(self, target: Target, others: Mapping[str, Take]) -> None:
        """Show a target; `others` may be followed."""
        self._target, self._others = target, others
        for caption, widget, fits in self._rows:
            caption.setVisible(fits(target))
            widget.setVisible(fits(target))
        if isinstance(target, Fixed | Line):
            _fill(self._place, target.position)
        if isinstance(target, Line):
            _fill(self._way, target.direction)
        if isinstance(target, Floor):
            _fill([self._height], [target.height])
        if isinstance(target, Following):
            _fill(self._offset, target.offset)
            _offer(self._performer, [*others], target.performer)
            other = others.get(target.performer)
            names = () if other is None else other.skeleton.names
            _offer(self._joint, names, target.joint)

    def _triple(self, name: str, tip: str) -> list[MetresField]:
        fields = [MetresField(tip.format(axis)) for axis in _AXES]
        for axis, one in zip(_AXES, fields, strict=True):
            one.setObjectName(f"contact-{name}-{axis.lower()}")
        return fields

    def _lay_out(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(8)
        grid.setVerticalSpacing(6)
        grid.setColumnStretch(1, 1)
        lines: list[tuple[str, QWidget, Callable[[Target], bool]]] = [
            ("Place", _row(self._place), lambda t: isinstance(t, Fixed | Line)),
            ("Along", _row(self._way), lambda t: isinstance(t, Line)),
            ("Height", self._height, lambda t: isinstance(t, Floor)),
            ("Partner", self._performer, lambda t: isinstance(t, Following)),
            ("Joint", self._joint, lambda t: isinstance(t, Following)),
            ("Offset", _row(self._offset), lambda t: isinstance(t, Following)),
        ]
        for number, (words, widget, fits) in enumerate(lines):
            caption = label(words, "muted")
            caption.setFixedWidth(52)
            grid.addWidget(caption, number, 0)
            grid.addWidget(widget, number, 1)
            self._rows.append((caption, widget, fits))

    def _connect(self) -> None:
        for one in (*self._place, *self._way, *self._offset, self._height):
            one.valueChanged.connect(lambda _: self._send())
        self._performer.activated.connect(lambda _: self._send())
        self._joint.activated.connect(lambda _: self._send())

    def _send(self) -> None:
        target = self._target
        made: Target | None = None
        if isinstance(target, Fixed):
            made = Fixed(_values(self._place))
        elif isinstance(target, Line):
            way = _values(self._way)
            if any(way):
                made = Line(_values(self._place), way)
        elif isinstance(target, Floor):
            made = replace(target, height=self._height.value())
        elif isinstance(target, Following):
            made = self._followed(target)
        if made is not None and made != target:
            self.changed.emit(made)

    def _followed(self, target: Following) -> Following:
        performer, joint = self._performer.currentText(), self._joint.currentText()
        other = self._others.get(performer)
        if other is not None and joint not in other.skeleton.index:
            joint = other.skeleton.names[0]
        return replace(target, performer=performer, joint=joint, offset=_values(self._offset))


def _combo(name: str) -> QComboBox:
    made = QComboBox()
    made.setObjectName(name)
    made.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    made.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
    return made


def _offer(combo: QComboBox, names: Sequence[str], chosen: str) -> None:
    with QSignalBlocker(combo):
        if [combo.itemText(i) for i in range(combo.count())] != list(names):
            combo.clear()
            combo.addItems(list(names))
        combo.setCurrentIndex(combo.findText(chosen))


def _row(fields: Sequence[QWidget]) -> QWidget:
    holder = QWidget()
    row = QHBoxLayout(holder)
    row.setContentsMargins(0, 0, 0, 0)
    row.setSpacing(4)
    for one in fields:
        row.addWidget(one, 1)
    return holder


def _fill(fields: Sequence[MetresField], values: Sequence[float]) -> None:
    for one, value in zip(fields, values, strict=True):
        with QSignalBlocker(one):
            one.setValue(value)


def _values(fields: Sequence[MetresField]) -> tuple[float, float, float]:
    x, y, z = (one.value() for one in fields)
    return x, y, z
