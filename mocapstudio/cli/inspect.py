"""`mocapstudio inspect`: what is in files, what was wrong with them, what was done about it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mocapstudio.cli.output import JsonPath, check_writable, write_json
from mocapstudio.cli.take_options import Fps, JointMap, Unit, UpAxis

if TYPE_CHECKING:
    from mocapstudio.formats import ImportReport, Problem
    from mocapstudio.motion.take import Take

Lenient = Annotated[
    bool,
    typer.Option("--lenient", help="Read the whole rows there are, whatever number is stated."),
]

# Which option of the command decides what a reader guessed.
_OPTIONS = {"fps": "--fps", "unit": "--unit", "up": "--up"}


def inspect(
    files: Annotated[list[Path], typer.Argument(metavar="FILE...", help="Files or folders.")],
    json_path: JsonPath = None,
    fps: Fps = None,
    unit: Unit = None,
    up: UpAxis = None,
    joint_map: JointMap = None,
    lenient: Lenient = False,
) -> None:
    """Read files and report what is in them, what was odd, and what was done about it.

    What a file leaves open is guessed, and said to be a guess: --fps, --unit and --up decide
    otherwise.
    """
    from mocapstudio.cli.take_files import Workload
    from mocapstudio.cli.take_options import TakeOptions
    from mocapstudio.formats import ReadOptions, read
    from mocapstudio.motion.joint_map import read_joint_map, rename_joints

    check_writable(json_path)
    work = Workload(TakeOptions(fps, unit, up, joint_map))
    options = ReadOptions(fps=fps, unit=unit, up=up, lenient=lenient)
    names = read_joint_map(joint_map) if joint_map else {}
    found: list[dict[str, Any]] = []
    for path in work.files(files):
        with work.going_on():
            takes, report = read(path, options)
            takes = [rename_joints(take, names) for take in takes]
            found.append(as_json(takes, report))
            if json_path is None:
                _show(takes, report)
    write_json({"files": found}, json_path)
    raise typer.Exit(work.exit_code)


def as_json(takes: list[Take], report: ImportReport) -> dict[str, Any]:
    """Return what the JSON says of one file; a file of several performers lists them apart."""
    first = takes[0]
    result: dict[str, Any] = {
        "path": str(report.path),
        "format": report.format,
        "frames": first.frames,
        "fps": float(first.rate),
        "joints": list(first.skeleton.names),
        "markers": [],
        "unit": first.source.unit if first.source else None,
        "trim": list(first.trim) if first.trim else None,
        "problems": [_problem(problem) for problem in report.problems],
    }
    if len(takes) > 1:
        result["performers"] = [
            {"name": take.name, "frames": take.frames, "joints": list(take.skeleton.names)}
            for take in takes
        ]
    return result


def _problem(problem: Problem) -> dict[str, Any]:
    return {"line": problem.line, "what": problem.what, "done": problem.done}


def _show(takes: list[Take], report: ImportReport) -> None:
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
        flag = _OPTIONS.get(problem.override or "", "")
        style = "dim" if problem.guess else None
        table.add_row(line, problem.what, problem.done, flag, style=style)
    console.print(Padding(table, (0, 0, 1, 2)))


def _summary(take: Take) -> str:
    rate = f"{float(take.rate):.6g}"
    unit = take.source.unit if take.source else 1.0
    parts = [
        f"{take.name}: {len(take.skeleton)} joints",
        f"{take.frames} frames at {rate} fps ({take.duration:.2f} s)",
        f"1 unit = {unit:.4g} m",
    ]
    if take.trim:
        parts.append(f"analysed {take.trim[0]}:{take.trim[1]}")
    return ", ".join(parts)
