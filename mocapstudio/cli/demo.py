"""`mocapstudio demo`: the main job on the built-in take."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

OutFolder = Annotated[
    Path | None,
    typer.Option("-o", "--out", metavar="DIR", help="Do the job without the desk, into a folder."),
]
Headless = Annotated[
    bool, typer.Option("--headless", help="Do without the desk even where there is a display.")
]

DEFAULT_FOLDER = Path("mocapstudio-demo")


def demo(out: OutFolder = None, headless: Headless = False) -> None:
    """Do the main job on the built-in take: two minutes with fourteen known errors.

    With a display, the desk opens on it, analysed. Without one, or with --out, everything that is
    found is repaired; the takes before and after, a report and pictures are written to a folder
    (mocapstudio-demo by default).
    """
    from mocapstudio.cli.checks.display import has_display
    from mocapstudio.evaluation.demo import write_demo

    if out is None and not headless and has_display():
        import platformdirs

        from mocapstudio.gui.application import run

        files = write_demo(platformdirs.user_data_path("mocapstudio") / "demo")
        raise typer.Exit(run([files.take], context=files.context))

    from mocapstudio.cli.demo_job import do_job

    for line in do_job(out or DEFAULT_FOLDER):
        print(line)
