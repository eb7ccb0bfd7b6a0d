"""Hands that stay with a partner's hands, or hold a prop.

Two hands are together while they are near each other and move as one: what tells is the speed at
which the way between them changes, whatever the speed of both. A prop is held while the palm stays
in its place as seen from one of the prop's joints.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.anatomy import extremities, leg_length
from mocapstudio.cleaning.contacts.model import ContactPoint, Following
from mocapstudio.cleaning.contacts.points import contact_points, point_positions
from mocapstudio.cleaning.contacts.speeds import one_sided, smoothed
from mocapstudio.cleaning.contacts.states import log_speed, posterior
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.runs import runs
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]

_TOGETHER, _APART, _SPREAD = np.log(0.3), np.log(1.6), 0.8
"""Means and standard deviation of the log speed between hands, legs a second."""
_GRIP = 0.09
"""Legs: palms that hold each other are about this far apart; where skeletons fit badly, farther."""
_MISFIT = 1.5
"""How fast it grows less likely that hands hold each other the farther apart they are."""
_FAR = 0.45
"""Legs: beyond this nothing is held."""
_BESIDE, _IDLE = 0.18, 0.25
"""Legs: hands farther apart than the one that move less than the other hang beside each other."""
_REACH = 2.0
"""Legs: free hands are anywhere up to this far apart."""
_SHORTEST = 0.25
"""Seconds."""


@dataclass(frozen=True)
class Held:
    """A point that stays with something that moves.

    Parameters
    ----------
    point
        Index of the point.
    start, end
        Half-open span of frames.
    target
        What it stays with.
    confidence
        0..1.
    """

    point: int
    start: int
    end: int
    target: Following
    confidence: float


def held_by(
    take: Take,
    points: Sequence[ContactPoint],
    positions: Array,
    others: Mapping[str, Take],
) -> list[Held]:
    """Find what palms hold.

    Parameters
    ----------
    take
        F frames.
    points, positions
        P contact points, and (F, P, 3) metres where they are; palms are looked at.
    others
        Takes of partners and props by id, as long as `take` and at its rate.

    Raises
    ------
    MocapError
        If a take is of another length or rate.
    """
    palms = [i for i, point in enumerate(points) if point.point == "palm"]
    leg = leg_length(take.skeleton)
    found: list[Held] = []
    for name, other in others.items():
        if other.frames != take.frames or other.rate != take.rate:
            raise MocapError(f"{other.name} is not as long as {take.name}, or of another rate")
        if not palms:
            continue
        grips = _grips(other)
        odds = np.stack(
            [
                np.stack([grip.odds(positions[:, palm], float(take.rate), leg) for palm in palms])
                for grip in grips
            ]
        )
        probability = posterior(odds.reshape(-1, take.frames).T, float(take.rate))
        shaped = probability.T.reshape(odds.shape)
        for column, palm in enumerate(palms):
            found += _spans(name, grips, palm, positions[:, palm], shaped[:, column], take)
    return found


@dataclass(frozen=True, eq=False)
class _Grip:
    """Something that may be held: a place (F, 3) in the world, and the joint it moves with."""

    joint: str
    place: Array
    origin: Array
    world: Array
    turns: bool

    def odds(self, palm: Array, rate: float, leg: float) -> Array:
        """(F,) log odds that the palm (F, 3) holds it."""
        way = self.local(palm) if self.turns else palm - self.place
        speed = np.linalg.norm(one_sided(smoothed(way[:, None], rate), rate)[:, 0], axis=1) / leg
        apart = np.linalg.norm(palm - self.place, axis=1) / leg
        x = log_speed(speed)
        slow = 0.5 * (((x - _APART) / _SPREAD) ** 2 - ((x - _TOGETHER) / _SPREAD) ** 2)
        beyond = np.maximum(apart / _GRIP - 1, 0)
        near = np.log(_REACH / _GRIP) - _MISFIT * np.log1p(beyond**2 / 4)
        result: Array = np.where(apart > _FAR, -12.0, np.clip(slow + near, -12.0, 12.0))
        return result

    def beside(self, palm: Array, start: int, end: int, leg: float) -> bool:
        """Tell whether the palm (F, 3) only hangs near it: apart, and neither goes anywhere."""
        apart = np.linalg.norm((palm - self.place)[start:end], axis=1)
        way = max(float(np.linalg.norm(np.ptp(p[start:end], axis=0))) for p in (palm, self.place))
        return bool(np.median(apart) > _BESIDE * leg and way < _IDLE * leg)

    def local(self, palm: Array) -> Array:
        """(F, 3) metres: the palm in the joint's frame."""
        return rot.rotate(rot.conjugate(self.world), palm - self.origin)


def _grips(other: Take) -> list[_Grip]:
    pose = take_pose(other)
    hands = extremities(other.skeleton, "arm")
    if hands:
        palms = [point for point in contact_points(other, pose) if point.point == "palm"]
        places = point_positions(other, palms, pose)
        joints = [other.skeleton.index[palm.joint] for palm in palms]
        return [
            _Grip(palm.joint, places[:, i], pose[0][:, j], pose[1][:, j], turns=False)
            for i, (palm, j) in enumerate(zip(palms, joints, strict=True))
        ]
    return [
        _Grip(name, pose[0][:, j], pose[0][:, j], pose[1][:, j], turns=True)
        for j, name in enumerate(other.skeleton.names)
    ]


def _spans(
    name: str, grips: Sequence[_Grip], palm: int, place: Array, probability: Array, take: Take
) -> list[Held]:
    """Spans of one palm, in each frame with the grip that is likeliest."""
    best = probability.argmax(axis=0)
    fewest = max(1, round(_SHORTEST * float(take.rate)))
    low, high = take.span
    inside = np.zeros(take.frames, dtype=bool)
    inside[low:high] = True
    found = []
    for g, grip in enumerate(grips):
        for start, end in runs((probability[g] > 0.5) & (best == g) & inside):
            if end - start < fewest or grip.beside(place, start, end, leg_length(take.skeleton)):
                continue
            x, y, z = np.median(grip.local(place)[start:end], axis=0)
            target = Following(name, grip.joint, (float(x), float(y), float(z)))
            sure = float(probability[g, start:end].mean())
            found.append(Held(palm, start, end, target, sure))
    return found
