"""`mocapstudio solve`: markers to joints."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mocapstudio.cli.output import JsonPath, check_writable, write_json
from mocapstudio.cli.take_options import TakeOptions, with_take_options

if TYPE_CHECKING:
    from mocapstudio.motion.solving.model import Solved


@with_take_options
def solve(
    markers: Annotated[Path, typer.Argument(metavar="MARKERS", help="C3D, TRC or a table.")],
    template: Annotated[
        Path,
        typer.Option(
            "--template",
            metavar="TAKE",
            help="A take of joints (BVH, AMC, …) of the same or a similar performer: its skeleton"
            " is solved to, its bones are fitted.",
        ),
    ],
    out: Annotated[
        Path | None,
        typer.Option("-o", "--out", metavar="OUT", help="Motion to write; MARKERS.bvh by default."),
    ] = None,
    json_path: JsonPath = None,
    *,
    reading: TakeOptions,
) -> None:
    """Solve markers to the skeleton of a template.

    Which joint carries a marker is told by its name (sets of Vicon, CMU, OpenSim, OpenCap,
    Qualisys; --joint-map renames others) and by what it moves with. Where it sits there and how
    long bones are is fitted. Residuals are from each measured marker to where the joints put it:
    millimetres as text, metres in the JSON.
    """
    from mocapstudio import formats
    from mocapstudio.cli.solving import read_template, solved
    from mocapstudio.motion.errors import FileError
    from mocapstudio.motion.joint_map import read_joint_map, rename_recording
    from mocapstudio.motion.markers import MarkerTake

    target = out or markers.with_suffix(".bvh")
    check_writable(target)
    check_writable(json_path)
    names = read_joint_map(reading.joint_map) if reading.joint_map else {}
    takes, _ = formats.read_any(markers, reading.reading())
    found = [take for take in takes if isinstance(take, MarkerTake)]
    if not found:
        raise FileError(markers, "holds joints already; markers are wanted")
    body = read_template(template, reading)
    records = []
    for number, take in enumerate(found, 1):
        renamed = rename_recording(take, names)
        assert isinstance(renamed, MarkerTake)
        result = solved(markers, renamed, body)
        path = target.with_stem(f"{target.stem}-{number}") if len(found) > 1 else target
        formats.write(result.take, path, inputs=[markers, template])
        for warning in result.warnings:
            print(f"warning: {markers}: -: {warning}", file=sys.stderr)
        records.append(as_json(result, markers, path))
        if json_path is None:
            _show(result, markers, path)
    whole = records[0] if len(records) == 1 else {"takes": records}
    write_json(whole, json_path)


def as_json(result: Solved, markers: Path, output: Path) -> dict[str, Any]:
    """Return what the JSON says of one performer; lengths in metres."""
    import numpy as np

    skeleton, left = result.take.skeleton, result.residuals
    carriers = [skeleton.names[joint] for joint in result.joints]
    return {
        "path": str(markers),
        "output": str(output),
        "fps": float(result.take.rate),
        "frames": result.take.frames,
        "joints": list(skeleton.names),
        "residual": {
            "mean": result.mean,
            "max": result.max,
            "markers": {
                label: {
                    "joint": joint,
                    "mean": _number(np.nanmean(one)) if measured else None,
                    "max": _number(np.nanmax(one)) if measured else None,
                }
                for label, joint, one in zip(result.labels, carriers, left.T, strict=True)
                for measured in [bool((~np.isnan(one)).any())]
            },
            "frames": [None if np.isnan(one).all() else _number(np.nanmean(one)) for one in left],
        },
        "bones": {
            name: {"length": _number(np.linalg.norm(offset)), "scale": _number(scale)}
            for name, offset, scale in zip(
                skeleton.names, skeleton.offsets, result.scales, strict=True
            )
        },
        "left_out": list(result.left_out),
        "warnings": list(result.warnings),
    }


def _number(value: Any) -> float:
    return round(float(value), 6)


def _show(result: Solved, markers: Path, output: Path) -> None:
    import numpy as np
    from rich.console import Console
    from rich.table import Table

    console = Console()
    console.print(
        f"{markers}: {result.take.frames} frames, {len(result.labels)} markers,"
        f" residual mean {1e3 * result.mean:.1f} mm, max {1e3 * result.max:.1f} mm; wrote {output}",
        markup=False,
        highlight=False,
        soft_wrap=True,
    )
    table = Table("Marker", "Joint", "Mean", "Max", box=None, pad_edge=False)
    for label, joint, one in zip(result.labels, result.joints, result.residuals.T, strict=True):
        if not np.isnan(one).all():
            figures = (f"{1e3 * np.nanmean(one):.1f} mm", f"{1e3 * np.nanmax(one):.1f} mm")
            table.add_row(label, result.take.skeleton.names[joint], *figures)
    console.print(table)
