"""The one schema of detection parameters: engine, form, command line and session read it."""

from __future__ import annotations

from dataclasses import dataclass

from mocapstudio.motion.errors import ParameterError
from mocapstudio.motion.parameters import Schema, bounded, check, choice, schemas
from mocapstudio.similarity.choices import AUTOMATIC, SEARCHES

CALIBRATED = "calibrated"
PAPER = "paper"
MODES = (CALIBRATED, PAPER)


@dataclass(frozen=True)
class DetectionParameters:
    """What the analysis of a take depends on; defaults are the paper's, where it states them.

    Raises
    ------
    ParameterError
        If a value lies outside its bounds.
    """

    mode: str = choice(
        CALIBRATED,
        "Map",
        {mode: mode for mode in MODES},
        "calibrated: against what is normal for the joint in this context;"
        " paper: the published map, scaled by each row's own mean",
    )
    threshold: float = bounded(
        0.5, "Threshold", "", 0.05, 0.95, "Map value above which a joint is flagged"
    )
    neighbours: int = bounded(5, "Neighbours", "", 1, 15, "How many neighbours a word has (K)")
    source_word: int = bounded(
        15, "Source word", "frames at 24 fps", 5, 60, "Length of the words that are looked up"
    )
    hop: int = bounded(5, "Hop", "frames at 24 fps", 1, 30, "Distance between source words")
    target_word: int = bounded(
        20, "Target word", "frames at 24 fps", 5, 80, "Length of the words that are searched"
    )
    search: str = choice(
        AUTOMATIC,
        "Neighbour search",
        {search: search for search in SEARCHES},
        "exact: every word of the context; indexed: candidates of an index first;"
        " automatic: indexed where the context is large",
    )

    def __post_init__(self) -> None:
        check(self)
        if self.target_word < self.source_word:
            raise ParameterError("target_word must not be shorter than source_word")


def schema(name: str) -> Schema:
    """Return the schema of one detection parameter; KeyError where there is none."""
    return schemas(DetectionParameters)[name]
