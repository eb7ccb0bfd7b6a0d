"""Which column of the digression map tints which joint."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.model import DigressionMap
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.topology import topology


class JointValues:
    """Reads a digression map joint by joint of a skeleton.

    Parameters
    ----------
    mapped
        The map, R rows.
    skeleton
        J joints; those without a row are 'not analysed'. The hips show the root rows as well.
    """

    def __init__(self, mapped: DigressionMap, skeleton: Skeleton) -> None:
        self._values = mapped.values
        rows = {name: column for column, name in enumerate(mapped.rows)}
        self._columns = np.array([rows.get(name, -1) for name in skeleton.names])
        self._roots = [rows[name] for name in ROOT_ROWS if name in rows]
        self._hips = topology(skeleton).hips

    def at(self, frame: int) -> NDArray[np.float32]:
        """(J,) digression 0..1 at a frame, NaN where a joint is not analysed."""
        row = self._values[min(frame, len(self._values) - 1)]
        values = np.where(self._columns >= 0, row[self._columns], np.nan).astype(np.float32)
        if self._roots:
            values[self._hips] = np.nanmax([values[self._hips], *row[self._roots]])
        return values
