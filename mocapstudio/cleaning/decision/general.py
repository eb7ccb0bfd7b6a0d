"""The general judge: trees learnt from many contexts at once, shipped with the program.

Few takes tell little about what is normal. What errors look like in units of the usual (see
`plausibility`) is the same for all bodies: trees that saw many contexts know it. They were learnt
by `evaluation.general_judge`, which tells from what.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from mocapstudio.cleaning.decision.model import Judge
from mocapstudio.resource_files import resource

_WORTH = 2000.0


@cache
def general_judge() -> Judge:
    """Read the judge that is shipped.

    Raises
    ------
    FileError
        If the installation is incomplete.
    """
    with np.load(resource("judges", "general.npz"), allow_pickle=False) as arrays:
        return Judge.from_arrays(arrays, " ")


def save_judge(judge: Judge, path: Path) -> None:
    """Write a judge as the one that is shipped."""
    arrays: dict[str, Any] = judge.arrays(" ")
    np.savez_compressed(path, **arrays)


def share_of_general(frames: int) -> float:
    """Weight of the general judge beside one learnt from `frames` of context at 24 fps.

    It counts as much as a context of a minute and a half: more where there is less to learn from.
    """
    return _WORTH / (_WORTH + frames)
