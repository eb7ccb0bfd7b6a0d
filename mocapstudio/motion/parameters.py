"""What is known of a parameter, in one place for engine, form, command line and file."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any

from mocapstudio.motion.errors import ParameterError


@dataclass(frozen=True)
class Schema:
    """What is known of one parameter.

    Parameters
    ----------
    label
        Short name for people.
    unit
        Unit as shown, or "".
    low, high
        Inclusive bounds of a number, or None.
    help
        One sentence.
    choices
        Allowed values of a text.
    names
        What the choices are called for people; the values themselves where empty.
    """

    label: str
    unit: str
    low: float | None
    high: float | None
    help: str
    choices: tuple[str, ...] = ()
    names: tuple[str, ...] = ()


def bounded(default: Any, label: str, unit: str, low: float, high: float, text: str) -> Any:
    """Return the field of a number within bounds."""
    return field(default=default, metadata={"schema": Schema(label, unit, low, high, text)})


def choice(default: str, label: str, named: dict[str, str], text: str) -> Any:
    """Return the field of one of some texts, given with what they are called."""
    schema = Schema(label, "", None, None, text, tuple(named), tuple(named.values()))
    return field(default=default, metadata={"schema": schema})


def switch(default: bool, label: str, text: str) -> Any:
    """Return the field of a yes or no."""
    return field(default=default, metadata={"schema": Schema(label, "", None, None, text)})


def schemas(parameters: Any) -> dict[str, Schema]:
    """Schemas of a dataclass of parameters, or of an instance, by field."""
    return {one.name: one.metadata["schema"] for one in fields(parameters)}


def check(parameters: Any) -> None:
    """Check the values of an instance against their schemas.

    Raises
    ------
    ParameterError
        If a value is none of the choices, or lies outside its bounds.
    """
    for name, schema in schemas(parameters).items():
        value = getattr(parameters, name)
        if schema.choices and value not in schema.choices:
            raise ParameterError(f"{name} must be one of {', '.join(schema.choices)}")
        low, high = schema.low, schema.high
        if low is not None and high is not None and not low <= value <= high:
            raise ParameterError(f"{name} must lie in {low:g}..{high:g}, not {value:g}")
