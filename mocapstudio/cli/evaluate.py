"""`mocapstudio evaluate`: the benchmark in the box."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mocapstudio.cli.output import JsonPath, check_writable, write_json
from mocapstudio.motion.errors import MocapError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mocapstudio.evaluation.cases import ContextSize
    from mocapstudio.evaluation.reports import Report


_WIDTH = 160
"""Of tables that go to a file or another program."""


class What(StrEnum):
    """What is measured."""

    DETECTION = "detection"
    REPAIR = "repair"
    CONTACTS = "contacts"
    ALIGNMENT = "alignment"
    SPEED = "speed"


class Size(StrEnum):
    """How large the context is."""

    LOCAL = "local"
    SMALL = "small"
    LARGE = "large"


def evaluate(
    what: Annotated[What, typer.Argument(help="What to measure.")],
    data: Annotated[
        list[Path], typer.Option("--data", metavar="PATH", help="Takes or folders; repeatable.")
    ],
    truth: Annotated[
        Path | None,
        typer.Option(
            "--truth",
            metavar="FILE",
            help="Score against labels made by hand (JSON); of contacts also a folder of them.",
        ),
    ] = None,
    cleaned: Annotated[
        Path | None,
        typer.Option("--cleaned", metavar="TAKE", help="Score against a version cleaned by hand."),
    ] = None,
    labels: Annotated[
        list[Path] | None,
        typer.Option(
            "--labels", metavar="FILE", help="Of alignment: segments of takes (JSON); repeatable."
        ),
    ] = None,
    context: Annotated[
        list[Size] | None,
        typer.Option("--context", help="Size of context; repeatable. All three by default."),
    ] = None,
    seed: Annotated[int, typer.Option(help="Of split, choice of takes and errors.", min=0)] = 0,
    limit: Annotated[int, typer.Option(help="Cases a row.", min=1)] = 12,
    brief: Annotated[bool, typer.Option("--brief", help="Only the main tables.")] = False,
    json_path: JsonPath = None,
    html_path: Annotated[
        Path | None, typer.Option("--html", metavar="PATH", help="Write a page with pictures.")
    ] = None,
) -> None:
    """Measure detection, repair, contacts, alignment or speed on your own takes.

    Errors of known place and shape are injected into the takes, which should be clean; what was
    tuned, was tuned on other takes than those measured.
    """
    from mocapstudio.cli.progress import run
    from mocapstudio.evaluation import reports

    check_writable(json_path)
    check_writable(html_path)
    _check_use(what, truth, cleaned, labels)
    sizes = _sizes(context)
    if what is What.ALIGNMENT:
        from mocapstudio.evaluation import alignment_report

        work = alignment_report.alignment(data, labels or (), seed, limit, brief=brief)
    elif what is What.CONTACTS:
        from mocapstudio.evaluation import contacts_report

        work = contacts_report.contacts(data, truth, seed, limit)
    elif truth is not None:
        work = reports.against_labels(data, truth, sizes[-1])
    elif cleaned is not None:
        work = reports.against_cleaned(data, cleaned, sizes[-1], repair=what is What.REPAIR)
    elif what is What.DETECTION:
        work = reports.detection(data, sizes, seed, limit, brief=brief)
    elif what is What.REPAIR:
        work = reports.repair(data, sizes[-1], seed, limit)
    else:
        work = reports.speed(data, seed, long=not brief)
    report = run(work, f"evaluate {what.value}")
    if json_path is None:
        _show(report)
    write_json(_with_provenance(report.record, data, seed), json_path)
    if html_path is not None:
        _write(report.html, html_path)


def _check_use(
    what: What, truth: Path | None, cleaned: Path | None, labels: list[Path] | None
) -> None:
    if truth is not None and cleaned is not None:
        raise MocapError("--truth and --cleaned exclude each other")
    if cleaned is not None and what in {What.SPEED, What.ALIGNMENT}:
        raise MocapError(f"{what.value} has no cleaned take to be scored against")
    if cleaned is not None and what is What.CONTACTS:
        raise MocapError("contacts are measured against --truth")
    if truth is not None and what not in {What.DETECTION, What.CONTACTS}:
        raise MocapError("labels tell where errors are, not what would be right: use --cleaned")
    if labels and what is not What.ALIGNMENT:
        raise MocapError("--labels are of segments, which only alignment is measured by")


def _sizes(context: list[Size] | None) -> Sequence[ContextSize]:
    chosen = context or list(Size)
    return [size.value for size in Size if size in chosen]


def _with_provenance(record: dict[str, Any], data: list[Path], seed: int) -> dict[str, Any]:
    from datetime import UTC, datetime

    from mocapstudio import __version__

    head = {
        "version": __version__,
        "time": datetime.now(UTC).isoformat(timespec="seconds"),
        "data": [str(path) for path in data],
        "seed": seed,
    }
    return head | record


def _show(report: Report) -> None:
    from rich.console import Console
    from rich.table import Table

    console = Console()
    if not console.is_terminal:
        console = Console(width=_WIDTH)
    for table in report.tables:
        shown = Table(
            title=table.title,
            title_justify="left",
            caption=table.note or None,
            caption_justify="left",
            box=None,
            pad_edge=False,
        )
        for i, title in enumerate(table.head):
            shown.add_column(title, justify="left" if i == 0 else "right")
        for row in table.rows:
            shown.add_row(*row)
        console.print(shown)
        console.print()


def _write(text: str, path: Path) -> None:
    from mocapstudio.formats.atomic import write_whole

    write_whole(path, [text.encode()])
