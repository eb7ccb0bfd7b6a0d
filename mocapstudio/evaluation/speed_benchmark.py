"""How long the parts of an analysis take, warm and in process."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Generator, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.mean_texture import departure, mean_texture
from mocapstudio.evaluation import read_benchmark
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
    seconds, cpu
        Best of the repetitions, warm: by the clock, and of all processors together, which other
        programs on the machine disturb less.
    reach
        Seconds to be reached, or NaN.
    paper
        Seconds that the paper states, or NaN.
    series, size
        Measurements of one series tell how cost grows with `size` seconds of motion.
    """

    name: str
    seconds: float
    cpu: float
    reach: float = math.nan
    paper: float = math.nan
    series: str = ""
    size: float = math.nan

    def to_json(self) -> dict[str, Any]:
        """Plain objects for JSON."""
        return asdict(self)


@dataclass(frozen=True)
class _Work:
    """What is to be measured: a row without its times."""

    name: str
    action: Callable[[], object]
    times: int = 2
    reach: float = math.nan
    paper: float = math.nan
    series: str = ""
    size: float = math.nan

    def measured(self) -> SpeedRow:
        seconds, cpu = best_of(self.action, self.times)
        return SpeedRow(self.name, seconds, cpu, self.reach, self.paper, self.series, self.size)


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
    against = f"20 s against {_CONTEXT_TAKES} takes of 15 s, whole analysis"
    work = [
        _Work("20 s against itself, texture to map", lambda: to_map(source, ()), 5, 0.05, 140.0),
        _Work("20 s against itself, whole analysis", lambda: run(detect(source)), 3),
        _Work(against, lambda: run(detect(source, context)), 2, 0.2),
        *(_growth_of_source(takes, context, s) for s in (10, 20, 40, 80)),
        *(_growth_of_context(source, context, n) for n in (5, 10, 20, 30)),
    ]
    if long:
        whole = lasting(takes, 600.0)
        work.append(_Work("600 s against itself, exact", lambda: to_map(whole, ()), 1, 5.0))
    rows: list[SpeedRow] = []
    with read_benchmark.large_bvh() as large:
        work += _reading(large)
        for i, one in enumerate(work):
            yield Progress(i / len(work), one.name)
            rows.append(one.measured())
    return rows


def growth(rows: Sequence[SpeedRow]) -> dict[str, float]:
    """Exponent with which cost grows in each series: 1 is linear."""
    found: dict[str, float] = {}
    for series in dict.fromkeys(row.series for row in rows if row.series):
        mine = [row for row in rows if row.series == series]
        size, cost = np.log([row.size for row in mine]), np.log([row.cpu for row in mine])
        found[series] = float(np.polyfit(size, cost, 1)[0])
    return found


def _growth_of_source(takes: Sequence[Take], context: Sequence[Take], seconds: int) -> _Work:
    longer = lasting(takes, float(seconds))
    name = f"{seconds} s against 10 takes of 15 s"
    return _Work(name, lambda: to_map(longer, context[:10]), series="source", size=seconds)


def _growth_of_context(source: Take, context: Sequence[Take], count: int) -> _Work:
    name = f"20 s against {count} takes of 15 s"
    size = _SOURCE_SECONDS + count * _CONTEXT_SECONDS
    return _Work(name, lambda: to_map(source, context[:count]), series="context", size=size)


def _reading(path: Path) -> list[_Work]:
    """Our reader first, then the peers; those that are not installed are named without a time."""
    size = f"{path.stat().st_size / 1e6:.0f} MB BVH to arrays"
    work = [_Work(f"read a {size}", lambda: read_benchmark.ours(path), 3, 0.2)]
    there = read_benchmark.installed()
    for name in read_benchmark.PEERS:
        if name in there:
            peer = there[name]
            work.append(_Work(f"the same by {name}", partial(peer, path), 1))
        else:
            work.append(_Work(f"the same by {name}: not installed (extra 'peers')", _nothing, 0))
    return work


def _nothing() -> None:
    """Stand in for a library that is not there."""


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


def best_of(action: Callable[[], object], times: int) -> tuple[float, float]:
    """Shortest clock time and processor time of some runs, seconds, after one to warm up.

    A single run is not warmed up; none at all takes no time that could be told.
    """
    if times == 0:
        return math.nan, math.nan
    if times > 1:
        action()
    clock, cpu = [], []
    for _ in range(times):
        started, processor = time.perf_counter(), time.process_time()
        action()
        clock.append(time.perf_counter() - started)
        cpu.append(time.process_time() - processor)
    return min(clock), min(cpu)
