"""A context of any size out of a few takes, each copy performed a little differently."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot
from mocapstudio.similarity.texture import MotionTexture

F64 = NDArray[np.float64]

_PACES = (0.85, 1.2)
_STYLE, _TREMOR = np.radians(3.0), np.radians(0.5)
_TREMOR_FRAMES = 6


def large_context(
    textures: Sequence[MotionTexture], frames: int, seed: int = 0
) -> tuple[MotionTexture, ...]:
    """Textures and variations of them, over and over, until there are so many frames.

    Every copy has a pace of its own (0.85 to 1.2), each joint an offset of its own (3 degrees
    about each axis) and a slow tremor (0.5 degrees).
    """
    rng = np.random.default_rng(seed)
    made, total = list[MotionTexture](), 0
    while total < frames:
        one = textures[len(made) % len(textures)]
        one = one if len(made) < len(textures) else _varied(one, rng)
        made.append(one)
        total += len(one)
    return tuple(made)


def _varied(texture: MotionTexture, rng: np.random.Generator) -> MotionTexture:
    joints = len(texture.joints)
    at = np.arange(0.0, len(texture) - 1, rng.uniform(*_PACES))
    body = rot.normalize(_between(texture.quaternions.astype(np.float64), at))
    style = rot.from_rotation_vector(_STYLE * rng.normal(size=(1, joints, 3)))
    knots = _TREMOR * rng.normal(size=(len(at) // _TREMOR_FRAMES + 2, joints, 3))
    tremor = rot.from_rotation_vector(_between(knots, np.arange(len(at)) / _TREMOR_FRAMES))
    varied = rot.continuous(rot.multiply(rot.multiply(body, style), tremor))
    return replace(
        texture,
        quaternions=np.ascontiguousarray(varied, dtype=np.float32),
        travel=_between(texture.travel.astype(np.float64), at).astype(np.float32),
        turning=_between(texture.turning.astype(np.float64), at).astype(np.float32),
    )


def _between(values: F64, at: F64) -> F64:
    low = np.minimum(at.astype(np.int64), len(values) - 2)
    part = (at - low).reshape(-1, *[1] * (values.ndim - 1))
    return np.asarray(values[low] * (1.0 - part) + values[low + 1] * part)
