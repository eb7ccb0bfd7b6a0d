"""The kata comparison against known truth: warps recovered, and speed beside other libraries."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocapstudio import formats
from mocapstudio.comparison.kata import compare
from mocapstudio.comparison.labels import labels_of, read_labels
from mocapstudio.comparison.parameters import PAPER, ROOT, ComparisonParameters
from mocapstudio.comparison.segments import boundary_errors, suggested
from mocapstudio.evaluation.alignment_cases import read_labelled
from mocapstudio.evaluation.corpora import long_takes
from mocapstudio.evaluation.kata_peers import Peer, peers
from mocapstudio.evaluation.kata_warps import Disturbance, perform_again
from mocapstudio.evaluation.tables import Table
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.progress import Progress, run
from mocapstudio.motion.take import Take
from mocapstudio.similarity.alignment.costs import PoseDistances
from mocapstudio.similarity.alignment.dtw import align

Array = NDArray[np.float64]

FRAME = 1 / 25
"""Seconds; errors are counted in frames at 25 Hz."""

KATA_FRAMES, KATA_MARKERS = 2675, 25

DISTURBANCES = {
    "pace and pauses alone": Disturbance(noise_degrees=0, style_degrees=0),
    "5° of noise": Disturbance(style_degrees=0),
    "5° of noise, 10° of style": Disturbance(),
    "5° of noise, 20° of style": Disturbance(style_degrees=20),
    "5° of noise, 10° of style, 10° of sway": Disturbance(sway_degrees=10),
    "the same, pace up to 2.5 ×": Disturbance(pace=2.5, sway_degrees=10),
}
METHODS = {
    "ours": ComparisonParameters(),
    "ours, frame of the hips": ComparisonParameters(features=ROOT),
    "ours, true speed": ComparisonParameters(true_speed=True),
    "paper": PAPER,
}

_LEAST_SECONDS = 4.0


@dataclass(frozen=True)
class WarpRow:
    """How well one method recovers one kind of performance.

    Parameters
    ----------
    method, disturbance
        Their names.
    takes
        Performances measured.
    median, mean, high
        Frames at 25 Hz between found and true timing: over all frames of all performances the
        median, the mean and the 95 % quantile.
    """

    method: str
    disturbance: str
    takes: int
    median: float
    mean: float
    high: float

    def to_json(self) -> dict[str, Any]:
        """Plain objects for JSON."""
        return asdict(self)


@dataclass(frozen=True)
class PeerRow:
    """One alignment of a whole kata.

    Parameters
    ----------
    name
        Of the library.
    seconds, cpu
        Best of the repetitions: by the clock, and of all processors together, which other
        programs on the machine disturb less.
    cost
        Accumulated distance found.
    """

    name: str
    seconds: float
    cpu: float
    cost: float

    def to_json(self) -> dict[str, Any]:
        """Plain objects for JSON."""
        return asdict(self)


def recovered_warps(
    data: Sequence[Path], *, seed: int = 0, limit: int = 3
) -> Generator[Progress, None, list[WarpRow]]:
    """Perform takes again at another pace, disturbed, and compare found with true timing.

    Parameters
    ----------
    data
        Takes or folders; those of joints that last at least four seconds are used.
    seed
        Of choice of takes, timing, noise and style.
    limit
        Performances a row.

    Raises
    ------
    MocapError
        If no take can be read.
    """
    takes = _takes(data, seed, limit)
    rows = []
    for i, (name, how) in enumerate(DISTURBANCES.items()):
        errors: dict[str, list[Array]] = {method: [] for method in METHODS}
        for n in range(limit):
            yield Progress((i + n / limit) / len(DISTURBANCES), name)
            take = takes[n % len(takes)]
            again = perform_again(take, how, 1000 * seed + 10 * i + n)
            for method, chosen in METHODS.items():
                found = run(compare(take, again.take, chosen))
                errors[method].append(np.abs(found.warp - again.truth) / float(take.rate) / FRAME)
        rows += [_warp_row(method, name, found) for method, found in errors.items()]
    return rows


def _warp_row(method: str, disturbance: str, errors: Sequence[Array]) -> WarpRow:
    every = np.concatenate(errors)
    return WarpRow(
        method,
        disturbance,
        len(errors),
        float(np.median(every)),
        float(np.mean(every)),
        float(np.quantile(every, 0.95)),
    )


def _takes(data: Sequence[Path], seed: int, limit: int) -> list[Take]:
    files = list(formats.find_takes(list(data)))
    order = np.random.default_rng(seed).permutation(len(files))
    takes = list(islice(long_takes((files[i] for i in order), _LEAST_SECONDS), limit))
    if not takes:
        raise MocapError(f"no take of joints of at least {_LEAST_SECONDS:.0f} s can be read")
    return takes


def kata_speed(
    *,
    frames: int = KATA_FRAMES,
    seed: int = 0,
    times: int = 5,
    beside: Mapping[str, Peer] | None = None,
) -> Generator[Progress, None, list[PeerRow]]:
    """Align two sequences of the paper's size with path, ours and other libraries in turn.

    Parameters
    ----------
    frames
        Length of both.
    seed
        Of the sequences.
    times
        Repetitions, of which the best counts.
    beside
        The other libraries by name; those that are installed where None.
    """
    others = peers() if beside is None else beside
    rng = np.random.default_rng(seed)
    one, other = (
        np.cumsum(rng.normal(0, 0.02, (frames, 3 * KATA_MARKERS)), axis=0) for _ in range(2)
    )
    work: dict[str, Callable[[], float]] = {"ours": lambda: _ours(one, other)}
    work |= {name: _cost_of(peer, one, other) for name, peer in others.items()}
    cost: dict[str, float] = {}
    for name, action in work.items():
        yield Progress(0.0, f"{name}, once to warm it")
        cost[name] = action()
    best = dict.fromkeys(work, (math.inf, math.inf))
    for i in range(times):
        yield Progress(i / times, "aligning")
        for name, action in work.items():
            begun = time.perf_counter(), time.process_time()
            action()
            taken = time.perf_counter() - begun[0], time.process_time() - begun[1]
            best[name] = min(best[name][0], taken[0]), min(best[name][1], taken[1])
    return [PeerRow(name, *best[name], cost[name]) for name in work]


def _cost_of(peer: Peer, one: Array, other: Array) -> Callable[[], float]:
    return lambda: peer(one, other)[0]


def _ours(one: Array, other: Array) -> float:
    return align(PoseDistances(one.astype(np.float32), other.astype(np.float32))).cost


@dataclass(frozen=True)
class BoundaryRow:
    """Suggested segments against labels made by hand.

    Parameters
    ----------
    labels
        Name of the file.
    takes, boundaries
        How many were measured.
    median, high
        Seconds from a given boundary to the nearest suggested one: median and 90 % quantile.
    suggested
        Boundaries suggested for each given one.
    """

    labels: str
    takes: int
    boundaries: int
    median: float
    high: float
    suggested: float

    def to_json(self) -> dict[str, Any]:
        """Plain objects for JSON."""
        return asdict(self)


def suggested_boundaries(
    data: Sequence[Path], labels: Sequence[Path]
) -> Generator[Progress, None, list[BoundaryRow]]:
    """Measure suggested segments of labelled takes, found in the data by name."""
    files = list(formats.find_takes(list(data)))
    rows = []
    for i, path in enumerate(labels):
        yield Progress(i / len(labels), path.stem)
        known = read_labels(path)
        errors, takes, count = [], 0, 0
        for file in files:
            given = labels_of(file.name, known)
            if given is None:
                continue
            recording = read_labelled(file, given)
            given, found = given.at_rate(recording.rate), suggested(recording)
            errors.append(boundary_errors(found, given.segments, float(recording.rate)))
            takes, count = takes + 1, count + len({e for s in found for e in (s.start, s.end)})
        if takes:
            rows.append(_boundary_row(path.stem, takes, np.concatenate(errors), count))
    return rows


def _boundary_row(name: str, takes: int, errors: Array, found: int) -> BoundaryRow:
    median, high = np.quantile(errors, [0.5, 0.9])
    return BoundaryRow(name, takes, len(errors), float(median), float(high), found / len(errors))


def kata_tables(
    warps: Sequence[WarpRow], speed: Sequence[PeerRow], boundaries: Sequence[BoundaryRow] = ()
) -> list[Table]:
    """Tables of the rows, as the other benchmarks have them."""
    tables = []
    if warps:
        rows = tuple(
            (
                w.disturbance,
                w.method,
                str(w.takes),
                *(f"{v:.2f}" for v in (w.median, w.mean, w.high)),
            )
            for w in warps
        )
        head = ("performed again with", "method", "takes", "median", "mean", "95 %")
        note = "frames at 25 Hz between found and true timing; to reach: median 2"
        tables.append(Table("Kata: known warps", head, rows, note))
    if speed:
        ours = next(row for row in speed if row.name == "ours")
        lines = tuple(
            (
                row.name,
                f"{1e3 * row.seconds:.0f} ms",
                f"{row.seconds / ours.seconds:.1f} ×",
                f"{1e3 * row.cpu:.0f} ms",
                f"{row.cpu / ours.cpu:.1f} ×",
                f"{row.cost:.2f}",
            )
            for row in speed
        )
        title = f"Kata: alignment with path, {KATA_FRAMES} × {KATA_FRAMES} frames, 25 markers"
        note = "to reach: 60 ms, and 5 × faster than the best other"
        tables.append(
            Table(
                title, ("library", "time", "of ours", "processors", "of ours", "cost"), lines, note
            )
        )
    if boundaries:
        found = tuple(
            (
                row.labels,
                str(row.takes),
                str(row.boundaries),
                f"{row.median:.2f} s",
                f"{row.high:.2f} s",
                f"{row.suggested:.1f}",
            )
            for row in boundaries
        )
        columns = ("labels", "takes", "boundaries", "median", "90 %", "suggested for each")
        note = "seconds from a boundary set by hand to the nearest suggested one"
        tables.append(Table("Kata: suggested segments", columns, found, note))
    return tables
