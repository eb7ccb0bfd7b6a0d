"""Where a performer touches the floor, a partner or a prop.

The steps: points of the body (`points`), the floor under them (`floor`), speed and height of each
point in units of the leg, a two-state model that learns from the take what rest is (`states`), and
spans with a confidence. Contacts between performers are found in `partners`.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.anatomy import extremities, leg_length
from mocapstudio.cleaning.contacts.floor import fit_floor
from mocapstudio.cleaning.contacts.model import Contact, ContactPoint, Floor, Target
from mocapstudio.cleaning.contacts.partners import held_by
from mocapstudio.cleaning.contacts.points import contact_points, point_positions
from mocapstudio.cleaning.contacts.spans import contact_spans, set_down
from mocapstudio.cleaning.contacts.speeds import one_sided, smoothed
from mocapstudio.cleaning.contacts.states import learnt, log_speed, posterior, usual
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.progress import Progress, run
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]


def detect_contacts(
    take: Take,
    partners: Sequence[Take] | Mapping[str, Take] = (),
    points: Sequence[ContactPoint] | None = None,
    keep: Sequence[Contact] = (),
) -> tuple[Contact, ...]:
    """Do what `detecting` does, at once."""
    return run(detecting(take, partners, points, keep))


def detecting(
    take: Take,
    partners: Sequence[Take] | Mapping[str, Take] = (),
    points: Sequence[ContactPoint] | None = None,
    keep: Sequence[Contact] = (),
) -> Generator[Progress, None, tuple[Contact, ...]]:
    """Find what the points of a body touch.

    Parameters
    ----------
    take
        F frames; those outside its trim are left out.
    partners
        Takes of other performers and props in the same space and time, by id, or to be known by
        their names.
    points
        Of this performer; by default `contact_points(take)`.
    keep
        Contacts there are already: those that a person drew stay as they are, and nothing is
        found over them; the others give way.

    Returns
    -------
    tuple of Contact
        In order of their start. Feet and hands on the floor have a `Floor` at the height at which
        they rest; hands that stay with a partner have a `Following`.

    Raises
    ------
    MocapError
        If a point's joint is not in the take.
    """
    yield Progress(0.0, "points of the body")
    pose = take_pose(take)
    chosen = tuple(contact_points(take, pose) if points is None else points)
    positions = point_positions(take, chosen, pose)
    yield Progress(0.3, "floor")
    on_floor = _on_floor(take, chosen, positions, pose[0])
    yield Progress(0.8, "spans")
    drawn = tuple(contact for contact in keep if contact.drawn)
    found = []
    rate, leg = float(take.rate), leg_length(take.skeleton)
    for column, point in enumerate(chosen):
        sure, place = on_floor.probability[:, column], positions[:, column]
        taken = [(c.start, c.end) for c in drawn if (c.joint, c.point) == point.key]
        for span in contact_spans(sure, rate, take.span, taken):
            for start, end in set_down(span, place, on_floor.speed[:, column], rate, leg):
                target = Floor(float(np.median(place[start:end, 1])), on_floor.normal)
                found.append(_contact(point, start, end, target, float(sure[start:end].mean())))
    others = partners if isinstance(partners, Mapping) else {one.name: one for one in partners}
    if others:
        yield Progress(0.9, "hands of partners")
        for held in held_by(take, chosen, positions, others):
            point = chosen[held.point]
            own = [c for c in drawn if (c.joint, c.point) == point.key]
            if not any(c.start < held.end and held.start < c.end for c in own):
                found.append(_contact(point, held.start, held.end, held.target, held.confidence))
    return _in_order(drawn, found)


@dataclass(frozen=True, eq=False)
class _OnFloor:
    """(F, P) probability that each point rests on the floor, and its speed in legs a second."""

    probability: Array
    speed: Array
    normal: tuple[float, float, float] = (0.0, 1.0, 0.0)


def _on_floor(
    take: Take, points: Sequence[ContactPoint], positions: Array, joints: Array
) -> _OnFloor:
    rate, leg = float(take.rate), leg_length(take.skeleton)
    parts = topology(take.skeleton)
    hands = {take.skeleton.names[hand.joint] for hand in extremities(take.skeleton, "arm")}
    feet = [i for i, point in enumerate(points) if point.joint not in hands]
    limbs = [parts.limbs.index(parts.limb_of(take.skeleton.index[points[i].joint])) for i in feet]
    velocity = one_sided(smoothed(positions, rate), rate)
    speed = np.linalg.norm(velocity, axis=2) / leg
    result = np.zeros(positions.shape[:2])
    if not feet:
        return _OnFloor(result, speed)
    floor = fit_floor(positions[:, feet], rate, leg, joints[:, parts.hips], limbs)
    height = (positions[:, feet, 1] - floor.under) / leg
    for kind in {points[i].point for i in feet}:
        mine = [i for i, f in enumerate(feet) if points[f].point == kind]
        columns = [feet[i] for i in mine]
        model = learnt(usual(kind), speed[:, columns], height[:, mine], rate)
        odds = model.log_odds(log_speed(speed[:, columns]), height[:, mine])
        result[:, columns] = posterior(odds, rate)
    x, y, z = floor.normal
    return _OnFloor(result, speed, (float(x), float(y), float(z)))


def _contact(
    point: ContactPoint, start: int, end: int, target: Target, confidence: float
) -> Contact:
    name = f"{point.joint}-{point.point or 'end'}-{start}"
    return Contact(name, point.joint, point.point, start, end, target, confidence)


def _in_order(drawn: Sequence[Contact], found: Sequence[Contact]) -> tuple[Contact, ...]:
    """Drawn and found contacts by their start; a found one never bears a drawn one's id."""
    ids = {contact.id for contact in drawn}
    renamed = [replace(c, id=f"{c.id}-found") if c.id in ids else c for c in found]
    return tuple(sorted((*drawn, *renamed), key=lambda c: (c.start, c.joint, c.point or "")))
