"""Where a performer touches the floor, a partner or a prop.

The steps: points of the body (`points`), the floor under them (`floor`), speed and height of each
point in units of the leg, a two-state model that learns from the take what rest is (`states`), and
spans with a confidence. Contacts between performers are found in `partners`.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from dataclasses import replace
from itertools import chain, count

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.anatomy import carried_by, leg_length
from mocapstudio.cleaning.contacts.model import Contact, ContactPoint, Floor, Target
from mocapstudio.cleaning.contacts.on_floor import OnFloor, on_floor
from mocapstudio.cleaning.contacts.partners import held_by
from mocapstudio.cleaning.contacts.pivots import Standing, held_at_pivots
from mocapstudio.cleaning.contacts.points import contact_points, point_positions
from mocapstudio.cleaning.contacts.spans import contact_spans, set_down
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.progress import Progress, run
from mocapstudio.motion.take import Take

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
    resting = on_floor(take, chosen, positions, pose)
    yield Progress(0.8, "spans")
    drawn = tuple(contact for contact in keep if contact.drawn)
    standing = _standing(take, chosen, positions, resting, drawn)
    found = held_at_pivots(standing, pose[1], float(take.rate))
    others = partners if isinstance(partners, Mapping) else {one.name: one for one in partners}
    if others:
        yield Progress(0.9, "hands of partners")
        for held in held_by(take, chosen, positions, others):
            point = chosen[held.point]
            own = [c for c in drawn if (c.joint, c.point) == point.key]
            if not any(c.start < held.end and held.start < c.end for c in own):
                found.append(_contact(point, held.start, held.end, held.target, held.confidence))
    return _in_order(drawn, found)


def _standing(
    take: Take,
    points: Sequence[ContactPoint],
    positions: Array,
    resting: OnFloor,
    drawn: Sequence[Contact],
) -> list[Standing]:
    """Contacts with the floor, wherever nothing is drawn."""
    x, y, z = (0.0, 1.0, 0.0) if resting.floor is None else resting.floor.normal.tolist()
    rate, leg = float(take.rate), leg_length(take.skeleton)
    feet = carried_by(take.skeleton)
    standing = []
    for column, point in enumerate(points):
        sure, place = resting.probability[:, column], positions[:, column]
        taken = [(c.start, c.end) for c in drawn if (c.joint, c.point) == point.key]
        joint = take.skeleton.index[point.joint]
        for span in contact_spans(sure, rate, take.span, taken):
            for start, end in set_down(span, place, resting.speed[:, column], rate, leg):
                target = Floor(float(np.median(place[start:end, 1])), (x, y, z))
                contact = _contact(point, start, end, target, float(sure[start:end].mean()))
                standing.append(Standing(contact, place, feet.get(joint, joint)))
    return standing


def _contact(
    point: ContactPoint, start: int, end: int, target: Target, confidence: float
) -> Contact:
    name = f"{point.joint}-{point.point or 'end'}-{start}"
    return Contact(name, point.joint, point.point, start, end, target, confidence)


def _in_order(drawn: Sequence[Contact], found: Sequence[Contact]) -> tuple[Contact, ...]:
    """Drawn and found contacts by their start; a found one never bears the id of another."""
    ids = {contact.id for contact in drawn}
    renamed = []
    for contact in found:
        name = next(
            n for n in chain([contact.id], (f"{contact.id}-{i}" for i in count(2))) if n not in ids
        )
        ids.add(name)
        renamed.append(replace(contact, id=name))
    return tuple(sorted((*drawn, *renamed), key=lambda c: (c.start, c.joint, c.point or "")))
