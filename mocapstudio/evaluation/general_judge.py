"""Learns the general judge that the program ships, from generated and public motion.

Contexts of three to twenty-two takes, and takes alone, are drawn from the demo performer and from
takes of the CMU database that any use is allowed of; errors are put into them as into a user's own
context. The benchmark's own corpora (Bandai Namco's motions, the salsa pairs) are left out.
``python -m mocapstudio.evaluation.general_judge DATA resources/judges/general.npz`` learns it anew.
"""

from __future__ import annotations

import sys
from collections.abc import Generator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from mocapstudio import formats
from mocapstudio.cleaning.decision.examples import TooLittleToLearnError, examples_of
from mocapstudio.cleaning.decision.general import save_judge
from mocapstudio.cleaning.decision.growing import Rows, Size, grow
from mocapstudio.cleaning.decision.model import Judge
from mocapstudio.evaluation.demo.take import demo_take
from mocapstudio.motion.progress import Progress, run
from mocapstudio.motion.take import Take

F32 = NDArray[np.float32]
Group = Sequence[Take]

FOLDERS = ("cmu_locomotion_bvh", "cmu_dance_bvh", "cmu_asfamc")
_SEVERAL, _ALONE = (3, 5, 8, 14, 22), (1,)
_SECONDS, _SECONDS_ALONE = (4.0, 6.0, 10.0, 15.0), (15.0, 25.0, 40.0)
_DEMO_SEEDS = range(40, 54)
_PIECE = 12.0
_FRAMES_WANTED = 8000
# Shares of right rows that are kept: there are more than enough.
_RIGHT, _RIGHT_ROOT = 0.12, 0.5
_NEGATIVES = 400_000
_JOINTS, _ROOT = Size(200, 31, 0.1, 60), Size(100, 16, 0.1, 60)


@dataclass
class _Collected:
    """Rows of joints and of root rows, so far."""

    joints: list[tuple[F32, NDArray[np.int8]]] = field(default_factory=list)
    root: list[tuple[F32, NDArray[np.int8]]] = field(default_factory=list)


def learn_general(data: Path, seed: int = 0) -> Generator[Progress, None, Judge]:
    """Learn the general judge.

    Parameters
    ----------
    data
        Folder that holds FOLDERS.
    seed
        Of contexts and errors.

    Raises
    ------
    FileError
        If a take cannot be read.
    """
    rng = np.random.default_rng(seed)
    public = _public(data)
    demo: list[Group] = [[demo_take(one) for one in _DEMO_SEEDS]]
    plan = [(public, _SEVERAL, 20), (demo, _SEVERAL, 14), (demo, _ALONE, 14), (public, _ALONE, 30)]
    rounds = sum(times for _, _, times in plan)
    collected, done = _Collected(), 0
    for groups, sizes, times in plan:
        for n in range(times):
            yield Progress(0.9 * done / rounds, "putting errors into contexts")
            _collect(groups[n % len(groups)], sizes, rng, collected)
            done += 1
    yield Progress(0.9, "growing trees")
    joints = grow(Rows.of(collected.joints), rng, _JOINTS, _NEGATIVES)
    root = grow(Rows.of(collected.root), rng, _ROOT, _NEGATIVES)
    # What was not kept of the right rows is put back into the odds.
    return Judge(
        replace(joints, base=joints.base + float(np.log(_RIGHT))),
        replace(root, base=root.base + float(np.log(_RIGHT_ROOT))),
    )


def _public(data: Path) -> list[Group]:
    """Takes of one skeleton each; long ones in pieces of twelve seconds."""
    groups: dict[tuple[str, ...], list[Take]] = {}
    for path in formats.find_takes([data / folder for folder in FOLDERS]):
        for take in formats.read(path)[0]:
            sizes = tuple(f"{one:.4f}" for one in take.skeleton.offsets[:, 1])
            alike = take.skeleton.names if path.suffix == ".bvh" else (*sizes, "amc")
            groups.setdefault(alike, []).extend(_pieces(take))
    return [group for group in groups.values() if len(group) >= min(_SEVERAL)]


def _pieces(take: Take) -> list[Take]:
    length = int(_PIECE * take.rate)
    if take.frames < 2 * length:
        return [take]
    return [_part(take, first, length) for first in range(0, take.frames - length // 2, length)]


def _part(take: Take, first: int, length: int) -> Take:
    span = slice(first, first + length)
    return replace(take, rotations=take.rotations[span], translations=take.translations[span],
                  trim=None)  # fmt: skip


def _collect(
    group: Group, sizes: Sequence[int], rng: np.random.Generator, into: _Collected
) -> None:
    """Draw a context of a group and add what can be learnt from it."""
    count = min(int(rng.choice(sizes)), len(group))
    seconds = _SECONDS if count > 1 else _SECONDS_ALONE
    drawn = [group[i] for i in rng.permutation(len(group))[:count]]
    context = [_cut(take, float(rng.choice(seconds)), rng) for take in drawn]
    making = examples_of(context, None, rng, _FRAMES_WANTED)
    try:
        while True:
            next(making)
    except StopIteration as stop:
        made = stop.value
    except TooLittleToLearnError:
        return
    for one in made.examples:
        for rows, labels, share, to in (
            (one.seen.joints, one.labels[:, :-2], _RIGHT, into.joints),
            (one.seen.root, one.labels[:, -2:], _RIGHT_ROOT, into.root),
        ):
            kept = (labels == 1) | ((labels == 0) & (rng.random(labels.shape) < share))
            to.append((rows[kept], labels[kept]))


def _cut(take: Take, seconds: float, rng: np.random.Generator) -> Take:
    length = int(seconds * take.rate)
    if take.frames <= length:
        return take
    return _part(take, int(rng.integers(0, take.frames - length)), length)


if __name__ == "__main__":
    save_judge(run(learn_general(Path(sys.argv[1]))), Path(sys.argv[2]))
