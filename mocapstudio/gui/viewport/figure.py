"""The body that a skeleton is drawn with: tapered bones and round joints, sized to the performer.

Only numpy here: which triangles there are, and where their corners lie for a pose.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from mocapstudio.gui.viewport.world import Points
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.topology import topology

Floats = NDArray[np.float32]
Indices = NDArray[np.int64]

# Lathe profile of a bone: place along it, and share of its greatest radius there.
_BONE = np.array(
    [[0.0, 0.45], [0.07, 0.85], [0.18, 1.0], [0.55, 0.8], [0.92, 0.58], [1.0, 0.4]], np.float32
)
_SKULL = np.array(
    [[-0.1, 0.0], [0.02, 0.6], [0.3, 0.96], [0.68, 1.0], [1.0, 0.62], [1.12, 0.0]], np.float32
)
_RINGS = len(_BONE)

# Shares of the body's height.
_THICKEST, _THINNEST, _FINGER, _HEAD = 0.017, 0.0065, 0.0038, 0.046
_ZERO = 1e-4


@dataclass(frozen=True)
class Detail:
    """How finely a figure is cut: sides of a bone and subdivisions of a joint's sphere."""

    sides: int
    sphere: int


FINE, COARSE = Detail(12, 2), Detail(6, 1)


@dataclass(frozen=True, eq=False)
class Figure:
    """The shape of one skeleton, ready to be put into poses.

    Attributes
    ----------
    joints
        J: points below it are joints, then come the tips, then points of the figure's own:
    middles
        (M, 2) the points between each two of which such a point lies.
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
        sphere, _ = _sphere(self.detail.sphere)
        return len(self.balls) * len(sphere) + len(self.starts) * _RINGS * self.detail.sides

    def places(self, points: Points) -> Points:
        """(J + E + M, 3): a pose's points and the figure's own."""
        return np.concatenate([points, points[self.middles].mean(axis=1)])

    def colour(self, colours: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """(corners, 3): spread one colour a point; a bone runs from its start's to its end's."""
        sphere, _ = _sphere(self.detail.sphere)
        colours = np.concatenate([colours, colours[self.middles[:, 0]]])
        balls = np.repeat(colours[self.balls], len(sphere), axis=0)
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
        sphere, _ = _sphere(self.detail.sphere)
        shares = np.full(len(points), girth, np.float32) if swell is None else girth * swell
        points = self.places(points)
        shares = np.concatenate([shares, shares[self.middles].max(axis=1)])
        radius = self.ball_radius * shares[self.balls]
        balls = points[self.balls][:, None] + radius[:, None, None] * sphere
        thick = np.minimum(1.0, np.maximum(shares[self.starts], shares[self.ends]) / girth) * girth
        bones, normals = self._lathe(points, self.rings * thick[:, None])
        ball_normals = np.broadcast_to(sphere, balls.shape)
        return (
            np.concatenate([balls.reshape(-1, 3), bones]),
            np.concatenate([ball_normals.reshape(-1, 3), normals]),
        )

    def _lathe(self, points: Points, rings: Floats) -> tuple[Floats, Floats]:
        start = points[self.starts]
        along = points[self.ends] - start
        length = np.linalg.norm(along, axis=1, keepdims=True)
        axis = along / np.maximum(length, 1e-9)
        # Any direction across will do; the one farthest from the axis is never degenerate.
        across = np.zeros_like(axis)
        across[np.arange(len(axis)), np.abs(axis).argmin(axis=1)] = 1.0
        u = np.cross(axis, across)
        u /= np.maximum(np.linalg.norm(u, axis=1, keepdims=True), 1e-9)
        cosine, sine = _circle(self.detail.sides)
        round_about = cosine[:, None] * u[:, None] + sine[:, None] * np.cross(axis, u)[:, None]
        middle = start[:, None] + self.ring_place[:, :, None] * along[:, None]
        corners = middle[:, :, None] + rings[:, :, None, None] * round_about[:, None]
        rise = np.gradient(rings, axis=1) / np.maximum(
            np.gradient(self.ring_place, axis=1) * length, 1e-6
        )
        tilt = np.clip(rise, -1.5, 1.5)[:, :, None, None] * axis[:, None, None]
        normals = round_about[:, None] - tilt
        normals /= np.linalg.norm(normals, axis=3, keepdims=True)
        return corners.reshape(-1, 3), normals.reshape(-1, 3)


def build_figure(skeleton: Skeleton, points: Points, detail: Detail) -> Figure:
    """Shape a figure for a skeleton.

    Parameters
    ----------
    skeleton
        J joints and E tips.
    points
        (J + E, 3) metres in any pose of the take: bone lengths are read off it, since joints
        with translations of their own may have none in the rest pose.
    detail
        How finely to cut.
    """
    joints = len(skeleton)
    height = stature(skeleton, points)
    above = list(topology(skeleton).above_hips)
    starts = np.concatenate([skeleton.parents[1:], skeleton.end_parents]).astype(np.int64)
    ends = np.arange(1, joints + len(skeleton.end_parents))
    # What only carries the body through the world is none of its bones.
    carried = ~np.isin(starts, above)
    middles, starts, ends = _face(skeleton, starts[carried], ends[carried])
    own = np.concatenate([points, points[middles].mean(axis=1)])
    length = np.linalg.norm(own[ends] - own[starts], axis=1)
    drawn = length > _ZERO * height
    # A joint at its parent's place would only flicker through the parent's sphere.
    hidden = set(ends[~drawn].tolist())
    starts, ends, length = starts[drawn], ends[drawn], length[drawn]
    radius, skull = _bone_radii(skeleton, starts, ends, length, height)
    rings = radius[:, None] * np.where(skull[:, None], _SKULL[:, 1], _BONE[:, 1])
    place = np.where(skull[:, None], _SKULL[:, 0], np.broadcast_to(_BONE[:, 0], rings.shape))
    balls = np.array([p for p in range(len(points)) if p not in hidden.union(above)])
    return Figure(
        joints=joints,
        middles=middles,
        starts=starts,
        ends=ends,
        balls=balls,
        ball_radius=_ball_radii(balls, starts, ends, radius, skull, height).astype(np.float32),
        rings=rings.astype(np.float32),
        ring_place=place.astype(np.float32),
        triangles=_triangles(len(balls), len(starts), detail),
        detail=detail,
    )


def stature(skeleton: Skeleton, points: NDArray[np.floating]) -> float:
    """Metres: about a person's height, whatever the pose, read off the bones' lengths.

    It is four fifths of the longest way along bones from one tip to another, which in a person
    leads from a hand to a foot.
    """
    parents = np.concatenate([skeleton.parents, skeleton.end_parents])
    below = np.zeros(len(parents))
    longest = 0.0
    for point in range(len(parents) - 1, 0, -1):
        parent = int(parents[point])
        reach = below[point] + float(np.linalg.norm(points[point] - points[parent]))
        longest = max(longest, below[parent] + reach)
        below[parent] = max(below[parent], reach)
    return max(0.8 * longest, 1e-3)


def _face(skeleton: Skeleton, starts: Indices, ends: Indices) -> tuple[Indices, Indices, Indices]:
    """Give a head that carries eyes, but no tip, one bone to between them instead of two."""
    parts = topology(skeleton)
    head = next((limb.joints for limb in parts.limbs if limb.name == "head"), ())
    bare = [j for j in head if j not in parts.details and j not in skeleton.end_parents]
    for joint in reversed(bare):
        below = [c for c in skeleton.children[joint] if c in parts.details]
        if len(below) == len(skeleton.children[joint]) >= 2:
            kept = ~np.isin(ends, below)
            middle = len(skeleton) + len(skeleton.end_parents)
            return (
                np.array([below[:2]]),
                np.append(starts[kept], joint),
                np.append(ends[kept], middle),
            )
    return np.zeros((0, 2), dtype=np.int64), starts, ends


def _bone_radii(
    skeleton: Skeleton, starts: Indices, ends: Indices, length: Floats, height: float
) -> tuple[Floats, NDArray[np.bool_]]:
    parts = topology(skeleton)
    fine = np.isin(starts, list(parts.details)) | np.isin(ends, list(parts.details))
    radius = np.clip(0.1 * length, _THINNEST * height, _THICKEST * height)
    radius = np.where(fine, _FINGER * height, radius)
    head = next((limb.joints for limb in parts.limbs if limb.name == "head"), ())
    skull = np.isin(starts, head) & (ends >= len(skeleton)) & ~fine
    # One skull only: of several tips the farthest from the head is its crown.
    skull &= length == length[skull].max(initial=-1.0)
    radius = np.where(skull, np.minimum(_HEAD * height, 0.75 * length), radius)
    return radius.astype(np.float32), skull


def _ball_radii(
    balls: Indices,
    starts: Indices,
    ends: Indices,
    radius: Floats,
    skull: NDArray[np.bool_],
    height: float,
) -> Floats:
    # The widest bone that meets the point decides; a skull is no measure for the neck.
    usual = np.where(skull, _THINNEST * height, radius)
    widest = np.zeros(int(max(balls.max(), ends.max(initial=0))) + 1)
    np.maximum.at(widest, starts, usual * 0.95)
    np.maximum.at(widest, ends, usual * 0.8)
    widest[widest == 0] = _THINNEST * height
    return widest[balls].astype(np.float32)


def _triangles(balls: int, bones: int, detail: Detail) -> Indices:
    sphere, faces = _sphere(detail.sphere)
    spheres = (faces + len(sphere) * np.arange(balls)[:, None, None]).reshape(-1, 3)
    sides = detail.sides
    here = np.arange(sides)
    there = (here + 1) % sides
    strip = np.concatenate(
        [
            np.stack([here, there, here + sides], axis=1),
            np.stack([there, there + sides, here + sides], axis=1),
        ]
    )
    lathe = np.concatenate([strip + ring * sides for ring in range(_RINGS - 1)])
    first = balls * len(sphere) + _RINGS * sides * np.arange(bones)[:, None, None]
    return np.concatenate([spheres, (lathe + first).reshape(-1, 3)])


@lru_cache(maxsize=8)
def _circle(sides: int) -> tuple[Floats, Floats]:
    turn = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    return np.cos(turn).astype(np.float32), np.sin(turn).astype(np.float32)


@lru_cache(maxsize=8)
def _sphere(rings: int) -> tuple[Floats, Indices]:
    """Corners and faces of a unit sphere: an octahedron whose faces are cut `rings` times."""
    corners = np.array(
        [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=float
    )
    faces = np.array(
        [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    )
    for _ in range(rings):
        # Every edge is cut in two, every triangle in four.
        edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]))
        unique, at = np.unique(edges, axis=0, return_inverse=True)
        a, b, c = at.reshape(3, -1) + len(corners)
        corners = np.concatenate([corners, corners[unique].sum(axis=1)])
        corners /= np.linalg.norm(corners, axis=1, keepdims=True)
        p, q, r = faces.T
        faces = np.concatenate(
            [np.stack(t, axis=1) for t in ((p, a, c), (a, q, b), (c, b, r), (a, b, c))]
        )
    return corners.astype(np.float32), faces
