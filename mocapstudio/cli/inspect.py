"""`mocapstudio inspect`: what is in files, what was wrong with them, what was done about it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mocapstudio.cli.output import JsonPath, check_writable, write_json
from mocapstudio.cli.take_options import OPTION_OF, TakeOptions, with_take_options

if TYPE_CHECKING:
    from mocapstudio.formats import ImportReport, Problem, Recording


@with_take_options
def inspect(
    files: Annotated[list[Path], typer.Argument(metavar="FILE...", help="Files or folders.")],
    json_path: JsonPath = None,
    *,
    reading: TakeOptions,
) -> None:
    """Read files and report what is in them, what was odd, and what was done about it.

    What a file leaves open is guessed, and said to be a guess, with the option that decides
    otherwise.
    """
    from mocapstudio.cli.take_files import Workload
    from mocapstudio.formats import read_any
    from mocapstudio.motion.joint_map import read_joint_map, rename_recording

    check_writable(json_path)
    work = Workload(reading)
    names = read_joint_map(reading.joint_map) if reading.joint_map else {}
    found: list[dict[str, Any]] = []
    for path in work.files(files):
        with work.going_on():
            takes, report = read_any(path, reading.reading())
            takes = [rename_recording(take, names) for take in takes]
            found.append(as_json(takes, report))
            if json_path is None:
                _show(takes, report)
    write_json({"files": found}, json_path)
    raise typer.Exit(work.finish())


def as_json(takes: Sequence[Recording], report: ImportReport) -> dict[str, Any]:
    """Return what the JSON says of one file; a file of several performers lists them apart."""
    first = takes[0]
    result: dict[str, Any] = {
        "path": str(report.path),
        "format": report.format,
        "frames": first.frames,
        "fps": float(first.rate),
        **_names(first),
        "unit": first.source.unit if first.source else None,
        "first_frame": first.first_frame,
        "timecode": first.timecode,
        "trim": list(first.trim) if first.trim else None,
        "problems": [_problem(problem) for problem in report.problems],
    }
    if len(takes) > 1:
        result["performers"] = [
            {"name": take.name, "frames": take.frames, **_names(take)} for take in takes
        ]
    return result


def _names(take: Recording) -> dict[str, Any]:
    from mocapstudio.motion.take import Take

    if isinstance(take, Take):
        return {"joints": list(take.skeleton.names), "markers": []}
    missing = take.missing.sum(axis=0)
    return {
        "joints": [],
        "markers": list(take.labels),
        "missing": dict(zip(take.labels, map(int, missing), strict=True)),
        "events": [{"name": event.name, "time": event.time} for event in take.events],
    }


def _problem(problem: Problem) -> dict[str, Any]:
    return {
        "line": problem.line,
        "what": problem.what,
        "done": problem.done,
        "option": OPTION_OF.get(problem.override or ""),
    }


def _show(takes: Sequence[Recording], report: ImportReport) -> None:
    from rich.console import Console
    from rich.padding import Padding
    from rich.table import Table

    console = Console(highlight=False)
    console.print(str(report.path), style="bold", markup=False)
    for take in takes:
        console.print(f"  {_summary(take)}", markup=False)
    if not report.problems:
        return
    table = Table("Line", "Found", "Done", "Override", box=None, pad_edge=False, padding=(0, 2))
    for problem in report.problems:
        line = "-" if problem.line is None else str(problem.line)
        flag = OPTION_OF.get(problem.override or "", "")
        style = "dim" if problem.guess else None
        table.add_row(line, problem.what, problem.done, flag, style=style)
    console.print(Padding(table, (0, 0, 1, 2)))


def _summary(take: Recording) -> str:
    from mocapstudio.motion.take import Take

    rate = f"{float(take.rate):.6g}"
    unit = take.source.unit if take.source else 1.0
    markers = None if isinstance(take, Take) else take
    what = (
        f"{len(take.skeleton)} joints" if isinstance(take, Take) else f"{len(take.labels)} markers"
    )
    parts = [
        f"{take.name}: {what}",
        f"{take.frames} frames at {rate} fps ({take.duration:.2f} s)",
        f"1 unit = {unit:.4g} m",
    ]
    if markers is not None and markers.missing.any():
        parts.append(f"{markers.missing.mean():.1%} missing")
    if take.trim:
        parts.append(f"analysed {take.trim[0]}:{take.trim[1]}")
    return ", ".join(parts)
