"""`mocapstudio compare`: performances beside a reference."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mocapstudio.cli.comparison_options import ComparisonOptions
from mocapstudio.cli.output import JsonPath, check_writable, write_json
from mocapstudio.cli.take_options import TakeOptions, with_options, with_take_options
from mocapstudio.motion.errors import FileError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mocapstudio.cli.comparison_job import Compared

LabelsFile = Annotated[
    Path | None,
    typer.Option("--labels", metavar="FILE", help="Segments of the reference (JSON)."),
]
Figure = Annotated[
    Path | None,
    typer.Option(
        "--figure",
        metavar="OUT.png",
        help="Draw the comparison (PNG or SVG); with several sources all below one another, and a"
        " picture each, named after it.",
    ),
]
WarpedFolder = Annotated[
    Path | None,
    typer.Option("--warped", metavar="DIR", help="Write the sources in the reference's timing."),
]
_SUFFIXES = (".png", ".svg")


@with_take_options
@with_options(ComparisonOptions, "comparing")
def compare(
    reference: Annotated[Path, typer.Argument(metavar="REFERENCE", help="What is compared to.")],
    sources: Annotated[
        list[Path], typer.Argument(metavar="SOURCE...", help="What is compared: files or folders.")
    ],
    labels: LabelsFile = None,
    figure: Figure = None,
    warped: WarpedFolder = None,
    json_path: JsonPath = None,
    *,
    reading: TakeOptions,
    comparing: ComparisonOptions,
) -> None:
    """Compare performances with a reference: where each is early, late, different.

    Takes of joints and of markers can be compared with each other. Without --labels the segments
    of the reference are suggested from its rests. --joint-map names joints of the sources and
    what they are called in the reference.
    """
    from mocapstudio.cli.comparison_job import ComparisonJob, read_recordings
    from mocapstudio.cli.take_files import Workload
    from mocapstudio.comparison.masking import read_flags
    from mocapstudio.motion.joint_map import read_joint_map

    chosen = comparing.parameters()
    check_writable(json_path)
    _check_figure(figure)
    work = Workload(reading)
    names = read_joint_map(reading.joint_map) if reading.joint_map else {}
    flags = read_flags(comparing.mask) if comparing.mask else {}
    job = ComparisonJob(work, reference, chosen, names, labels, flags)
    files = work.files(sources)
    written: set[Path] = set()
    for path in files:
        with work.going_on():
            found = read_recordings(work, path)
            for source in found:
                done = job.run(source, path)
                if warped is not None:
                    _write_warped(done, warped, written, inputs=[reference, *files])
    if figure is not None:
        with work.going_on():
            _draw(job.done, figure)
    for name in job.unused_flags():
        print(f"warning: {comparing.mask}: -: {name} is not compared", file=sys.stderr)
    if json_path is None:
        from mocapstudio.cli.comparison_table import show

        show([(one.comparison, one.carried) for one in job.done])
    write_json(job.as_json(), json_path)
    raise typer.Exit(work.finish())


def _check_figure(path: Path | None) -> None:
    check_writable(path)
    if path is not None and path.suffix.lower() not in _SUFFIXES:
        raise FileError(path, "a picture is written as .png or .svg")


def _draw(done: Sequence[Compared], path: Path) -> None:
    from mocapstudio.pictures.comparison_picture import comparison_picture
    from mocapstudio.pictures.ranking_picture import ranking_picture

    svg, alone = path.suffix.lower() == ".svg", len(done) == 1
    for one in done:
        place = path if alone else path.with_stem(f"{path.stem}-{one.source.name}")
        comparison_picture(one.comparison, one.carried, svg=svg).save(place)
    if done and not alone:
        ranking_picture([one.comparison for one in done], svg=svg).save(path)


def _write_warped(done: Compared, folder: Path, taken: set[Path], inputs: Sequence[Path]) -> None:
    from mocapstudio import formats
    from mocapstudio.comparison.warped import warped
    from mocapstudio.formats.registry import FORMATS
    from mocapstudio.motion.take import Take

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(folder, f"cannot be made: {error.strerror}") from error
    take = warped(done.source, done.comparison)
    suffix = done.path.suffix
    holding = [s for one in FORMATS if one.write_markers is not None for s in one.suffixes]
    if isinstance(take, Take):
        suffix = ".bvh"
    elif suffix.lower() not in holding:
        suffix = ".trc"
    target = folder / f"{done.source.name}{suffix}"
    if target in taken:
        raise FileError(done.path, f"would replace what another take was written to, {target}")
    taken.add(target)
    formats.write(take, target, inputs=inputs)
