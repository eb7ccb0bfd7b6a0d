"""Labelled performances of repeated actions, for the benchmark of online alignment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mocapstudio import formats
from mocapstudio.comparison.labels import Labels, labels_of, read_labels
from mocapstudio.comparison.weights_examples import LabelledTake, repetitions
from mocapstudio.motion.errors import MocapError, NoRateError

_FEWEST = 2


@dataclass(frozen=True, eq=False)
class Action:
    """Performances of one action.

    Parameters
    ----------
    name
        Of the file that labels them.
    performances
        Two at least; weights are learnt from three on.
    """

    name: str
    performances: tuple[LabelledTake, ...]

    def references(self, count: int, seed: int) -> tuple[int, ...]:
        """Choose performances to serve as reference, each in its turn."""
        order = np.random.default_rng(seed).permutation(len(self.performances))
        return tuple(int(i) for i in order[:count])


def actions(data: Sequence[Path], labels: Sequence[Path]) -> list[Action]:
    """Find the labelled takes among the data; one action for each file of labels.

    A take in which the action is repeated gives a performance for each repetition. Files of labels
    without two performances in the data are left out.

    Raises
    ------
    FileError
        If labels cannot be read.
    MocapError
        If no action is left.
    """
    files = formats.find_takes(list(data))
    found = []
    for path in labels:
        known = read_labels(path)
        wanted = [file for file in files if labels_of(file.name, known) is not None]
        performances: list[LabelledTake] = []
        for file in wanted:
            own = labels_of(file.name, known)
            assert own is not None
            performances += repetitions(LabelledTake(read_labelled(file, own), own))
        if len(performances) >= _FEWEST:
            found.append(Action(path.stem, tuple(performances)))
    if not found:
        raise MocapError("no take of the data is among the labelled ones")
    return found


def read_labelled(file: Path, labels: Labels) -> formats.Recording:
    """Read a take, at the rate of its labels where the file tells none.

    Raises
    ------
    FileError
        If it cannot be read.
    """
    try:
        takes, _ = formats.read_any(file)
    except NoRateError:
        takes, _ = formats.read_any(file, formats.ReadOptions(fps=labels.rate))
    return takes[0]
