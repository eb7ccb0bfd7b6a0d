"""The ranges in which joints move: no repair leaves what the context, or the take, has shown."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.repair.material import (
    Doubts,
    Material,
    centre_of,
    doubted,
    texture_values,
)
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import motion_texture

F64 = NDArray[np.float64]

_QUANTILE = 0.001


def joint_ranges(
    material: Material, context: tuple[Take, ...], joint: int, doubts: Doubts = ()
) -> F64:
    """(2, 3) lowest and highest rotation vector of a joint from the mean pose, radians.

    Between the 0.1 % quantiles of the context, without what looks wrong in it, widened by what the
    take itself shows where the joint is not flagged. Unbounded where nothing is known.
    """
    columns = slice(3 * joint, 3 * joint + 3)
    right = material.values[~material.wrong[:, joint], columns]
    seen = [np.stack([right.min(axis=0), right.max(axis=0)])] if len(right) else []
    if context:
        seen.append(_of_context(context, material.joints, doubts)[:, columns])
    if not seen:
        return np.array([[-np.inf] * 3, [np.inf] * 3])
    return np.stack([np.min([s[0] for s in seen], axis=0), np.max([s[1] for s in seen], axis=0)])


def within(material: Material, joint: int, rotations: F64, ranges: F64) -> F64:
    """(n, 4) rotations of a joint, brought to the nearest that lie in its ranges."""
    turned = rot.multiply(rot.conjugate(material.centre[joint]), rotations)
    vectors = rot.to_rotation_vector(turned)
    inside = np.clip(vectors, ranges[0], ranges[1])
    if np.array_equal(inside, vectors):
        return rotations
    return material.rotations(joint, inside)


@lru_cache(maxsize=8)
def _of_context(context: tuple[Take, ...], joints: tuple[str, ...], doubts: Doubts) -> F64:
    centre = centre_of(context, joints)
    values, wrong = [], []
    for at, take in enumerate(context):
        texture = motion_texture(take, joints)
        values.append(texture_values(texture, centre)[:, : 3 * len(joints)])
        wrong.append(doubted(texture, doubts[at] if doubts else ())[:, : len(joints)])
    everything, out = np.concatenate(values), np.concatenate(wrong)
    out &= ~out.all(axis=0)
    right = np.where(np.repeat(out, 3, axis=1), np.nan, everything)
    return np.asarray(np.nanquantile(right, [_QUANTILE, 1.0 - _QUANTILE], axis=0))
