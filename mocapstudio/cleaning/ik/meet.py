"""One contact met by its own limb: what a target that was dragged becomes.

The frame at which it was dragged looks afterwards as it did under the hand (`drag.Drag`); from
there the limb departs as little and as smoothly from the motion as the contact allows.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass

from mocapstudio.cleaning.contacts.model import Contact, ContactPoint
from mocapstudio.cleaning.ik import windows
from mocapstudio.cleaning.ik.apply import Departure, declared_changes, with_departures
from mocapstudio.cleaning.ik.drag import KeptFrame
from mocapstudio.cleaning.ik.foot_skate import SkateParameters, Unreached, unreached
from mocapstudio.cleaning.ik.objectives.key_pose import KeyPose
from mocapstudio.cleaning.ik.ranges import JointRanges, joint_ranges
from mocapstudio.cleaning.ik.solve import Problem, solve
from mocapstudio.cleaning.ik.targets import Hold, holds
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.take import Take

_KEY = 1e3
"""Per unit of departure: the dragged frame stays as it looked, unless the contact forbids it."""


@dataclass(frozen=True, eq=False)
class Met:
    """A take in which one contact is met.

    Attributes
    ----------
    take
        The take with its limb bent.
    declared
        Joints × spans that changed.
    unreached
        The contact, where its target could not be met; or nothing.
    """

    take: Take
    declared: tuple[Declared, ...]
    unreached: tuple[Unreached, ...]


def meet(
    take: Take,
    contact: Contact,
    points: Sequence[ContactPoint],
    *,
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
    (hold,) = holds(take, [contact], points, others or {})
    ((start, end),) = windows.cut(take, [hold], SkateParameters().easing)
    yield Progress(0.1, "solving")
    departure = bend(take, [hold], (start, end), ranges, kept)
    bent = with_departures(take, [departure])
    yield Progress(1.0, "measuring")
    return Met(bent, declared_changes(take, [departure]), tuple(unreached(bent, [hold])))


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
        if kept is not None and span[0] <= kept.frame < span[1]:
            key = KeyPose(kept.frame - span[0], kept.departure, _KEY)
            wishes = [*wanted.objectives, key]
            wanted = Problem(wanted.window, wanted.freedom, wishes, wanted.over_time)
        found = solve(wanted, unknowns, tolerance=windows.TOLERANCE, smallest=windows.SMALLEST)
        unknowns = found.unknowns
    return Departure(span, wanted, found.unknowns)
