"""The solids that figures are made of: spheres and lathed bones, as corners and triangles."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]
Indices = NDArray[np.int64]

# Lathe profiles: place along the bone, and share of its greatest radius there.
BONE = np.array(
    [[0.0, 0.45], [0.07, 0.85], [0.18, 1.0], [0.55, 0.8], [0.92, 0.58], [1.0, 0.4]], np.float32
)
SKULL = np.array(
    [[-0.1, 0.0], [0.02, 0.6], [0.3, 0.96], [0.68, 1.0], [1.0, 0.62], [1.12, 0.0]], np.float32
)
RINGS = len(BONE)


@dataclass(frozen=True)
class Detail:
    """How finely a figure is cut: sides of a bone and subdivisions of a joint's sphere."""

    sides: int
    sphere: int


FINE, COARSE = Detail(12, 2), Detail(6, 1)


def triangles(balls: int, bones: int, detail: Detail) -> Indices:
    """(T, 3) corners of so many spheres, then so many bones, corners counted in that order."""
    ball, faces = sphere(detail.sphere)
    spheres = (faces + len(ball) * np.arange(balls)[:, None, None]).reshape(-1, 3)
    sides = detail.sides
    here = np.arange(sides)
    there = (here + 1) % sides
    strip = np.concatenate(
        [
            np.stack([here, there, here + sides], axis=1),
            np.stack([there, there + sides, here + sides], axis=1),
        ]
    )
    lathe = np.concatenate([strip + ring * sides for ring in range(RINGS - 1)])
    first = balls * len(ball) + RINGS * sides * np.arange(bones)[:, None, None]
    return np.concatenate([spheres, (lathe + first).reshape(-1, 3)])


@lru_cache(maxsize=8)
def circle(sides: int) -> tuple[Floats, Floats]:
    """Cosine and sine of the directions round a bone."""
    turn = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    return np.cos(turn).astype(np.float32), np.sin(turn).astype(np.float32)


@lru_cache(maxsize=8)
def sphere(rings: int) -> tuple[Floats, Indices]:
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
