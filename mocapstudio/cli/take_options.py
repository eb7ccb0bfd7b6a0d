"""The options of every command that reads takes, and what they mean."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

if TYPE_CHECKING:
    from mocapstudio.formats import ReadOptions

Up = Literal["x", "y", "z"]


def _rate(text: str) -> Fraction:
    from mocapstudio.formats.options import parse_rate

    return parse_rate(text)


def _unit(text: str) -> float:
    from mocapstudio.formats.options import parse_unit

    return parse_unit(text)


Fps = Annotated[
    Fraction | None,
    typer.Option(
        "--fps", parser=_rate, metavar="RATE", help="Frame rate, in place of what the file says."
    ),
]
Unit = Annotated[
    float | None,
    typer.Option(
        "--unit",
        parser=_unit,
        metavar="UNIT",
        help="Unit of length: m, cm, mm, in, asf, or what it is in metres.",
    ),
]
UpAxis = Annotated[Up | None, typer.Option("--up", help="The axis of the file that points up.")]
JointMap = Annotated[
    Path | None,
    typer.Option(
        "--joint-map",
        metavar="FILE",
        help="JSON object: names of joints in the context and what they are called in the take.",
    ),
]
Context = Annotated[
    list[Path] | None,
    typer.Option(
        "--context",
        metavar="PATH",
        help="A take, or a folder of takes, to search for neighbours; may be repeated.",
    ),
]


@dataclass(frozen=True)
class TakeOptions:
    """How takes are read, as the user wants it."""

    fps: Fraction | None = None
    unit: float | None = None
    up: Up | None = None
    joint_map: Path | None = None

    def reading(self) -> ReadOptions:
        """Return what the readers are told."""
        from mocapstudio.formats import ReadOptions

        return ReadOptions(fps=self.fps, unit=self.unit, up=self.up)
