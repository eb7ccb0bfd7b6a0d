"""What a comparison of two performances depends on: engine, form, file and command line read it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from mocapstudio.motion.errors import ParameterError
from mocapstudio.motion.parameters import bounded, check, choice, switch

BOX = "box"
ROOT = "root"
ROTATIONS = "rotations"

CLOSED = "closed"
REFERENCE = "reference"
SOURCE = "source"

Side = Literal["reference", "source"]

TIMING_ONLY = frozenset({"tolerance", "window"})
"""Parameters that only classify a misalignment which is known."""

_SKIPPED = {
    CLOSED: "together",
    REFERENCE: "skip reference",
    SOURCE: "skip source",
}


@dataclass(frozen=True)
class ComparisonParameters:
    """How two performances are compared; `PAPER` is paper 4 to the letter.

    Raises
    ------
    ParameterError
        If a value is not one of the choices or outside its bounds, or a band has open ends.
    """

    features: str = choice(
        BOX,
        "Poses",
        {BOX: "unit box", ROOT: "root frame", ROTATIONS: "rotations"},
        "What a pose is: positions in the frame of neck and head, scaled into the unit box (the"
        " paper's); positions in the frame of hips and heading, scaled likewise; or rotations of"
        " the joints",
    )
    true_speed: bool = switch(
        False, "True speed", "Compare at true speed instead of stretched to equal lengths"
    )
    rate: float = bounded(
        25.0, "Rate", "Hz", 5, 240, "Frames a second at least, at which poses are aligned"
    )
    tolerance: float = bounded(
        0.1, "Tolerance", "s", 0, 10, "Seconds gained or lost within the window that are on time"
    )
    window: float = bounded(
        0.5, "Window", "s", 0.02, 10, "Seconds over which gain and loss are looked at"
    )
    begin: str = choice(
        CLOSED,
        "Beginning",
        _SKIPPED,
        "Whether the performances begin together, or frames of one may be left out",
    )
    end: str = choice(
        CLOSED,
        "End",
        _SKIPPED,
        "Whether the performances end together, or frames of one may be left out",
    )
    band: float = bounded(
        0.0,
        "Band",
        "s",
        0,
        600,
        "Seconds of the source that the path may be off the straight line from the first pair of"
        " frames to the last; 0 for any",
    )
    masked: bool = switch(
        False,
        "Leave flagged out",
        "Leave joints out where they are flagged, so that a bad capture is not read as a bad"
        " performance",
    )
    ignore_style: bool = switch(
        True,
        "Ignore style",
        "Leave differences of pose that last out of the alignment; the paper does not",
    )
    rounded: bool = switch(False, "Whole frames", "Match whole frames only, as the paper does")

    def __post_init__(self) -> None:
        check(self)
        if self.band > 0 and self.open:
            raise ParameterError("a band goes from end to end: begin and end must be closed")

    @property
    def open(self) -> bool:
        """Whether frames of one performance may be left out at an end."""
        return (self.begin, self.end) != (CLOSED, CLOSED)

    @property
    def open_begin(self) -> Side | None:
        """The side of which frames may be left out at the beginning, if any."""
        return _side(self.begin)

    @property
    def open_end(self) -> Side | None:
        """The side of which frames may be left out at the end, if any."""
        return _side(self.end)


def _side(choice: str) -> Side | None:
    return "reference" if choice == REFERENCE else "source" if choice == SOURCE else None


PAPER = ComparisonParameters(ignore_style=False, rounded=True)
