"""Lends a row of a splitter more height for a while."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtWidgets import QSplitter


class Rooms:
    """Makes rows higher at the cost of the first one, and gives the height back.

    What the user drags in the meantime stays as dragged.

    Parameters
    ----------
    rows
        A vertical splitter.
    """

    def __init__(self, rows: QSplitter) -> None:
        self._rows = rows
        self._lent: dict[int, int] = {}

    def hold(self, shares: Mapping[int, float]) -> None:
        """Let rows have at least a share of the whole height; 0 gives back what was lent."""
        sizes = self._rows.sizes()
        before = list(sizes)
        for row, share in shares.items():
            if share and row not in self._lent and sizes[row]:
                self._lent[row] = max(round(share * sum(sizes)) - sizes[row], 0)
                sizes[row] += self._lent[row]
                sizes[0] -= self._lent[row]
            elif not share and row in self._lent:
                back = min(self._lent.pop(row), sizes[row])
                sizes[row] -= back
                sizes[0] += back
        if sizes != before:
            self._rows.setSizes(sizes)
