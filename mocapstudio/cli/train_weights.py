"""`mocapstudio train-weights`: joint weights for the online alignment."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mocapstudio.cli.alignment_options import Reference, TakeLabels
from mocapstudio.cli.output import JsonPath, check_writable, write_json
from mocapstudio.cli.take_options import TakeOptions, with_take_options
from mocapstudio.motion.errors import FileError, ParameterError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from mocapstudio.cli.take_files import Workload
    from mocapstudio.comparison.labels import Labels
    from mocapstudio.comparison.weights_examples import LabelledTake
    from mocapstudio.comparison.weights_training import Training


@with_take_options
def train_weights(
    reference: Reference,
    takes: Annotated[
        list[Path], typer.Argument(metavar="TAKE...", help="Performances of it: files or folders.")
    ],
    labels: TakeLabels,
    out: Annotated[Path, typer.Option("-o", "--out", metavar="WEIGHTS", help="File to write.")],
    performer: Annotated[
        str | None,
        typer.Option(
            "--performer",
            metavar="REGEX",
            help="What in a take's name tells the performer: the first group, or all that matches."
            " By default the folder where there are several, else each take by itself.",
        ),
    ] = None,
    folds: Annotated[int, typer.Option(help="Of the cross-validation.", min=0)] = 5,
    iterations: Annotated[int, typer.Option(help="Of the evolution.", min=1)] = 300,
    seed: Annotated[int, typer.Option(help="Of folds and evolution.", min=0)] = 0,
    paper: Annotated[
        bool,
        typer.Option("--paper", help="Learn as the paper does: poses alone, from weights of 1."),
    ] = False,
    json_path: JsonPath = None,
    *,
    reading: TakeOptions,
) -> None:
    """Learn how much each joint counts, so that the online alignment finds the segments.

    Quality is the share of frame pairs whose segments agree, averaged over how much of the
    movement has been seen; that of each fold is of performers whom the fold has not learnt from.
    Takes without labels are left out; so is the reference itself.
    """
    from dataclasses import replace

    from mocapstudio.cli.take_files import Workload
    from mocapstudio.comparison.labels import read_labels

    check_writable(out)
    check_writable(json_path)
    pattern = _pattern(performer)
    work = Workload(reading)
    known = [one for path in labels for one in read_labels(path)]
    files = work.files(takes)
    own = _labelled(work, reference, known)
    if not own:
        raise FileError(labels[0], f"has no labels of {reference.name}")
    found = [(reference, one) for one in own[1:]]
    for path in files:
        with work.going_on():
            if path.resolve() != reference.resolve():
                found += [(path, one) for one in _labelled(work, path, known, reading.joint_map)]
    if not found:
        raise FileError(labels[0], "has no labels of any of the takes")
    who = _performers([path for path, _ in found], pattern)
    others = [replace(one, performer=name) for (_, one), name in zip(found, who, strict=True)]
    choices = {"folds": folds, "iterations": iterations, "seed": seed}
    result = _learnt(own[0], others, choices, paper=paper)
    _finish(result, choices | {"paper": paper}, [path for path, _ in found], out, json_path)
    raise typer.Exit(work.finish())


def _labelled(
    work: Workload, path: Path, known: Sequence[Labels], joint_map: Path | None = None
) -> list[LabelledTake]:
    """Return the labelled actions of a file; a take that repeats its action gives several."""
    from mocapstudio.cli.align import renamed
    from mocapstudio.cli.comparison_job import read_recordings
    from mocapstudio.comparison.labels import labels_of
    from mocapstudio.comparison.weights_examples import LabelledTake, repetitions

    found = []
    for take in read_recordings(work, path):
        labels = labels_of(take.name, known)
        if labels is not None:
            found += repetitions(LabelledTake(renamed(take, joint_map), labels))
    return found


def _pattern(text: str | None) -> re.Pattern[str] | None:
    try:
        return None if text is None else re.compile(text)
    except re.error as error:
        raise ParameterError(f"--performer {text!r} is no regular expression: {error}") from error


def _performers(paths: Sequence[Path], pattern: re.Pattern[str] | None) -> list[str]:
    """Name each take's performer; an empty name counts as one of its own."""
    if pattern is None:
        folders = [path.resolve().parent.name for path in paths]
        return folders if len(set(folders)) > 1 else [""] * len(paths)
    names = []
    for path in paths:
        match = pattern.search(path.stem)
        if match is None:
            raise FileError(path, f"its name tells no performer: no {pattern.pattern!r} in it")
        names.append(match.group(1) if pattern.groups else match.group())
    return names


def _learnt(
    reference: LabelledTake,
    others: Sequence[LabelledTake],
    choices: Mapping[str, int],
    *,
    paper: bool,
) -> Training:
    from dataclasses import replace

    from mocapstudio.cli.progress import run
    from mocapstudio.comparison.weights_examples import example_set
    from mocapstudio.comparison.weights_training import PAPER, TrainingParameters, training

    made = example_set(reference, others, motion=not paper)
    parameters = replace(
        PAPER if paper else TrainingParameters(),
        folds=choices["folds"],
        iterations=choices["iterations"],
        seed=choices["seed"],
    )
    work = training(made.reference, made.segments, made.examples, parameters)
    return run(work, "train-weights")


def _finish(
    result: Training,
    choices: Mapping[str, Any],
    paths: Sequence[Path],
    out: Path,
    json_path: Path | None,
) -> None:
    from dataclasses import replace
    from datetime import UTC, datetime

    from mocapstudio import __version__
    from mocapstudio.comparison.weights import write_weights

    provenance = {
        "version": __version__,
        "time": datetime.now(UTC).isoformat(timespec="seconds"),
        "parameters": dict(choices),
        "takes": list(dict.fromkeys(map(str, paths))),
    }
    weights = replace(result.weights, provenance=provenance)
    write_weights(weights, out)
    if json_path is None:
        for i, fold in enumerate(weights.folds, 1):
            print(
                f"fold {i}: quality {100 * fold.test:.1f} % on {len(fold.performers)} left out"
                f" ({100 * fold.unweighted:.1f} % without weights,"
                f" {100 * fold.training:.1f} % in training)"
            )
        print(f"all takes: quality {100 * result.quality:.1f} % in training; written to {out}")
    write_json({"output": str(out), "quality": result.quality} | weights.to_json(), json_path)
