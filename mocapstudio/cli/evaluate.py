"""`mocapstudio evaluate`: the benchmark in the box."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mocapstudio.cli.output import JsonPath, check_writable, write_json
from mocapstudio.motion.errors import FileError, MocapError

if TYPE_CHECKING:
    from collections.abc import Generator, Sequence

    from mocapstudio.evaluation.cases import ContextSize
    from mocapstudio.evaluation.reports import Report
    from mocapstudio.motion.progress import Progress


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


DataPaths = Annotated[
    list[Path], typer.Option("--data", metavar="PATH", help="Takes or folders; repeatable.")
]
Truth = Annotated[
    Path | None,
    typer.Option(
        "--truth",
        metavar="FILE",
        help="Score against labels made by hand (JSON); of contacts also a folder of them.",
    ),
]
Cleaned = Annotated[
    Path | None,
    typer.Option("--cleaned", metavar="TAKE", help="Score against a version cleaned by hand."),
]
Labels = Annotated[
    list[Path] | None,
    typer.Option(
        "--labels",
        metavar="PATH",
        help="Of alignment: segments of takes, a JSON file or a folder of them; repeatable.",
    ),
]
Events = Annotated[
    list[Path] | None,
    typer.Option(
        "--events",
        metavar="PATH",
        help="Of alignment: segments of the same movement by different performers, of which"
        " every two are compared, a JSON file or a folder of them; repeatable.",
    ),
]
Sizes = Annotated[
    list[Size] | None,
    typer.Option("--context", help="Size of context; repeatable. All three by default."),
]
Page = Annotated[
    Path | None, typer.Option("--html", metavar="PATH", help="Write a page with pictures.")
]


def evaluate(
    what: Annotated[What, typer.Argument(help="What to measure.")],
    data: DataPaths,
    truth: Truth = None,
    cleaned: Cleaned = None,
    labels: Labels = None,
    events: Events = None,
    context: Sizes = None,
    seed: Annotated[int, typer.Option(help="Of split, choice of takes and errors.", min=0)] = 0,
    limit: Annotated[int, typer.Option(help="Cases a row.", min=1)] = 12,
    brief: Annotated[bool, typer.Option("--brief", help="Only the main tables.")] = False,
    json_path: JsonPath = None,
    html_path: Page = None,
) -> None:
    """Measure detection, repair, contacts, alignment or speed on your own takes.

    Errors of known place and shape are injected into the takes, which should be clean; what was
    tuned, was tuned on other takes than those measured.
    """
    from mocapstudio.cli.progress import run

    check_writable(json_path)
    check_writable(html_path)
    asked = _Asked(
        what,
        data,
        truth,
        cleaned,
        label_files(labels or []),
        label_files(events or []),
        _sizes(context),
        seed,
        limit,
        brief,
    )
    asked.check()
    report = run(asked.work(), f"evaluate {what.value}")
    if json_path is None:
        _show(report)
    write_json(_with_provenance(report.record, data, seed), json_path)
    if html_path is not None:
        _write(report.html, html_path)


@dataclass(frozen=True)
class _Asked:
    """What is to be measured, on what, against what."""

    what: What
    data: Sequence[Path]
    truth: Path | None
    cleaned: Path | None
    labels: Sequence[Path]
    events: Sequence[Path]
    sizes: Sequence[ContextSize]
    seed: int
    limit: int
    brief: bool

    def check(self) -> None:
        what = self.what
        if self.truth is not None and self.cleaned is not None:
            raise MocapError("--truth and --cleaned exclude each other")
        if self.cleaned is not None and what in {What.SPEED, What.ALIGNMENT}:
            raise MocapError(f"{what.value} has no cleaned take to be scored against")
        if self.cleaned is not None and what is What.CONTACTS:
            raise MocapError("contacts are measured against --truth")
        if self.truth is not None and what not in {What.DETECTION, What.CONTACTS}:
            raise MocapError("labels tell where errors are, not what would be right: use --cleaned")
        if (self.labels or self.events) and what is not What.ALIGNMENT:
            raise MocapError(
                "--labels and --events are of segments, which only alignment is measured by"
            )

    def work(self) -> Generator[Progress, None, Report]:
        if self.what is What.ALIGNMENT:
            from mocapstudio.evaluation import alignment_report

            return alignment_report.alignment(
                self.data,
                self.labels,
                self.seed,
                self.limit,
                events=self.events,
                brief=self.brief,
            )
        if self.what is What.CONTACTS:
            from mocapstudio.evaluation import contacts_report

            return contacts_report.contacts(self.data, self.truth, self.seed, self.limit)
        from mocapstudio.evaluation import reports

        if self.truth is not None:
            return reports.against_labels(self.data, self.truth, self.sizes[-1])
        if self.cleaned is not None:
            repair = self.what is What.REPAIR
            return reports.against_cleaned(self.data, self.cleaned, self.sizes[-1], repair=repair)
        if self.what is What.DETECTION:
            return reports.detection(self.data, self.sizes, self.seed, self.limit, brief=self.brief)
        if self.what is What.REPAIR:
            return reports.repair(self.data, self.sizes[-1], self.seed, self.limit)
        return reports.speed(self.data, self.seed, long=not self.brief)


def label_files(paths: Sequence[Path]) -> list[Path]:
    """Take the JSON files of folders in place of the folders."""
    found: list[Path] = []
    for path in paths:
        inside = sorted(path.glob("*.json")) if path.is_dir() else [path]
        if not inside:
            raise FileError(path, "holds no labels (JSON)")
        found += inside
    return found


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
