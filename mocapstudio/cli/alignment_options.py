"""The options that commands of the online alignment share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

Reference = Annotated[Path, typer.Argument(metavar="REFERENCE", help="What is aligned with.")]
ReferenceLabels = Annotated[
    Path | None,
    typer.Option("--labels", metavar="FILE", help="Segments of the reference (JSON)."),
]
TakeLabels = Annotated[
    list[Path],
    typer.Option(
        "--labels", metavar="FILE", help="Segments of takes and reference (JSON); repeatable."
    ),
]
