"""How well foot skate is removed: slide, gaps, and what it costs the rest of the motion."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.anatomy import extremities
from mocapstudio.cleaning.contacts.detection import detect_contacts
from mocapstudio.cleaning.contacts.model import Contact, ContactPoint
from mocapstudio.cleaning.contacts.points import contact_points
from mocapstudio.cleaning.contacts.slide import measure_slide
from mocapstudio.cleaning.ik import foot_skate
from mocapstudio.cleaning.ik.targets import holds
from mocapstudio.evaluation.contacts_two_bone import two_bone
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]
Cleaner = Callable[[Take, Sequence[Contact], Sequence[ContactPoint]], Take]

_EDGE_SECONDS = 1 / 30


@dataclass(frozen=True)
class SlideRow:
    """What one method did to one take.

    Parameters
    ----------
    method, take
        Their names.
    slide
        Millimetres a frame at 120 fps, mean in contact.
    worst_step
        Millimetres: the same of the worst single frame.
    gap
        Millimetres: the largest distance of a point from its place.
    jerk
        Jerk of knees and ankles near contact edges over that of the whole take as it was, both
        the 99th percentile.
    jerk_before
        The same of the take as it was.
    turned
        Degrees: mean change of the joints of legs over all frames.
    others
        Degrees: mean change of all other joints.
    bones
        Millimetres: the largest change of a bone's length.
    moved
        Millimetres: largest displacement of the root, or of what carries the body.
    seconds
        Time taken.
    contacts, duration
        How many contacts, and seconds of the take.
    """

    method: str
    take: str
    slide: float
    worst_step: float
    gap: float
    jerk: float
    jerk_before: float
    turned: float
    others: float
    bones: float
    moved: float
    seconds: float
    contacts: int
    duration: float

    def to_json(self) -> dict[str, Any]:
        """Plain objects for JSON."""
        return asdict(self)


def cleaners() -> dict[str, Cleaner]:
    """Return the methods by name: none, ours, and the peer."""
    return {
        "untouched": lambda take, contacts, points: take,
        "two-bone IK, frame by frame": two_bone,
        "ours": lambda take, contacts, points: run(foot_skate.clean(take, contacts, points)).take,
    }


def measure(take: Take) -> list[SlideRow]:
    """Detect the contacts of a take, and hold them by every method."""
    points = contact_points(take)
    contacts = detect_contacts(take, points=points)
    rows = []
    for name, cleaner in cleaners().items():
        started = time.perf_counter()
        cleaned = cleaner(take, contacts, points)
        seconds = time.perf_counter() - started
        rows.append(_row(name, take, cleaned, contacts, points, seconds))
    return rows


def _row(
    name: str,
    take: Take,
    cleaned: Take,
    contacts: Sequence[Contact],
    points: Sequence[ContactPoint],
    seconds: float,
) -> SlideRow:
    laid = holds(take, contacts, points, {})
    slid = measure_slide(cleaned, contacts, points, laid=laid)
    angle = np.degrees(rot.angle(take.rotations, cleaned.rotations))
    moved = np.linalg.norm(cleaned.translations - take.translations, axis=2)
    legs = _in_legs(take)
    return SlideRow(
        name,
        take.name,
        1e3 * slid.mean / 120,
        1e3 * max((one.worst for one in slid.contacts), default=0.0) / 120,
        1e3 * max((one.gap for one in slid.contacts), default=0.0),
        _edge_jerk(take, cleaned, contacts),
        _edge_jerk(take, take, contacts),
        _mean(angle[:, legs]),
        _mean(angle[:, ~legs]),
        1e3 * _stretched(take, cleaned),
        1e3 * float(moved.max()),
        seconds,
        len(contacts),
        take.duration,
    )


def _in_legs(take: Take) -> NDArray[np.bool_]:
    """(J,) True for joints of legs."""
    limbs = [limb for limb in topology(take.skeleton).limbs if "leg" in limb.name]
    found = np.zeros(len(take.skeleton), dtype=bool)
    found[[joint for limb in limbs for joint in limb.joints]] = True
    return found


def _mean(angles: Array) -> float:
    return float(angles.mean()) if angles.size else 0.0


def _stretched(take: Take, cleaned: Take) -> float:
    """Metres: the largest change of a joint's distance from its parent; the root has none."""
    child = np.flatnonzero(take.skeleton.parents >= 0)
    parent = take.skeleton.parents[child]
    before, after = (
        np.linalg.norm(p[:, child] - p[:, parent], axis=2)
        for p in (take_pose(take)[0], take_pose(cleaned)[0])
    )
    moves = np.isin(child, take.translated)
    return float(np.abs(after - before)[:, ~moves].max(initial=0.0))


def _edge_jerk(take: Take, cleaned: Take, contacts: Sequence[Contact]) -> float:
    """Jerk near the edges of contacts against the take's own, 99th percentiles."""
    joints = [
        joint
        for foot in extremities(take.skeleton, "leg")
        for joint in (foot.joint, int(take.skeleton.parents[foot.joint]))
    ]
    low, high = take.span
    if high - low < 5 or not joints:
        return float("nan")
    before, after = (_jerk(one, joints)[low : high - 3] for one in (take, cleaned))
    near = np.zeros(len(before), dtype=bool)
    reach = max(1, round(_EDGE_SECONDS * float(take.rate)))
    for contact in contacts:
        for edge in (contact.start - low, contact.end - low):
            if 0 < edge < high - low:
                near[max(0, edge - reach - 2) : edge + reach] = True
    if not near.any():
        return float("nan")
    own = float(np.percentile(before, 99))
    return float(np.percentile(after[near], 99)) / own if own > 0 else float("nan")


def _jerk(take: Take, joints: Sequence[int]) -> Array:
    """(F - 3, J) metres a second cubed."""
    places = take_pose(take)[0][:, list(joints)]
    return np.asarray(np.linalg.norm(np.diff(places, 3, axis=0), axis=2)) * float(take.rate) ** 3
