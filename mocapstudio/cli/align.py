"""`mocapstudio align`: a stream of poses beside a reference, frame by frame."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mocapstudio.cli.alignment_options import Reference, ReferenceLabels
from mocapstudio.cli.errors import complain
from mocapstudio.cli.take_options import TakeOptions, with_take_options
from mocapstudio.motion.errors import FileError

if TYPE_CHECKING:
    from mocapstudio.cli.take_files import Workload
    from mocapstudio.comparison.labels import Labels
    from mocapstudio.comparison.live import LiveAlignment, LiveState
    from mocapstudio.formats import Recording

STANDARD_INPUT = Path("-")


@with_take_options
def align(
    reference: Reference,
    stream: Annotated[
        Path,
        typer.Argument(
            metavar="STREAM",
            help="A take, or - for JSON lines on standard input:"
            ' {"time", "joints": {name: [x, y, z, w]}, "root": [x, y, z]}.',
        ),
    ],
    weights: Annotated[
        Path | None,
        typer.Option("--weights", metavar="FILE", help="What train-weights wrote."),
    ] = None,
    labels: ReferenceLabels = None,
    wait: Annotated[
        bool,
        typer.Option(
            "--wait", help="Wait for the action to begin, and after its end for the next."
        ),
    ] = False,
    paper: Annotated[
        bool,
        typer.Option(
            "--paper",
            help="As the paper does: poses alone, not their motion; paths weighted by length.",
        ),
    ] = False,
    *,
    reading: TakeOptions,
) -> None:
    """Tell for each frame of a stream where in the reference it is: one line of JSON a frame.

    `reference_frame` counts at the reference's own rate; `cost` is the mean cost of a step of the
    path so far; `misalignment` is in seconds, positive where the stream is ahead; `label` is the
    segment of the reference; `note` tells of repeated, late and missing frames. --joint-map names
    joints of the stream and what they are called in the reference.
    """
    from mocapstudio.cli.take_files import Workload
    from mocapstudio.comparison.live import played
    from mocapstudio.comparison.live_setup import live_alignment
    from mocapstudio.comparison.weights import read_weights

    work = Workload(reading)
    learnt = read_weights(weights) if weights is not None else None
    take = _one(work, reference)
    known = _labels_of(take, labels)
    if stream == STANDARD_INPUT:
        live = live_alignment(take, (), reading.fps, learnt, known, wait=wait, paper=paper)
        failed = _show(_from_input(live, reading.joint_map))
        raise typer.Exit(2 if failed else 0)
    other = renamed(_one(work, stream), reading.joint_map)
    live = live_alignment(take, (other,), other.rate, learnt, known, wait=wait, paper=paper)
    _show(_record(state, other.span[0]) for state in played(live, other))


def _one(work: Workload, path: Path) -> Recording:
    from mocapstudio.cli.comparison_job import read_recordings

    found = read_recordings(work, path)
    if len(found) > 1:
        print(
            f"warning: {path}: -: holds {len(found)} performers; {found[0].name} is taken",
            file=sys.stderr,
        )
    return found[0]


def _labels_of(take: Recording, path: Path | None) -> Labels | None:
    from mocapstudio.comparison.labels import labels_of, read_labels

    if path is None:
        return None
    known = labels_of(take.name, read_labels(path))
    if known is None:
        raise FileError(path, f"has no labels of {take.name}")
    return known


def renamed(take: Recording, joint_map: Path | None) -> Recording:
    """Return a take whose joints are called what the reference calls them."""
    from mocapstudio.motion.joint_map import read_joint_map, rename_recording

    return take if joint_map is None else rename_recording(take, read_joint_map(joint_map))


def _from_input(
    live: LiveAlignment, joint_map: Path | None
) -> Iterator[dict[str, Any] | FileError]:
    from mocapstudio.comparison.online_features import JointRotations
    from mocapstudio.comparison.online_stream import StreamPoses, read_frames
    from mocapstudio.motion.joint_map import read_joint_map

    features = live.aligner.reference.features
    if not isinstance(features, JointRotations):
        raise FileError(STANDARD_INPUT, "sends joints, the reference holds markers")
    names = read_joint_map(joint_map) if joint_map is not None else {}
    poses = StreamPoses(features, names)
    for frame in read_frames(sys.stdin):
        if isinstance(frame, FileError):
            yield frame
        else:
            yield _record(live.feed(poses.of(frame)[1], frame.time))


def _record(state: LiveState, start: int = 0) -> dict[str, Any]:
    step = state.step
    record: dict[str, Any] = {
        "frame": start + state.frame,
        "reference_frame": step.reference_frame if step else None,
        "cost": _rounded(step.cost) if step else None,
        "label": step.label if step else None,
        "misalignment": _rounded(step.misalignment) if step else None,
        "pose_cost": _rounded(step.pose_cost) if step else None,
        "action": state.action,
    }
    if state.note is not None:
        record["note"] = state.note.value
    return record


def _rounded(value: float | None) -> float | None:
    return None if value is None else round(value, 6)


def _show(records: Iterator[dict[str, Any] | FileError] | Iterator[dict[str, Any]]) -> bool:
    """Print records as they come; return whether a line of the stream was bad."""
    failed = False
    for record in records:
        if isinstance(record, FileError):
            complain(record)
            failed = True
            continue
        sys.stdout.write(json.dumps(record, ensure_ascii=False, allow_nan=False) + "\n")
        sys.stdout.flush()
    return failed
