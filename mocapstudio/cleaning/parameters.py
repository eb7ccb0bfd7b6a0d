"""The one schema of detection parameters: engine, form, command line and session read it."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any

from mocapstudio.motion.errors import ParameterError
from mocapstudio.similarity.choices import AUTOMATIC, SEARCHES

CALIBRATED = "calibrated"
PAPER = "paper"
MODES = (CALIBRATED, PAPER)


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
    """

    label: str
    unit: str
    low: float | None
    high: float | None
    help: str
    choices: tuple[str, ...] = ()


def _parameter(default: Any, label: str, unit: str, low: float, high: float, text: str) -> Any:
    return field(default=default, metadata={"schema": Schema(label, unit, low, high, text)})


@dataclass(frozen=True)
class DetectionParameters:
    """What the analysis of a take depends on; defaults are the paper's, where it states them.

    Raises
    ------
    ParameterError
        If a value lies outside its bounds.
    """

    mode: str = field(
        default=CALIBRATED,
        metadata={
            "schema": Schema(
                "Map",
                "",
                None,
                None,
                "calibrated: against what is normal for the joint in this context;"
                " paper: the published map, scaled by each row's own mean",
                MODES,
            )
        },
    )
    threshold: float = _parameter(
        0.5, "Threshold", "", 0.05, 0.95, "Map value above which a joint is flagged"
    )
    neighbours: int = _parameter(5, "Neighbours", "", 1, 15, "How many neighbours a word has (K)")
    source_word: int = _parameter(
        15, "Source word", "frames at 24 fps", 5, 60, "Length of the words that are looked up"
    )
    hop: int = _parameter(5, "Hop", "frames at 24 fps", 1, 30, "Distance between source words")
    target_word: int = _parameter(
        20, "Target word", "frames at 24 fps", 5, 80, "Length of the words that are searched"
    )
    search: str = field(
        default=AUTOMATIC,
        metadata={
            "schema": Schema(
                "Neighbour search",
                "",
                None,
                None,
                "exact: every word of the context; indexed: candidates of an index first;"
                " automatic: indexed where the context is large",
                SEARCHES,
            )
        },
    )

    def __post_init__(self) -> None:
        for one in fields(self):
            schema, value = one.metadata["schema"], getattr(self, one.name)
            if schema.choices and value not in schema.choices:
                raise ParameterError(f"{one.name} must be one of {', '.join(schema.choices)}")
            if schema.low is not None and not schema.low <= value <= schema.high:
                raise ParameterError(
                    f"{one.name} must lie in {schema.low}..{schema.high}, not {value}"
                )
        if self.target_word < self.source_word:
            raise ParameterError("target_word must not be shorter than source_word")


def schema(name: str) -> Schema:
    """Return the schema of one detection parameter; KeyError where there is none."""
    found: dict[str, Schema] = {
        one.name: one.metadata["schema"] for one in fields(DetectionParameters)
    }
    return found[name]
