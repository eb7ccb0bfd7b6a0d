"""The options of commands that run the detection, and the run itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from mocapstudio.cli import progress
from mocapstudio.motion.recording import without_itself
from mocapstudio.motion.take import Take

if TYPE_CHECKING:
    from mocapstudio.cleaning.analysis import Analysis
    from mocapstudio.cleaning.parameters import DetectionParameters

Mode = Literal["calibrated", "paper"]

Threshold = Annotated[
    float | None,
    typer.Option("--threshold", metavar="X", help="What the map must exceed to be flagged, 0..1."),
]
ModeOption = Annotated[
    Mode | None,
    typer.Option("--mode", help="How residuals are scaled: learnt from the context, or literally."),
]

Quick = Annotated[
    bool,
    typer.Option(
        "--quick",
        help="Do not learn from the context: a rougher map, at once. What was learnt is kept, so"
        " that only the first run on a context takes its time.",
    ),
]


def parameters(threshold: float | None, mode: Mode | None) -> DetectionParameters:
    """Return the parameters of detection, defaults where nothing is asked.

    Raises
    ------
    ParameterError
        If a value lies outside its bounds.
    """
    from mocapstudio.cleaning.parameters import DetectionParameters

    chosen = DetectionParameters()
    if threshold is not None:
        chosen = replace(chosen, threshold=threshold)
    if mode is not None:
        chosen = replace(chosen, mode=mode)
    return chosen


def analyse(
    take: Take, context: Sequence[Take], chosen: DetectionParameters, *, quick: bool = False
) -> Analysis:
    """Run the detection on a take with a bar on the terminal."""
    from mocapstudio.cleaning.detection import detect
    from mocapstudio.cleaning.refined import detect_refined

    others = without_itself(context, take)
    if quick:
        return progress.run(detect(take, others, chosen), take.name)
    return progress.run(detect_refined(take, others, chosen, known=context), take.name)
