"""What a comparison of two performances depends on: engine, form and command line read it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from mocapstudio.motion.errors import ParameterError

BOX = "box"
ROOT = "root"
ROTATIONS = "rotations"
FEATURES = (BOX, ROOT, ROTATIONS)

CLOSED = "closed"
REFERENCE = "reference"
SOURCE = "source"
ENDS = (CLOSED, REFERENCE, SOURCE)

Side = Literal["reference", "source"]


@dataclass(frozen=True)
class ComparisonParameters:
    """How two performances are compared; `PAPER` is paper 4 to the letter.

    Parameters
    ----------
    features
        What a pose is: ``"box"``: positions in the frame of neck and head, scaled into the unit
        box (the paper's); ``"root"``: positions in the frame of hips and heading, scaled likewise;
        ``"rotations"``: rotations of the joints.
    true_speed
        Compare at true speed instead of stretched to equal lengths.
    rate
        Frames a second at least, at which poses are aligned.
    tolerance
        Seconds gained or lost within `window` that still count as on time.
    window
        Seconds over which gain and loss are looked at.
    begin, end
        ``"closed"``, or the side of which frames may be skipped at that end.
    ignore_style
        Leave differences of pose that last out of the alignment; the paper does not.
    rounded
        Round F to whole frames, as the paper does.

    Raises
    ------
    ParameterError
        If a value is not one of those, or outside its bounds.
    """

    features: str = BOX
    true_speed: bool = False
    rate: float = 25.0
    tolerance: float = 0.1
    window: float = 0.5
    begin: str = CLOSED
    end: str = CLOSED
    ignore_style: bool = True
    rounded: bool = False

    def __post_init__(self) -> None:
        if self.features not in FEATURES:
            raise ParameterError(f"features must be one of {', '.join(FEATURES)}")
        for name in ("begin", "end"):
            if getattr(self, name) not in ENDS:
                raise ParameterError(f"{name} must be one of {', '.join(ENDS)}")
        for name, low, high in (("rate", 5, 240), ("tolerance", 0, 10), ("window", 0.02, 10)):
            if not low <= getattr(self, name) <= high:
                raise ParameterError(f"{name} must lie in {low}..{high}")

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
