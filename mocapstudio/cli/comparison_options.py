"""The options of commands that set performances beside a reference."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

AlignedReference = Annotated[
    Path, typer.Argument(metavar="REFERENCE", help="What is aligned with.")
]
ReferenceLabels = Annotated[
    Path | None,
    typer.Option("--labels", metavar="FILE", help="Segments of the reference (JSON)."),
]
