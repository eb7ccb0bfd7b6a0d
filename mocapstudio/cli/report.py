"""`mocapstudio report`: what was found and decided in a session, as one HTML file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mocapstudio.cli.export import SessionPath, opened
from mocapstudio.cli.output import check_writable


def report(
    session: SessionPath,
    out: Annotated[Path, typer.Option("-o", "--out", metavar="OUT", help="HTML file to write.")],
) -> None:
    """Write the report of a session: what was found, what was decided, what was changed."""
    check_writable(out)
    from mocapstudio.review.report import write_report

    write_report(opened(session), out)
