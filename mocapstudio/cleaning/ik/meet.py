"""One contact met by its own limb: what a target that was dragged becomes.

Other contacts of the same foot that stand with it go along, so that the foot goes as a whole.

The frame at which it was dragged looks afterwards as it did under the hand (`drag.Drag`); from
there the limb departs as little and as smoothly from the motion as the contact allows.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from mocapstudio.cleaning.contacts.model import Contact, ContactPoint, Floor
from mocapstudio.cleaning.ik import windows
from mocapstudio.cleaning.ik.agreement import agreed
from mocapstudio.cleaning.ik.apply import Departure, declared_changes, with_departures
from mocapstudio.cleaning.ik.drag import KeptFrame
from mocapstudio.cleaning.ik.foot_skate import SkateParameters, Unreached, unreached
from mocapstudio.cleaning.ik.objectives.key_pose import KeyPose
from mocapstudio.cleaning.ik.ranges import JointRanges, joint_ranges
from mocapstudio.cleaning.ik.solve import Problem, solve
from mocapstudio.cleaning.ik.targets import Hold, holds, on_floor, standing_place
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.take import Take

_KEY = 1e3
"""Per unit of departure: the dragged frame stays as it looked, unless the contact forbids it."""


@dataclass(frozen=True, eq=False)
class Met:
    """A take in which a contact is met, and what stands with it.

    Attributes
    ----------
    take
        The take with its limb bent.
    declared
        Joints × spans that changed.
    unreached
        Those of the contacts whose target could not be met.
    """

    take: Take
    declared: tuple[Declared, ...]
    unreached: tuple[Unreached, ...]


def meet(
    take: Take,
    contact: Contact,
    points: Sequence[ContactPoint],
    *,
    along: Sequence[Contact] = (),
    others: Mapping[str, Take] | None = None,
    ranges: JointRanges | None = None,
    kept: KeptFrame | None = None,
) -> Generator[Progress, None, Met]:
    """Bend the limb of a contact so that its point is at the target throughout.

    Parameters
    ----------
    take
        F frames.
    contact
        The contact.
    along
        Contacts that overlap it, as they are once they have gone with it (`stance.standing_with`).
    points, others, ranges
        As for `foot_skate.clean`.
    kept
        A frame that was dragged to its place, see `drag.Drag.kept`.

    Raises
    ------
    MocapError
        If the contact names an unknown joint, point or performer, or frames outside the take.
    """
    yield Progress(0.0, "laying out the contact")
    ranges = ranges or joint_ranges([take])
    laid = list(holds(take, [contact, *along], points, others or {}))
    if along:
        laid = list(agreed(take, _gone_along(laid, float(take.rate))))
    spans = windows.cut(take, laid, SkateParameters().easing)
    start, end = spans[0][0], spans[-1][1]
    yield Progress(0.1, "solving")
    departure = bend(take, laid, (start, end), ranges, kept)
    bent = with_departures(take, [departure])
    yield Progress(1.0, "measuring")
    return Met(bent, declared_changes(take, [departure]), tuple(unreached(bent, laid)))


def _gone_along(laid: Sequence[Hold], rate: float) -> list[Hold]:
    """Bring where points were as far as the first of them goes, and floors are stood on there."""
    first = laid[0]
    held = first.projection.T @ first.projection
    step = held @ np.median(first.target - first.place, axis=0)
    gone = [replace(hold, place=hold.place + step) for hold in laid]
    return [
        replace(
            hold,
            target=np.broadcast_to(
                on_floor(hold.contact, standing_place(hold.place, rate)), hold.place.shape
            ),
        )
        if isinstance(hold.contact.target, Floor)
        else hold
        for hold in gone
    ]


def bend(
    take: Take,
    laid: Sequence[Hold],
    span: tuple[int, int],
    ranges: JointRanges,
    kept: KeptFrame | None = None,
) -> Departure:
    """Bend the limbs of contacts within a window; the hips stay.

    Parameters
    ----------
    take
        F frames.
    laid
        Contacts inside the window, as `targets.holds` returns them.
    span
        The window: half-open, with room to ease around the contacts (`windows.cut`).
    ranges
        How far joints turn.
    kept
        As for `meet`.
    """
    easing, unknowns = SkateParameters().easing, None
    for weight in windows.CONTACT_WEIGHTS:
        wanted = windows.problem(take, laid, span, ranges, easing, 0.0, weight)
        fits = kept is not None and len(kept.departure) == wanted.freedom.size
        if kept is not None and fits and span[0] <= kept.frame < span[1]:
            key = KeyPose(kept.frame - span[0], kept.departure, _KEY)
            wishes = [*wanted.objectives, key]
            wanted = Problem(wanted.window, wanted.freedom, wishes, wanted.over_time)
        found = solve(wanted, unknowns, tolerance=windows.TOLERANCE, smallest=windows.SMALLEST)
        unknowns = found.unknowns
    return Departure(span, wanted, found.unknowns)
