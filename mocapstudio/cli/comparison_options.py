"""The options of a comparison, and the parameters they make."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from mocapstudio.motion.errors import ParameterError

if TYPE_CHECKING:
    from mocapstudio.comparison.parameters import ComparisonParameters

Features = Literal["box", "root", "rotations"]
Side = Literal["reference", "source"]

_PANEL = "How performances are compared"

TrueSpeed = Annotated[
    bool,
    typer.Option(
        "--true-speed",
        help="Align and colour at true speed, not at equal lengths.",
        rich_help_panel=_PANEL,
    ),
]
FeaturesOption = Annotated[
    Features,
    typer.Option(
        "--features",
        help="What a pose is: positions about neck and head in the unit box, positions about"
        " the hips, or rotations of joints.",
        rich_help_panel=_PANEL,
    ),
]
Rate = Annotated[
    float,
    typer.Option(
        "--rate",
        metavar="HZ",
        help="Frames a second at least, at which poses are aligned.",
        rich_help_panel=_PANEL,
    ),
]
Tolerance = Annotated[
    float,
    typer.Option(
        "--tolerance",
        metavar="SECONDS",
        help="What may be gained or lost within the window and still be on time.",
        rich_help_panel=_PANEL,
    ),
]
Window = Annotated[
    float,
    typer.Option(
        "--window",
        metavar="SECONDS",
        help="Over which gain and loss are looked at.",
        rich_help_panel=_PANEL,
    ),
]
OpenBegin = Annotated[
    Side | None,
    typer.Option(
        "--open-begin",
        help="Whose frames may be left out at the beginning.",
        rich_help_panel=_PANEL,
    ),
]
OpenEnd = Annotated[
    Side | None,
    typer.Option(
        "--open-end", help="Whose frames may be left out at the end.", rich_help_panel=_PANEL
    ),
]
Subsequence = Annotated[
    Side | None,
    typer.Option(
        "--subsequence",
        help="Whose frames may be left out at both ends: the other is looked for in it.",
        rich_help_panel=_PANEL,
    ),
]
Band = Annotated[
    float,
    typer.Option(
        "--band",
        metavar="SECONDS",
        help="How far the path may be off the straight line from end to end; 0 for any.",
        rich_help_panel=_PANEL,
    ),
]
Mask = Annotated[
    Path | None,
    typer.Option(
        "--mask",
        metavar="FILE",
        help="Leave out what detect --json flagged in takes of these names.",
        rich_help_panel=_PANEL,
    ),
]


@dataclass(frozen=True)
class ComparisonOptions:
    """How performances are compared; every field is an option of the command line."""

    true_speed: TrueSpeed = False
    features: FeaturesOption = "box"
    rate: Rate = 25.0
    tolerance: Tolerance = 0.1
    window: Window = 0.5
    open_begin: OpenBegin = None
    open_end: OpenEnd = None
    subsequence: Subsequence = None
    band: Band = 0.0
    mask: Mask = None

    def parameters(self) -> ComparisonParameters:
        """Return the parameters of the comparison.

        Raises
        ------
        ParameterError
            If a value lies outside its bounds, or options contradict each other.
        """
        from mocapstudio.comparison.parameters import CLOSED, ComparisonParameters

        if self.subsequence and (self.open_begin or self.open_end):
            raise ParameterError("--subsequence opens both ends: without --open-begin, --open-end")
        ends: dict[str, Any] = {
            "begin": self.subsequence or self.open_begin or CLOSED,
            "end": self.subsequence or self.open_end or CLOSED,
        }
        return ComparisonParameters(
            features=self.features,
            true_speed=self.true_speed,
            rate=self.rate,
            tolerance=self.tolerance,
            window=self.window,
            band=self.band,
            masked=self.mask is not None,
            **ends,
        )
