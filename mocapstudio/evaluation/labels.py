"""Cases from labels made by hand, or from a version cleaned by hand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mocapstudio import formats
from mocapstudio.cleaning.model import Kind
from mocapstudio.evaluation.cases import CONTEXT_TAKES, Case, ContextSize
from mocapstudio.evaluation.corpora import OWN, Entry, entries, read_some, read_take
from mocapstudio.evaluation.truth import (
    Mask,
    Truth,
    analysed_rows,
    departure,
    erroneous,
    labelled,
    limits,
)
from mocapstudio.formats.json_file import read_json
from mocapstudio.motion.errors import FileError, MocapError
from mocapstudio.motion.runs import runs
from mocapstudio.motion.take import Take


def read_labels(path: Path) -> dict[str, tuple[Truth, ...]]:
    """Read labels by the stem of the take's file name; takes without errors have an empty tuple.

    Either the JSON that `mocapstudio detect` writes, corrected by hand, or
    ``{"labels": [{"take", "joint", "start", "end", "kind"}], "clean": ["take", …]}``: frames
    0-based at the take's own rate, ends exclusive, `kind` and `clean` may be missing.

    Raises
    ------
    FileError
        If the file cannot be read or is neither.
    """
    content = read_json(path, "labels of errors")
    try:
        return {take: tuple(truths) for take, truths in _by_take(content).items()}
    except (MocapError, KeyError, TypeError, AttributeError) as cause:
        raise FileError(path, f"does not hold labels of errors: {cause}") from cause


def _by_take(content: Mapping[str, Any]) -> dict[str, list[Truth]]:
    found: dict[str, list[Truth]] = {}
    if "takes" in content:
        for take in content["takes"]:
            # A flag's `joints` are its limb; each of them has a flag of its own.
            flags = [{**flag, "joints": [flag["joint"]]} for flag in take["flags"]]
            found[Path(take["path"]).stem] = [Truth.from_json(flag) for flag in flags]
        return found
    for name in content.get("clean", []):
        found.setdefault(Path(name).stem, [])
    for label in content["labels"]:
        found.setdefault(Path(label["take"]).stem, []).append(Truth.from_json(label))
    return found


def labelled_cases(
    data: Sequence[Path], labels: Mapping[str, Sequence[Truth]], context: ContextSize = "large"
) -> list[Case]:
    """One case for each labelled take; the context are other takes of the data.

    Raises
    ------
    MocapError
        If a labelled take is not among the data, or a label does not fit its take.
    """
    everything = entries(tuple(data), OWN)
    by_stem = {entry.path.stem: entry for entry in everything}
    missing = sorted(set(labels) - set(by_stem))
    if missing:
        raise MocapError(f"labelled takes are not among the data: {', '.join(missing[:5])}")
    made = []
    for stem, truths in sorted(labels.items()):
        take = by_stem[stem].read()
        rows = analysed_rows(take.skeleton)
        truths = _moved(truths, _dropped(by_stem[stem].path, take))
        mask = labelled(take.frames, rows, truths)
        around = _others(everything, {by_stem[stem].digest}, take, context)
        made.append(Case(take, take, tuple(truths), around, given=mask))
    return made


def _dropped(path: Path, take: Take) -> int:
    """How many frames of the file, such as a T-pose, were left out before the take."""
    return int(formats.read(path)[0][0].frames - take.frames)


def _moved(truths: Sequence[Truth], dropped: int) -> list[Truth]:
    """Labels in the file's own frames, counted from the take's first."""
    kept = [truth for truth in truths if truth.end > dropped]
    return [
        replace(truth, start=max(truth.start - dropped, 0), end=truth.end - dropped)
        for truth in kept
    ]


def cleaned_case(data: Sequence[Path], cleaned: Path, context: ContextSize = "large") -> Case:
    """Build the case of a take that has a version cleaned by hand.

    The take is that of the data with the same file name, else the first with the same joints and
    number of frames; the rest of the data is its context.

    Raises
    ------
    MocapError
        If no take of the data fits.
    """
    clean = read_take(cleaned)
    digest = clean.source.digest if clean.source else ""
    candidates = [e for e in entries(tuple(data), OWN) if e.digest != digest]
    for entry in sorted(candidates, key=lambda e: e.path.stem != cleaned.stem):
        try:
            take = entry.read()
        except MocapError:
            continue
        if take.skeleton.names == clean.skeleton.names and take.frames == clean.frames:
            break
    else:
        raise MocapError(f"{cleaned}: no take of the data has its joints and number of frames")
    around = _others(candidates, {entry.digest}, take, context)
    rows = analysed_rows(take.skeleton)
    return Case(take, clean, tuple(events_of(erroneous(clean, take), rows)), around)


def events_of(mask: Mask, rows: Sequence[str]) -> list[Truth]:
    """Every run of erroneous frames of a row of `mask` (F, R), as an error of unknown kind."""
    found = []
    for column, row in enumerate(rows):
        found += [Truth(Kind.OFFSET, (row,), start, end) for start, end in runs(mask[:, column])]
    return sorted(found, key=lambda truth: truth.start)


def departure_map(case: Case) -> np.ndarray[Any, np.dtype[np.float64]]:
    """(F, R) map of how far the take is from its clean version: 0.5 at the limit of error."""
    scaled = departure(case.clean, case.dirty, case.rows) / limits(case.rows)
    return np.asarray(1.0 - np.exp(-np.log(2.0) * scaled**2))


def _others(
    everything: Sequence[Entry], without: set[str], take: Take, context: ContextSize
) -> tuple[Take, ...]:
    size = CONTEXT_TAKES[context]
    if not size:
        return ()
    others = [entry for entry in everything if entry.digest not in without]
    return tuple(replace(t, trim=None) for t in read_some(others, size, like=take))
