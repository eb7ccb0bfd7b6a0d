"""Foot-skate clean-up: hold every contact at its target, disturb nothing else.

Step by step: lay the contacts out over their frames and choose where floors are stood on
(`targets`); cut the take into windows, each some contacts with room to ease in and out; solve each
window for the least smooth departure from the motion that meets its contacts (`solve`); where a
floor could not be met, choose again where it is stood on.
"""

from __future__ import annotations

from collections.abc import Generator, Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.model import Contact, ContactPoint
from mocapstudio.cleaning.ik import windows
from mocapstudio.cleaning.ik.agreement import agreed
from mocapstudio.cleaning.ik.apply import Departure, declared_changes, with_departures
from mocapstudio.cleaning.ik.priority import reachable
from mocapstudio.cleaning.ik.ranges import JointRanges, joint_ranges
from mocapstudio.cleaning.ik.slide import Slide, places, slide
from mocapstudio.cleaning.ik.solve import Problem, solve
from mocapstudio.cleaning.ik.targets import Hold, chosen_again, holds
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.parameters import bounded
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]

_MET = 1e-3
"""Metres: a target is reached where its point comes this close."""


@dataclass(frozen=True)
class SkateParameters:
    """What a clean-up depends on."""

    easing: float = bounded(
        0.3, "Easing", "s", 0.02, 2.0, "Time before and after a contact over which motion is eased."
    )
    root_reach: float = bounded(
        0.06, "Hips give way", "legs", 0.0, 0.5, "How far the hips may move, in leg lengths."
    )


@dataclass(frozen=True)
class Unreached:
    """A contact whose target could not be met: the nearest pose was taken.

    Attributes
    ----------
    contact
        Its id.
    millimetres
        Largest distance that remains.
    frames
        In how many frames it is more than 1 mm.
    """

    contact: str
    millimetres: float
    frames: int


@dataclass(frozen=True, eq=False)
class SkateResult:
    """What a clean-up did.

    Attributes
    ----------
    take
        The cleaned take.
    declared
        Joints × spans that changed, easing included.
    unreached
        Contacts that were not met.
    slide
        Slide in contact, before and after.
    turned
        Mean change in degrees over the declared frames, by joint.
    moved
        Largest displacement of the hips, metres.
    """

    take: Take
    declared: tuple[Declared, ...]
    unreached: tuple[Unreached, ...]
    slide: Slide
    turned: Mapping[str, float]
    moved: float


def clean(
    take: Take,
    contacts: Sequence[Contact],
    points: Sequence[ContactPoint],
    *,
    others: Mapping[str, Take] | None = None,
    ranges: JointRanges | None = None,
    parameters: SkateParameters | None = None,
) -> Generator[Progress, None, SkateResult]:
    """Remove foot skate, and every other slide of a point in contact.

    Parameters
    ----------
    take
        F frames.
    contacts
        What touches what, when; in any order.
    points
        The performer's contact points.
    others
        Takes of the performers whom targets follow, by id.
    ranges
        How far joints turn, learnt from the context; by default from the take itself.
    parameters
        Easing and how far the hips give way.

    Raises
    ------
    MocapError
        If a contact names an unknown joint, point or performer, or frames outside the take.
    """
    parameters = parameters or SkateParameters()
    yield Progress(0.0, "laying out contacts")
    laid = list(agreed(take, holds(take, contacts, points, others or {})))
    ranges = ranges or joint_ranges([take])
    departures: list[Departure] = []
    cut = windows.cut(take, laid, parameters.easing)
    for number, (start, end) in enumerate(cut):
        yield Progress(number / len(cut), "solving")
        inside = [i for i, h in enumerate(laid) if start <= h.contact.start < end]
        departure, chosen = _solve_window(
            take, [laid[i] for i in inside], (start, end), ranges, parameters
        )
        departures.append(departure)
        for i, hold in zip(inside, chosen, strict=True):
            laid[i] = hold
    cleaned = with_departures(take, departures)
    yield Progress(1.0, "measuring")
    return SkateResult(
        cleaned,
        declared_changes(take, departures),
        tuple(unreached(cleaned, laid)),
        slide(take, cleaned, laid),
        _turned(departures, take),
        max((float(d.distance.max(initial=0.0)) for d in departures), default=0.0),
    )


def _solve_window(
    take: Take,
    inside: Sequence[Hold],
    span: tuple[int, int],
    ranges: JointRanges,
    parameters: SkateParameters,
) -> tuple[Departure, Sequence[Hold]]:
    start: Array | None = None

    def solved(wanted: Sequence[Hold], weight: float) -> tuple[Problem, Array, list[Array]]:
        problem = windows.problem(
            take, wanted, span, ranges, parameters.easing, parameters.root_reach, weight
        )
        found = solve(problem, start, tolerance=windows.TOLERANCE, smallest=windows.SMALLEST)
        posed = problem.posed(found.unknowns)
        places = [posed.point(h.joint, h.offset, h.frames - span[0]) for h in wanted]
        return problem, found.unknowns, places

    low, high = windows.CONTACT_WEIGHTS
    _, start, reached = solved(inside, low)
    inside = [chosen_again(h, place) for h, place in zip(inside, reached, strict=True)]
    inside = agreed(take, inside)
    problem, start, reached = solved(inside, high)
    nearer = reachable(take.skeleton, inside, reached)
    if nearer is not None:
        problem, start, _ = solved(nearer, high)
    return Departure(span, problem, start), inside


def unreached(cleaned: Take, laid: Sequence[Hold]) -> Iterable[Unreached]:
    """Tell which contacts a take does not meet."""
    for hold, place in zip(laid, places(cleaned, laid), strict=True):
        gap = hold.unmet(place)
        if gap.max() > _MET:
            yield Unreached(hold.contact.id, 1e3 * float(gap.max()), int(np.sum(gap > _MET)))


def _turned(departures: Sequence[Departure], take: Take) -> dict[str, float]:
    angles: dict[str, list[Array]] = {}
    for departure in departures:
        for joint, angle in departure.angles().items():
            angles.setdefault(take.skeleton.names[joint], []).append(angle)
    return {name: float(np.degrees(np.concatenate(a).mean())) for name, a in angles.items()}
