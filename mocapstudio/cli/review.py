"""`mocapstudio review`: the desk."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mocapstudio.cli.take_options import Context, TakeOptions, with_take_options
from mocapstudio.motion.errors import FileError, ParameterError
from mocapstudio.motion.joint_map import read_joint_map

STANDARD_INPUT = Path("-")


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
    live: Annotated[
        Path | None,
        typer.Option(
            "--live",
            metavar="STREAM",
            help="Play STREAM beside the one TAKE, the reference, as if it arrived now: a take,"
            ' or - for JSON lines on standard input: {"time", "joints": {name: [x, y, z, w]},'
            ' "root": [x, y, z]}.',
        ),
    ] = None,
    weights: Annotated[
        Path | None,
        typer.Option("--weights", metavar="FILE", help="What train-weights wrote, for --live."),
    ] = None,
    labels: Annotated[
        Path | None,
        typer.Option("--labels", metavar="FILE", help="Segments of the reference, for --live."),
    ] = None,
    *,
    reading: TakeOptions,
) -> None:
    """Open the desk on a session or on takes, or on a live performance."""
    for path in (*(paths or ()), *(context or ()), *(partner or ())):
        if not path.exists():
            raise FileError(path, "no such file or folder")
    if live is not None:
        if len(paths or ()) != 1:
            raise ParameterError("--live wants one TAKE, the reference")
        raise typer.Exit(_live((paths or [])[0], live, weights, labels, reading))
    if weights is not None or labels is not None:
        raise ParameterError("--weights and --labels belong to --live")
    from mocapstudio.gui.application import run

    renamed = read_joint_map(reading.joint_map) if reading.joint_map is not None else None
    raise typer.Exit(run(paths or (), context or (), partner or (), reading.reading(), renamed))


def _live(
    reference: Path,
    stream: Path,
    weights: Path | None,
    labels: Path | None,
    reading: TakeOptions,
) -> int:
    """Check what can be checked without a desk, then open it; returns its exit code."""
    from mocapstudio.comparison.labels import labels_of, read_labels
    from mocapstudio.comparison.weights import read_weights

    if stream != STANDARD_INPUT and not stream.exists():
        raise FileError(stream, "no such file or folder")
    learnt = read_weights(weights) if weights is not None else None
    known = None
    if labels is not None:
        known = labels_of(reference.stem, read_labels(labels))
        if known is None:
            raise FileError(labels, f"has no labels of {reference.stem}")
    renamed = read_joint_map(reading.joint_map) if reading.joint_map is not None else {}
    from mocapstudio.gui.application import run
    from mocapstudio.gui.compare.live_opening import LiveRequest

    request = LiveRequest(
        reference,
        None if stream == STANDARD_INPUT else stream,
        reading.reading(),
        renamed,
        learnt,
        "" if weights is None else weights.name,
        known,
        labels,
    )
    return run(live=request)
