"""How long the parts of an analysis take, warm and in process (bench.md, 'Speed')."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mocapstudio import formats
from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.mean_texture import departure, mean_texture
from mocapstudio.evaluation.corpora import available, entries, join, read_some
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.progress import Progress, run
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import comparable_joints, motion_texture
from mocapstudio.similarity.words import Corpus, WordShape, find_neighbours, trim_count

_SOURCE_SECONDS = 20.0
_CONTEXT_TAKES = 30
_CONTEXT_SECONDS = 15.0


@dataclass(frozen=True)
class SpeedRow:
    """One measurement.

    Parameters
    ----------
    name
        What was done.
    seconds
        Best of the repetitions, warm.
    reach
        Seconds to be reached, or NaN.
    paper
        Seconds that the paper states, or NaN.
    """

    name: str
    seconds: float
    reach: float = math.nan
    paper: float = math.nan

    def to_json(self) -> dict[str, Any]:
        """Plain objects for JSON."""
        return {
            "name": self.name,
            "seconds": self.seconds,
            "reach": self.reach,
            "paper": self.paper,
        }


def timing(
    data: Sequence[Path], *, seed: int = 0, long: bool = True
) -> Generator[Progress, None, list[SpeedRow]]:
    """Measure the rows on takes of the first set that the data hold.

    Parameters
    ----------
    data
        Folders or files.
    seed
        Of the choice of takes.
    long
        Whether 600 s are searched against themselves.

    Raises
    ------
    MocapError
        If no take can be read.
    """
    found = entries(tuple(data), available(tuple(data))[0])
    order = np.random.default_rng(seed).permutation(len(found))
    takes = read_some([found[i] for i in order], 40)
    if not takes:
        raise MocapError("no take of the data can be read")
    source = lasting(takes, _SOURCE_SECONDS)
    context = [lasting(takes[i:] + takes[:i], _CONTEXT_SECONDS) for i in range(_CONTEXT_TAKES)]
    rows: list[SpeedRow] = []
    work: list[tuple[str, Callable[[], object], float, float, int]] = [
        ("20 s against itself, texture to map", lambda: to_map(source, ()), 0.05, 140.0, 5),
        ("20 s against itself, whole analysis", lambda: run(detect(source)), 0.2, math.nan, 3),
        (
            f"20 s against {_CONTEXT_TAKES} takes of 15 s, whole analysis",
            lambda: run(detect(source, context)),
            math.nan,
            math.nan,
            2,
        ),
        *_growth(takes, source, context),
        *_reading([found[i].path for i in order]),
    ]
    if long:
        whole = lasting(takes, 600.0)
        work.append(("600 s against itself, exact", lambda: to_map(whole, ()), 5.0, math.nan, 1))
    for i, (name, action, reach, paper, times) in enumerate(work):
        yield Progress(i / len(work), name)
        rows.append(SpeedRow(name, best_of(action, times), reach, paper))
    return rows


def _growth(
    takes: list[Take], source: Take, context: list[Take]
) -> list[tuple[str, Callable[[], object], float, float, int]]:
    """How cost grows with the source, and with the context."""
    none = math.nan
    rows: list[tuple[str, Callable[[], object], float, float, int]] = []
    for seconds in (10, 20, 40, 80):
        longer = lasting(takes, float(seconds))
        name = f"source of {seconds} s against 10 takes of 15 s"
        rows.append((name, lambda t=longer: to_map(t, context[:10]), none, none, 2))  # type: ignore[misc]
    for count in (5, 10, 20, 30):
        name = f"20 s against {count} takes of 15 s"
        rows.append((name, lambda n=count: to_map(source, context[:n]), none, none, 2))  # type: ignore[misc]
    return rows


def _reading(
    paths: list[Path],
) -> list[tuple[str, Callable[[], object], float, float, int]]:
    largest = max(paths, key=lambda path: path.stat().st_size)
    megabytes = largest.stat().st_size / 1e6
    name = f"read a {megabytes:.1f} MB take ({largest.suffix[1:]})"
    return [(name, lambda: formats.read(largest), 0.02 * megabytes, math.nan, 5)]


def to_map(take: Take, context: Sequence[Take]) -> object:
    """Do the paper's own steps: texture, words, neighbours, mean texture, departure."""
    joints = comparable_joints(take, context)
    shape = WordShape()
    corpus = Corpus.of([motion_texture(one, joints) for one in (take, *context)])
    texture = corpus.textures[0]
    trim = trim_count(len(joints), whole_body=True)
    neighbours = find_neighbours(texture, corpus, 5, trim, shape)
    return departure(texture, mean_texture(texture, corpus, neighbours, shape))


def lasting(takes: Sequence[Take], seconds: float) -> Take:
    """Join takes, over and over if need be, and cut them to a length."""
    chosen: list[Take] = []
    while sum(t.duration for t in chosen) < seconds:
        chosen.append(takes[len(chosen) % len(takes)])
    joined, _ = join(chosen, f"{seconds:g} s")
    frames = round(seconds * float(joined.rate))
    return joined.with_motion(joined.rotations[:frames], joined.translations[:frames])


def best_of(action: Callable[[], object], times: int) -> float:
    """Shortest time of some runs after one to warm up, seconds; a single run is not warmed up."""
    if times > 1:
        action()
    taken = []
    for _ in range(times):
        started = time.perf_counter()
        action()
        taken.append(time.perf_counter() - started)
    return min(taken)
