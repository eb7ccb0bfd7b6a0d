"""Comparisons as tables on the terminal."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from rich.console import Console
from rich.table import Table

from mocapstudio.comparison.model import Comparison
from mocapstudio.comparison.segments import CarriedSegment

_WIDTH = 140

Compared = tuple[Comparison, Sequence[CarriedSegment]]


def show(done: Sequence[Compared]) -> None:
    """Print a ranking, most alike first, and the segments of each source."""
    console = Console()
    if not console.is_terminal:
        console = Console(width=_WIDTH)
    ranking = sorted(done, key=lambda one: one[0].dissimilarity)
    if not ranking:
        return
    console.print(_summary([one for one, _ in ranking]))
    for comparison, carried in ranking:
        if carried:
            console.print()
            console.print(_segments(comparison, carried))


def _table(title: str, head: Sequence[str]) -> Table:
    table = Table(title=title, title_justify="left", box=None, pad_edge=False)
    for i, name in enumerate(head):
        table.add_column(name, justify="left" if i == 0 else "right")
    return table


def _summary(ranking: Sequence[Comparison]) -> Table:
    head = (
        "source", "seconds", "tempo", "dissimilarity", "misaligned", "largest",
        "on time", "hastened", "delayed", "doubt",
    )  # fmt: skip
    table = _table(f"Compared with {ranking[0].reference}", head)
    for one in ranking:
        seconds = len(one.warp) / float(one.source_rate)
        reference = len(one.reference_poses) / float(one.reference_rate)
        gap = np.abs(one.misalignment if one.true_speed else one.misalignment_relative)
        shares = (np.mean(one.timing == sign) for sign in (0, 1, -1))
        table.add_row(
            one.source,
            f"{seconds:.1f}",
            f"{reference / seconds:.2f} ×",
            f"{one.dissimilarity:.3f}",
            f"{gap.mean():.2f} s",
            f"{gap.max():.2f} s",
            *(f"{share:.0%}" for share in shares),
            f"{one.doubt:.0%}",
        )
    return table


def _segments(comparison: Comparison, carried: Sequence[CarriedSegment]) -> Table:
    head = ("segment", "at", "in the source", "delay", "relative", "lasts", "tempo", "difference")
    table = _table(f"{comparison.source}: segments", head)
    rates = float(comparison.reference_rate), float(comparison.source_rate)
    for one in carried:
        table.add_row(
            one.reference.name,
            f"{one.reference.start / rates[0]:.2f} s",
            f"{one.source.start / rates[1]:.2f} s",
            f"{one.delay:+.2f} s",
            f"{one.delay_relative:+.2f} s",
            f"{one.source_duration:.2f} s",
            f"{one.reference_duration / one.source_duration:.2f} ×",
            f"{one.pose_difference:.3f}",
        )
    return table
