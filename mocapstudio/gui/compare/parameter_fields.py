"""One field for each parameter of a comparison, made of what the schema says about it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QSignalBlocker, Qt
from PySide6.QtWidgets import QCheckBox, QComboBox, QSizePolicy, QWidget

from mocapstudio.gui.widgets.fields import DecimalField
from mocapstudio.motion.parameters import Schema

Changed = Callable[[Any], object]


class Field:
    """Shows the value of one parameter and tells when the user changes it.

    Parameters
    ----------
    name, schema, default
        Of the parameter.
    changed
        Called with the new value.
    """

    def __init__(self, name: str, schema: Schema, default: Any, changed: Changed) -> None:
        self.name, self.schema, self.default = name, schema, default
        self.widget: QWidget
        if schema.choices:
            self.widget = self._choices(changed)
        elif schema.low is not None and schema.high is not None:
            self.widget = self._number(schema.low, schema.high, changed)
        else:
            self.widget = self._switch(changed)
        self.widget.setObjectName(f"parameter-{name}")
        self.widget.setAccessibleName(schema.label)
        self.widget.setToolTip(self.tip)

    @property
    def tip(self) -> str:
        """What it does, its bounds and its default."""
        schema = self.schema
        lines = [f"{schema.help}."]
        if schema.low is not None:
            lines.append(f"{schema.low:g} to {schema.high:g} {schema.unit}")
        lines.append(f"Default: {self.worded(self.default)}")
        return "\n".join(lines)

    def worded(self, value: Any) -> str:
        """Say a value in words."""
        schema = self.schema
        if schema.choices:
            return schema.names[schema.choices.index(value)]
        if schema.low is None:
            return "on" if value else "off"
        return f"{value:g} {schema.unit}"

    def show(self, value: Any) -> None:
        """Show another value."""
        with QSignalBlocker(self.widget):
            match self.widget:
                case QComboBox():
                    self.widget.setCurrentIndex(self.schema.choices.index(value))
                case DecimalField():
                    self.widget.setValue(value)
                case QCheckBox():
                    self.widget.setChecked(value)

    def _choices(self, changed: Changed) -> QComboBox:
        box = quiet_box()
        box.addItems(self.schema.names)
        box.activated.connect(lambda at: changed(self.schema.choices[at]))
        return box

    def _number(self, low: float, high: float, changed: Changed) -> DecimalField:
        fine = self.schema.unit == "s"
        field = DecimalField(low, high, 0.05 if fine else 1.0, 2 if fine else 0, self.schema.unit)
        if low == 0 and self.default == 0:
            field.setSpecialValueText("none")
            field.setSingleStep(0.25)
        field.valueChanged.connect(changed)
        return field

    def _switch(self, changed: Changed) -> QCheckBox:
        box = QCheckBox(self.schema.label)
        box.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        box.toggled.connect(changed)
        return box


def quiet_box() -> QComboBox:
    """Make a box of choices that leaves keys and wheel to the desk."""
    box = QComboBox()
    box.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    box.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
    return box
