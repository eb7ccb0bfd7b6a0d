"""`mocapstudio review`: the desk."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mocapstudio.cli.take_options import Context, Fps, JointMap, TakeOptions, Unit, UpAxis
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.joint_map import read_joint_map


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
    fps: Fps = None,
    unit: Unit = None,
    up: UpAxis = None,
    joint_map: JointMap = None,
) -> None:
    """Open the desk on a session or on takes."""
    for path in (*(paths or ()), *(context or ()), *(partner or ())):
        if not path.exists():
            raise FileError(path, "no such file or folder")
    from mocapstudio.gui.application import run

    renamed = read_joint_map(joint_map) if joint_map is not None else None
    options = TakeOptions(fps, unit, up).reading()
    raise typer.Exit(run(paths or (), context or (), partner or (), options, renamed))
