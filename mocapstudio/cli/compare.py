"""`mocapstudio compare`: performances beside a reference."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from mocapstudio.cli.output import JsonPath, check_writable, write_json
from mocapstudio.cli.take_options import Fps, JointMap, TakeOptions, Unit, UpAxis
from mocapstudio.motion.errors import FileError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from mocapstudio.cli.take_files import Workload
    from mocapstudio.comparison.labels import Labels
    from mocapstudio.comparison.model import Comparison
    from mocapstudio.comparison.parameters import ComparisonParameters
    from mocapstudio.comparison.segments import CarriedSegment
    from mocapstudio.formats import Recording

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
    from mocapstudio.cli.take_files import Workload
    from mocapstudio.comparison.parameters import ComparisonParameters
    from mocapstudio.motion.joint_map import read_joint_map

    check_writable(json_path)
    _check_figure(figure)
    chosen = ComparisonParameters(features=features, true_speed=true_speed)
    work = Workload(TakeOptions(fps, unit, up, joint_map))
    names = read_joint_map(joint_map) if joint_map else {}
    job = _Job(work, reference, chosen, names, labels)
    files = work.files(sources)
    several = len(files) > 1
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
                    _write_warped(done, warped, inputs=[reference, *files])
    if json_path is None:
        from mocapstudio.cli.comparison_table import show

        show([(one.comparison, one.carried) for one in job.done])
    write_json(job.as_json(), json_path)
    raise typer.Exit(work.exit_code)


def read_recordings(work: Workload, path: Path) -> list[Recording]:
    """Read the recordings of a file, of joints or of markers.

    Raises
    ------
    FileError
        If the file cannot be read.
    """
    from mocapstudio import formats

    found, report = formats.read_any(path, work.options.reading())
    for problem in [one for one in report.problems if not one.guess][:3]:
        place = "-" if problem.line is None else problem.line
        print(f"warning: {path}: {place}: {problem.what}; {problem.done}", file=sys.stderr)
    return list(found)


class _Done:
    """One source that was compared."""

    def __init__(
        self,
        path: Path,
        source: Recording,
        comparison: Comparison,
        carried: Sequence[CarriedSegment],
    ) -> None:
        self.path, self.source = path, source
        self.comparison, self.carried = comparison, carried

    def as_json(self) -> dict[str, Any]:
        """Return what the JSON says of the source."""
        found = self.comparison
        return {
            "path": str(self.path),
            "name": found.source,
            "fps": float(found.source_rate),
            "path_pairs": found.path.tolist(),
            "misalignment": found.misalignment.tolist(),
            "misalignment_relative": found.misalignment_relative.tolist(),
            "timing": found.timing.tolist(),
            "pose_difference": found.pose_difference.astype(float).tolist(),
            "dissimilarity": found.dissimilarity,
            "doubt": found.doubt,
            "rows": list(found.rows),
            "segments": [_segment_as_json(one) for one in self.carried],
            "warnings": list(found.warnings),
        }


def _segment_as_json(one: CarriedSegment) -> dict[str, Any]:
    return {
        "name": one.reference.name,
        "reference": {"start": one.reference.start, "end": one.reference.end},
        "start": one.source.start,
        "end": one.source.end,
        "delay": one.delay,
        "delay_relative": one.delay_relative,
        "reference_duration": one.reference_duration,
        "duration": one.source_duration,
        "pose_difference": one.pose_difference,
    }


class _Job:
    """Compares sources with one reference."""

    def __init__(
        self,
        work: Workload,
        path: Path,
        chosen: ComparisonParameters,
        names: Mapping[str, str],
        labels: Path | None,
    ) -> None:
        self.path, self.chosen, self.names = path, chosen, names
        self.reference = read_recordings(work, path)[0]
        self.labels = self._segments(labels)
        self.done: list[_Done] = []

    def run(self, source: Recording, path: Path) -> _Done:
        """Compare one source; its warnings go to standard error."""
        from mocapstudio.cli import progress
        from mocapstudio.comparison import kata, segments
        from mocapstudio.motion.errors import MocapError

        work = kata.compare(self.reference, source, self.chosen, names=self.names)
        try:
            comparison = progress.run(work, source.name)
        except MocapError as error:
            raise FileError(path, str(error)) from error
        for warning in comparison.warnings:
            print(f"warning: {path}: -: {warning}", file=sys.stderr)
        done = _Done(path, source, comparison, segments.carried(self.labels.segments, comparison))
        self.done.append(done)
        return done

    def as_json(self) -> dict[str, Any]:
        """Return what the JSON says of all."""
        ranking = sorted(self.done, key=lambda one: one.comparison.dissimilarity)
        return {
            "reference": {
                "path": str(self.path),
                "name": self.reference.name,
                "fps": float(self.reference.rate),
                "segments": self.labels.to_json()["segments"],
            },
            "sources": [one.as_json() for one in self.done],
            "ranking": [str(one.path) for one in ranking],
        }

    def _segments(self, path: Path | None) -> Labels:
        from mocapstudio.comparison.labels import Labels, labels_of, read_labels
        from mocapstudio.comparison.segments import suggested

        rate = self.reference.rate
        if path is None:
            return Labels(self.reference.name, rate, suggested(self.reference))
        everything = read_labels(path)
        found = labels_of(self.path.name, everything) or labels_of(self.reference.name, everything)
        if found is None:
            raise FileError(path, f"holds no labels of {self.reference.name}")
        found = found.at_rate(rate)
        if found.segments and found.segments[-1].end > self.reference.frames:
            raise FileError(
                path,
                f"segment {found.segments[-1].name} ends at frame {found.segments[-1].end} of"
                f" {self.reference.frames}",
            )
        return found


def _check_figure(path: Path | None) -> None:
    check_writable(path)
    if path is not None and path.suffix.lower() not in _SUFFIXES:
        raise FileError(path, "a picture is written as .png or .svg")


def _draw(done: _Done, path: Path) -> None:
    from mocapstudio.pictures.comparison_picture import comparison_picture

    comparison_picture(done.comparison, done.carried, svg=path.suffix.lower() == ".svg").save(path)


def _write_warped(done: _Done, folder: Path, inputs: Sequence[Path]) -> None:
    from mocapstudio import formats
    from mocapstudio.comparison.warped import warped
    from mocapstudio.motion.take import Take

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(folder, f"cannot be made: {error.strerror}") from error
    take = warped(done.source, done.comparison)
    suffix = ".bvh" if isinstance(take, Take) else done.path.suffix
    formats.write(take, folder / f"{done.source.name}{suffix}", inputs=inputs)
