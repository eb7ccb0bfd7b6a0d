"""The body that a skeleton is drawn with: tapered bones and round joints, sized to the performer.

Only numpy here: which triangles there are, and where their corners lie for a pose.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mocapstudio.gui.viewport.solids import RINGS, Detail, Floats, Indices, circle, sphere
from mocapstudio.gui.viewport.world import Points

_UPRIGHT = np.array([0, 1, 0], np.float32)


@dataclass(frozen=True, eq=False)
class Figure:
    """The shape of one skeleton, ready to be put into poses.

    Attributes
    ----------
    joints
        J: points below it are joints, then come the tips, then points of the figure's own:
    middles
        (M, 2) the points between each two of which such a point lies.
    owners
        (M,) the joint whose colour it takes.
    starts, ends
        (B,) points that each drawn bone joins; bones without length are left out.
    balls
        (S,) points that carry a sphere.
    ball_radius
        (S,) metres.
    rings, ring_place
        (B, R) metres and shares of the bone: radius of each ring, and where it is.
    triangles
        (T, 3) corners: first the spheres' (S x V), then the bones' (B x R x sides).
    """

    joints: int
    middles: Indices
    owners: Indices
    starts: Indices
    ends: Indices
    balls: Indices
    ball_radius: Floats
    rings: Floats
    ring_place: Floats
    triangles: Indices
    detail: Detail

    @property
    def corners(self) -> int:
        """How many vertices the figure has."""
        ball, _ = sphere(self.detail.sphere)
        return len(self.balls) * len(ball) + len(self.starts) * RINGS * self.detail.sides

    def places(self, points: Points) -> Points:
        """(J + E + M, 3): a pose's points and the figure's own."""
        return np.concatenate([points, points[self.middles].mean(axis=1)])

    def colour(self, colours: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """(corners, 3): spread one colour a point; a bone runs from its start's to its end's."""
        ball, _ = sphere(self.detail.sphere)
        colours = np.concatenate([colours, colours[self.owners]])
        balls = np.repeat(colours[self.balls], len(ball), axis=0)
        share = np.clip(self.ring_place, 0, 1)[:, :, None] ** 2
        mixed = colours[self.starts][:, None] * (1 - share) + colours[self.ends][:, None] * share
        bones = np.repeat(mixed.reshape(-1, 3), self.detail.sides, axis=0)
        return np.concatenate([balls, bones.astype(np.uint8)])

    def pose(
        self, points: Points, girth: float = 1.0, swell: Floats | None = None
    ) -> tuple[Floats, Floats]:
        """Put the figure into a pose.

        Parameters
        ----------
        points
            (J + E, 3) metres.
        girth
            Thickness of everything, as a share of the performer's own.
        swell
            (J + E,) a further share for each point's sphere, 0 for none; and a bone shrinks to
            nothing with both its ends. None for 1 everywhere.

        Returns
        -------
        corners, normals
            (corners, 3) metres, and unit vectors.
        """
        ball, _ = sphere(self.detail.sphere)
        shares = np.full(len(points), girth, np.float32) if swell is None else girth * swell
        points = self.places(points)
        shares = np.concatenate([shares, shares[self.middles].max(axis=1)])
        radius = self.ball_radius * shares[self.balls]
        balls = points[self.balls][:, None] + radius[:, None, None] * ball
        thick: Floats = np.minimum(girth, np.maximum(shares[self.starts], shares[self.ends]))
        bones, normals = self._lathe(points, thick[:, None])
        ball_normals = np.broadcast_to(ball, balls.shape)
        return (
            np.concatenate([balls.reshape(-1, 3), bones]),
            np.concatenate([ball_normals.reshape(-1, 3), normals]),
        )

    @cached_property
    def _slope(self) -> Floats:
        """(B, R): how fast a bone's radius grows along it, were the bone one metre long."""
        steps = np.gradient(self.ring_place, axis=1)
        slope: Floats = np.gradient(self.rings, axis=1) / steps
        return slope

    def _lathe(self, points: Points, thick: Floats) -> tuple[Floats, Floats]:
        start = points[self.starts]
        along = points[self.ends] - start
        length = np.linalg.norm(along, axis=1, keepdims=True)
        # A bone that has lost its length in this frame still needs a direction.
        axis = np.where(length > 1e-9, along / np.maximum(length, 1e-9), _UPRIGHT)
        # Any direction across will do; the one farthest from the axis is never degenerate.
        across = np.zeros_like(axis)
        across[np.arange(len(axis)), np.abs(axis).argmin(axis=1)] = 1.0
        u = _cross(axis, across)
        u /= np.maximum(np.linalg.norm(u, axis=1, keepdims=True), 1e-9)
        cosine, sine = circle(self.detail.sides)
        round_about = cosine[:, None] * u[:, None] + sine[:, None] * _cross(axis, u)[:, None]
        middle = start[:, None] + self.ring_place[:, :, None] * along[:, None]
        corners = middle[:, :, None] + (self.rings * thick)[:, :, None, None] * round_about[:, None]
        rise = np.clip(self._slope * thick / np.maximum(length, 1e-6), -1.5, 1.5)
        upright = 1.0 / np.sqrt(1.0 + rise**2)
        lean = (-rise * upright)[:, :, None, None] * axis[:, None, None]
        normals = upright[:, :, None, None] * round_about[:, None] + lean
        return corners.reshape(-1, 3), normals.reshape(-1, 3)


def _cross(a: Floats, b: Floats) -> Floats:
    """Cross product of (B, 3), an eighth of `np.cross`'s time."""
    x, y, z = a.T
    u, v, w = b.T
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=1)
