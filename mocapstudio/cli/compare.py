"""`mocapstudio compare`: performances beside a reference."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from mocapstudio.cli.output import JsonPath, check_writable, write_json
from mocapstudio.cli.take_options import Fps, JointMap, TakeOptions, Unit, UpAxis
from mocapstudio.motion.errors import FileError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from mocapstudio.cli.comparison_job import Compared

Features = Literal["box", "root", "rotations"]
_SUFFIXES = (".png", ".svg")


def compare(
    reference: Annotated[Path, typer.Argument(metavar="REFERENCE", help="What is compared to.")],
    sources: Annotated[
        list[Path], typer.Argument(metavar="SOURCE...", help="What is compared: files or folders.")
    ],
    true_speed: Annotated[
        bool,
        typer.Option("--true-speed", help="Align and colour at true speed, not at equal lengths."),
    ] = False,
    features: Annotated[
        Features,
        typer.Option(
            "--features",
            help="What a pose is: positions about neck and head in the unit box, positions about"
            " the hips, or rotations of joints.",
        ),
    ] = "box",
    labels: Annotated[
        Path | None,
        typer.Option("--labels", metavar="FILE", help="Segments of the reference (JSON)."),
    ] = None,
    figure: Annotated[
        Path | None,
        typer.Option(
            "--figure",
            metavar="OUT.png",
            help="Draw the comparison (PNG or SVG); with several sources a picture each, named"
            " after it.",
        ),
    ] = None,
    warped: Annotated[
        Path | None,
        typer.Option(
            "--warped", metavar="DIR", help="Write the sources in the reference's timing."
        ),
    ] = None,
    json_path: JsonPath = None,
    fps: Fps = None,
    unit: Unit = None,
    up: UpAxis = None,
    joint_map: JointMap = None,
) -> None:
    """Compare performances with a reference: where each is early, late, different.

    Takes of joints and of markers can be compared with each other. Without --labels the segments
    of the reference are suggested from its rests. --joint-map names joints of the sources and
    what they are called in the reference.
    """
    from mocapstudio.cli.comparison_job import ComparisonJob, read_recordings
    from mocapstudio.cli.take_files import Workload
    from mocapstudio.comparison.parameters import ComparisonParameters
    from mocapstudio.motion.joint_map import read_joint_map

    check_writable(json_path)
    _check_figure(figure)
    chosen = ComparisonParameters(features=features, true_speed=true_speed)
    work = Workload(TakeOptions(fps, unit, up, joint_map))
    names = read_joint_map(joint_map) if joint_map else {}
    job = ComparisonJob(work, reference, chosen, names, labels)
    files = work.files(sources)
    several = len(files) > 1
    written: set[Path] = set()
    for path in files:
        with work.going_on():
            found = read_recordings(work, path)
            for source in found:
                done = job.run(source, path)
                alone = not several and len(found) == 1
                if figure is not None:
                    _draw(
                        done, figure if alone else figure.with_stem(f"{figure.stem}-{source.name}")
                    )
                if warped is not None:
                    _write_warped(done, warped, written, inputs=[reference, *files])
    if json_path is None:
        from mocapstudio.cli.comparison_table import show

        show([(one.comparison, one.carried) for one in job.done])
    write_json(job.as_json(), json_path)
    raise typer.Exit(work.exit_code)


def _check_figure(path: Path | None) -> None:
    check_writable(path)
    if path is not None and path.suffix.lower() not in _SUFFIXES:
        raise FileError(path, "a picture is written as .png or .svg")


def _draw(done: Compared, path: Path) -> None:
    from mocapstudio.pictures.comparison_picture import comparison_picture

    comparison_picture(done.comparison, done.carried, svg=path.suffix.lower() == ".svg").save(path)


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
