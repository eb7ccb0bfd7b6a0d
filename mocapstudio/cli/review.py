"""`mocapstudio review`: the desk."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mocapstudio.cli.take_options import Context, TakeOptions, with_take_options
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.joint_map import read_joint_map


@with_take_options
def review(
    paths: Annotated[
        list[Path] | None,
        typer.Argument(metavar="[SESSION or TAKE...]", help="A session, takes, or folders."),
    ] = None,
    context: Context = None,
    partner: Annotated[
        list[Path] | None,
        typer.Option(
            "--partner",
            metavar="TAKE",
            help="Another performer in the same scene; may be repeated.",
        ),
    ] = None,
    *,
    reading: TakeOptions,
) -> None:
    """Open the desk on a session or on takes."""
    for path in (*(paths or ()), *(context or ()), *(partner or ())):
        if not path.exists():
            raise FileError(path, "no such file or folder")
    from mocapstudio.gui.application import run

    renamed = read_joint_map(reading.joint_map) if reading.joint_map is not None else None
    raise typer.Exit(run(paths or (), context or (), partner or (), reading.reading(), renamed))
