"""How gaps of markers can be filled, and the samples that come of it."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass

from mocapstudio.motion.completion import (
    complete,
    fill_along_bones,
    fill_from_poses,
    fill_rigid,
    fill_spline,
    fill_straight,
)
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.gaps import gaps
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.progress import Progress
from mocapstudio.review.marker_model import Fill


@dataclass(frozen=True)
class FillMethod:
    """One way to fill a gap.

    Parameters
    ----------
    name
        How the code calls it.
    words
        As provenance and menus name it.
    short
        In a word.
    tip
        What it rests on.
    fill
        Completes markers × spans of a take.
    """

    name: str
    words: str
    short: str
    tip: str
    fill: Callable[[MarkerTake, Sequence[Declared] | None], MarkerTake]


METHODS = (
    FillMethod("best", "best available", "Best",
               "What is known best: poses of other frames, then the rigid body, then bones, then a"
               " spline", complete),
    FillMethod("spline", "spline", "Spline",
               "A cubic that keeps place and velocity at both edges; for short gaps", fill_spline),
    FillMethod("rigid", "rigid body", "Rigid",
               "Three or more markers on the same rigid body carry it", fill_rigid),
    FillMethod("bones", "bones", "Bones",
               "Constant bone lengths and interpolated directions", fill_along_bones),
    FillMethod("poses", "poses of other frames", "Other poses",
               "What the rest of the take tells of such poses; for long gaps", fill_from_poses),
    FillMethod("straight", "straight line", "Straight",
               "A straight line between the edges", fill_straight),
)  # fmt: skip
"""The ways there are, the one that suits most gaps first."""


def fill_method(name: str) -> FillMethod:
    """Return the method of a name.

    Raises
    ------
    MocapError
        If there is none.
    """
    for one in METHODS:
        if one.name == name:
            return one
    raise MocapError(f"no method {name!r} of filling gaps: {', '.join(m.name for m in METHODS)}")


def filling(
    take: MarkerTake, method: str, spans: Sequence[Declared] | None = None
) -> Generator[Progress, None, tuple[Fill, ...]]:
    """Fill gaps of a take, and return one fill a gap that the method could fill.

    Parameters
    ----------
    take
        The take with the gaps.
    method
        Name of one of `METHODS`.
    spans
        Only gaps that touch one of these markers and spans, each as a whole; None for all.

    Raises
    ------
    MocapError
        If there is no such method, or a span names no marker of the take.
    """
    how = fill_method(method)
    wanted = gaps(take, spans)
    yield Progress(0.0, f"filling {len(wanted)} gaps")
    whole = [Declared(take.labels[gap.marker], gap.start, gap.end) for gap in wanted]
    done = how.fill(take, whole)
    yield Progress(1.0, "filled")
    return tuple(
        Fill(one.row, one.start, one.end, positions)
        for one, gap in zip(whole, wanted, strict=True)
        if not (done.missing[gap.span, gap.marker]).all()
        for positions in [done.positions[gap.span, gap.marker].copy()]
    )
