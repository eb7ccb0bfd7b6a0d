"""The fields by which the user decides how a file is read."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

from PySide6.QtWidgets import QComboBox, QGridLayout, QHBoxLayout, QLabel, QLineEdit, QWidget

from mocapstudio.formats import Problem, ReadOptions
from mocapstudio.formats.options import UNITS, parse_rate, parse_unit
from mocapstudio.gui.widgets.parts import label

RATES = ("24", "25", "29.97", "30", "50", "59.94", "60", "100", "119.88", "120", "200", "240")

_AS_STATED = "automatic"
_ALL = frozenset({"bvh", "amc", "c3d", "trc", "csv", "tsv", "fbx"})
_AXES = (("x", "X"), ("y", "Y"), ("z", "Z"))
_AHEAD = tuple((f"{sign}{axis}", f"{sign}{axis.upper()}") for axis in "xyz" for sign in ("", "-"))


@dataclass(frozen=True)
class _Field:
    """One override.

    Parameters
    ----------
    name
        Field of `ReadOptions`.
    text, tip
        What it is called, and what it does.
    choices
        Values and what they are called; none for a text that can also be typed.
    formats
        Which formats read it.
    """

    name: str
    text: str
    tip: str
    choices: tuple[tuple[Any, str], ...]
    formats: frozenset[str]


_FIELDS = (
    _Field("fps", "Frame rate", "Frames a second, in place of what the file says", (), _ALL),
    _Field("unit", "Unit of length", "A unit, or what it is in metres", (), _ALL),
    _Field("up", "Up axis", "The axis of the file that points up",
           ((None, _AS_STATED), *_AXES), _ALL),
    _Field("forward", "Forward axis",
           "The axis that points forward; automatic turns no more than the up axis needs",
           ((None, "automatic"), *_AHEAD), _ALL - {"trc"}),
    _Field("angles", "Angles", "Unit of the file's angles",
           (("degrees", "degrees"), ("radians", "radians")), frozenset({"bvh", "amc"})),
    _Field("root_offset", "Root offset", "What the root's position does to its OFFSET",
           (("replace", "replaced by the position"), ("add", "added to the position")),
           frozenset({"bvh"})),
    _Field("trim_start", "T-pose rows", "Rows of a T-pose before the motion",
           ((True, "left out of the analysis"), (False, "kept as motion")), frozenset({"bvh"})),
    _Field("lenient", "Row count", "Where a file has another number of rows than it states",
           ((False, "must be as stated"), (True, "read the whole rows there are")),
           frozenset({"bvh", "amc", "c3d", "trc", "csv", "tsv"})),
)  # fmt: skip

FIELD_TEXTS = {one.name: one.text for one in _FIELDS}
"""What the fields of `ReadOptions` are called."""


class ReadingForm(QWidget):
    """A field for each override, in two columns; what was guessed is marked."""

    def __init__(self) -> None:
        super().__init__()
        self._boxes: dict[str, QComboBox] = {}
        self._marks: dict[str, QLabel] = {}
        self._before = ReadOptions()
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(12)
        grid.setVerticalSpacing(8)
        half = (len(_FIELDS) + 1) // 2
        for at, one in enumerate(_FIELDS):
            row, column = at % half, 2 * (at // half)
            grid.addLayout(self._caption(one), row, column)
            grid.addWidget(self._make(one), row, column + 1)
        grid.setColumnStretch(1, 1)
        grid.setColumnStretch(3, 1)

    def show_options(
        self, options: ReadOptions, kind: str, problems: Iterable[Problem] = ()
    ) -> None:
        """Show how a file was read.

        Parameters
        ----------
        kind
            Short name of the file's format; fields that it does not read cannot be set.
        problems
            What was odd; fields whose value was guessed are marked.
        """
        self._before = options
        guessed = {one.override for one in problems if one.guess}
        for one in _FIELDS:
            box = self._boxes[one.name]
            box.setEnabled(kind in one.formats)
            self._marks[one.name].setVisible(one.name in guessed)
            value = getattr(options, one.name)
            if one.choices:
                box.setCurrentIndex(box.findData(value))
            else:
                box.setEditText(_as_text(one.name, value))

    def options(self) -> ReadOptions:
        """Return what the fields say.

        Raises
        ------
        ParameterError
            If a rate or a unit is none.
        """
        chosen: dict[str, Any] = {}
        for one in _FIELDS:
            box = self._boxes[one.name]
            text = box.currentText().strip()
            if one.choices:
                chosen[one.name] = box.currentData()
            elif not text:
                chosen[one.name] = None
            else:
                chosen[one.name] = parse_rate(text) if one.name == "fps" else parse_unit(text)
        return replace(self._before, **chosen)

    def point_to(self, name: str) -> None:
        """Put the keyboard into a field."""
        if name in self._boxes:
            self._boxes[name].setFocus()

    def _caption(self, one: _Field) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(7)
        row.addWidget(label(one.text, "muted"))
        mark = label("guessed", "guess", f"reading-{one.name}-guessed")
        mark.hide()
        self._marks[one.name] = mark
        row.addWidget(mark)
        row.addStretch(1)
        return row

    def _make(self, one: _Field) -> QComboBox:
        box = QComboBox()
        box.setObjectName(f"reading-{one.name}")
        box.setToolTip(one.tip)
        box.setAccessibleName(one.text)
        self._boxes[one.name] = box
        for value, text in one.choices:
            box.addItem(text, value)
        if not one.choices:
            box.setEditable(True)
            box.setInsertPolicy(QComboBox.InsertPolicy.NoInsert)
            box.addItems(RATES if one.name == "fps" else tuple(UNITS))
            box.setCurrentIndex(-1)
            field = QLineEdit()
            box.setLineEdit(field)
            field.setObjectName(f"reading-{one.name}-text")
            field.setPlaceholderText(_AS_STATED)
        return box


def _as_text(name: str, value: Any) -> str:
    if value is None:
        return ""
    if name == "unit":
        return next((unit for unit, metres in UNITS.items() if metres == value), f"{value:g}")
    return f"{float(value):.6g}"
