"""Marker takes solved to the skeleton of a template, for the commands that need joints."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mocapstudio.motion.errors import FileError, MocapError

if TYPE_CHECKING:
    from mocapstudio.cli.take_options import TakeOptions
    from mocapstudio.motion.markers import MarkerTake
    from mocapstudio.motion.solving.model import Solved
    from mocapstudio.motion.take import Take

TemplateOption = Annotated[
    Path | None,
    typer.Option(
        "--template",
        metavar="TAKE",
        help="A take of joints, of the same or a similar performer: markers are solved to its"
        " skeleton first.",
    ),
]


def read_template(path: Path, reading: TakeOptions) -> Take:
    """Read the take whose skeleton markers are solved to.

    Its own rate does not matter, so a file that states none needs no --fps.

    Raises
    ------
    FileError
        If it cannot be read, or holds markers only.
    """
    from dataclasses import replace
    from fractions import Fraction

    from mocapstudio import formats

    options = replace(formats.ReadOptions(), fps=reading.fps or Fraction(120), skeleton=reading.asf)
    return formats.read(path, options)[0][0]


def solved(path: Path, markers: MarkerTake, template: Take) -> Solved:
    """Solve one performer's markers, with progress on standard error.

    Raises
    ------
    FileError
        If the markers cannot be solved, with `path` named.
    """
    from mocapstudio.cli import progress
    from mocapstudio.motion.solving import solving

    try:
        return progress.run(solving(markers, template), f"solving {markers.name}")
    except FileError:
        raise
    except MocapError as error:
        raise FileError(path, str(error)) from error
