"""`mocapstudio convert`: a take in another format, or in another layout of its own."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import typer

from mocapstudio.cli.take_options import TakeOptions, Up, with_take_options


def _unit(text: str) -> float:
    from mocapstudio.formats.options import parse_unit

    return parse_unit(text)


@with_take_options
def convert(
    source: Annotated[Path, typer.Argument(metavar="IN", help="The file to read.")],
    target: Annotated[Path, typer.Argument(metavar="OUT", help="The file to write.")],
    order: Annotated[
        str | None, typer.Option("--order", metavar="ORDER", help="Euler order, such as ZXY.")
    ] = None,
    channels: Annotated[
        Literal["3", "6"] | None,
        typer.Option("--channels", help="3: positions where joints move only; 6: everywhere."),
    ] = None,
    table: Annotated[
        Literal["positions", "angles"] | None,
        typer.Option("--table", help="What a CSV or TSV of joints holds; positions by default."),
    ] = None,
    out_unit: Annotated[
        float | None,
        typer.Option("--out-unit", parser=_unit, metavar="UNIT", help="Unit of length in OUT."),
    ] = None,
    out_up: Annotated[
        Up | None, typer.Option("--out-up", help="The axis that points up in OUT.")
    ] = None,
    trim: Annotated[
        bool, typer.Option("--trim", help="Leave out what the trim leaves out, such as a T-pose.")
    ] = False,
    *,
    reading: TakeOptions,
) -> None:
    """Write a take in another format or layout.

    Between formats that hold the same, joints or markers; tables also take the places or angles
    of joints. In IN's own format and without options, what is written equals what was read, number
    for number. --joint-map renames joints or markers; --order, --channels, --table, --out-unit and
    --out-up say how OUT is laid out.
    """
    from mocapstudio import formats
    from mocapstudio.motion.joint_map import read_joint_map, rename_recording

    writing = formats.WriteOptions(
        order=order.upper() if order else None,
        channels=None if channels is None else (3 if channels == "3" else 6),
        unit=out_unit,
        up=out_up,
        trim=trim,
        anew=reading.joint_map is not None,
        table=table,
    )
    names = read_joint_map(reading.joint_map) if reading.joint_map else {}
    takes, _ = formats.read_any(source, reading.reading())
    # A source's text holds all its performers at once; written anew, each gets a file.
    kept = source.suffix.lower() == target.suffix.lower() and not writing.relayout
    several = len(takes) > 1 and not kept
    for number, take in enumerate(takes if several else takes[:1], 1):
        path = target.with_stem(f"{target.stem}-{number}") if several else target
        formats.write(rename_recording(take, names), path, options=writing, inputs=[source])
