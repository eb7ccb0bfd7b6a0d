"""Departures put into a take, and declared."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.ik.solve import Problem
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.facing import ROOT_POSITION, carrier
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]

_NOTHING = 1e-7
"""Metres or radians: smaller departures are left out, and the sample stays as it was."""


@dataclass(frozen=True, eq=False)
class Departure:
    """How the body departs from the motion as it was, over one span.

    Attributes
    ----------
    span
        Half-open span of the take's frames.
    problem
        What was solved: its freedom says what the unknowns mean.
    unknowns
        (F, n), see `Freedom`.
    """

    span: tuple[int, int]
    problem: Problem
    unknowns: Array

    def turns(self) -> dict[int, Array]:
        """(F, 3) rotation vectors in the joint's frame, by joint."""
        free = self.problem.freedom
        return {
            j: self.unknowns[:, free.columns(j)] @ free.axes[i].T for i, j in enumerate(free.joints)
        }

    def angles(self) -> dict[int, Array]:
        """(F,) radians, by joint."""
        return {j: np.linalg.norm(turn, axis=1) for j, turn in self.turns().items()}

    @property
    def displacement(self) -> Array:
        """(F, 3) metres by which the body is displaced in the world."""
        return self.problem.freedom.displacement(self.unknowns)

    @property
    def distance(self) -> Array:
        """(F,) metres by which the body is displaced."""
        return np.asarray(np.linalg.norm(self.displacement, axis=1))


def with_departures(take: Take, departures: Iterable[Departure]) -> Take:
    """Return the take with departures applied; samples that do not depart are the same bits."""
    rotations, translations = take.rotations.copy(), take.translations.copy()
    place = carrier(take)
    joint = take.translated[place]
    above = int(take.skeleton.parents[joint])
    for departure in departures:
        start, end = departure.span
        for turning, turn in departure.turns().items():
            at = start + np.flatnonzero(np.abs(turn).max(axis=1) > _NOTHING)
            rotations[at, turning] = rot.multiply(
                take.rotations[at, turning], rot.from_rotation_vector(turn[at - start])
            )
        at = start + np.flatnonzero(departure.distance > _NOTHING)
        if len(at):
            step = departure.displacement[at - start]
            if above >= 0:
                parent = take_pose(take, start, end)[1][at - start, above]
                step = rot.rotate(rot.conjugate(parent), step)
            translations[at, place] += step
    return take.with_motion(rotations, translations)


def declared_changes(take: Take, departures: Sequence[Departure]) -> tuple[Declared, ...]:
    """Rows and the spans in which they really changed, easing included, in order of time."""
    found = []
    for departure in departures:
        amounts = {take.skeleton.names[j]: angle for j, angle in departure.angles().items()}
        for row, amount in {ROOT_POSITION: departure.distance, **amounts}.items():
            at = np.flatnonzero(amount > _NOTHING)
            if len(at):
                start = departure.span[0]
                found.append(Declared(row, start + int(at[0]), start + int(at[-1]) + 1))
    return tuple(found)
