"""What a repair may draw on: the take without what is flagged, and its context.

Rotations are held as rotation vectors from a mean pose, of the hips without their heading, as in
the motion-texture. Flagged samples are marked, so that no error helps to repair another.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.decision.gaussian import (
    OFFSETS,
    Moments,
    moments,
    rotation_vectors,
    stacked,
)
from mocapstudio.cleaning.distance_profile import texture_span
from mocapstudio.cleaning.model import Flag
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.facing import ROOT_POSITION, ROOT_ROWS, carrier
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology
from mocapstudio.similarity.texture import (
    TEXTURE_RATE,
    BodyMotion,
    MotionTexture,
    body_motion,
    motion_texture,
)

F64 = NDArray[np.float64]
Mask = NDArray[np.bool_]
Doubts = tuple[tuple[Declared, ...], ...]

WALK = 3
"""Columns behind the joints': forward and sideways speed and turning of the hips."""
_WALK_SCALE = 0.3
_REPAIRED = 0.5
_LEAST = 48
"""Frames at 24 fps that a context has to have left without what looks wrong."""


@dataclass(frozen=True, eq=False)
class Material:
    """The take at its own rate, and moments of its context.

    Parameters
    ----------
    take
        The take to be repaired.
    motion
        Its body over the trimmed span, F' frames.
    centre
        (m, 4) the mean pose of the context, from which rotation vectors are measured.
    values
        (F', 3 m + 3) rotation vectors of the m joints, then forward and sideways speed and
        turning, scaled to matter as much as a joint.
    wrong
        (F', m + 2) where a row, a joint or one of the root's, is flagged and not repaired yet.
    texture
        Of the analysed take, before any repair.
    known
        Moments of the context's stacked values, None without a context.
    """

    take: Take
    motion: BodyMotion
    centre: F64
    values: F64
    wrong: Mask
    texture: MotionTexture
    known: Moments | None

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the m joints."""
        return self.motion.joints

    def rotations(self, joint: int, vectors: F64) -> F64:
        """(n, 4) rotations of a joint from rotation vectors (n, 3)."""
        return rot.multiply(self.centre[joint], rot.from_rotation_vector(vectors))


def material(analysis: Analysis, flag: Flag, take: Take) -> Material:
    """Gather what may be drawn on to repair `flag` in `take`.

    Parameters
    ----------
    analysis
        The analysis that raised the flag.
    flag
        What is to be repaired; it need not be among the analysis' own flags.
    take
        The take as it is by now: flags that it has been repaired of are no longer wrong.
    """
    joints = analysis.texture.joints
    motion = body_motion(take, joints)
    centre = centre_of(analysis.context, joints) if analysis.context else _mean(analysis.texture)
    others = [one for one in analysis.flags if one.id != flag.id]
    open_ = [one for one in others if not is_repaired(analysis.take, take, one)]
    wrong = wrong_rows(joints, len(motion), motion.start, [flag, *open_])
    known = None
    if analysis.context:
        known = context_moments(analysis.context, joints, analysis.doubts)
    values = np.hstack([_vectors(motion, centre), walk_of(analysis.texture, motion)])
    return Material(take, motion, centre, values, wrong, analysis.texture, known)


def wrong_rows(
    joints: Sequence[str], frames: int, start: int, flags: Sequence[Flag | Declared]
) -> Mask:
    """(frames, m + 2) where rows are flagged, `start` being the take's frame that is the first."""
    rows = [*joints, *ROOT_ROWS]
    wrong = np.zeros((frames, len(rows)), dtype=bool)
    for one in flags:
        row = one.joint if isinstance(one, Flag) else one.row
        if row in rows:
            wrong[max(one.start - start, 0) : max(one.end - start, 0), rows.index(row)] = True
    return wrong


def is_repaired(before: Take, after: Take, flag: Flag) -> bool:
    """Tell whether most frames of a flag's row have been changed since."""
    if after is before:
        return False
    span = slice(flag.start, flag.end)
    if flag.joint == ROOT_POSITION:
        at = carrier(before)
        same = (before.translations[span, at] == after.translations[span, at]).all(axis=-1)
    else:
        skeleton = before.skeleton
        joint = skeleton.index.get(flag.joint, topology(skeleton).hips)
        same = (before.rotations[span, joint] == after.rotations[span, joint]).all(axis=-1)
    return bool(np.mean(same) < _REPAIRED)


def walk_of(texture: MotionTexture, motion: BodyMotion) -> F64:
    """(F', 3) scaled speeds and turning of the hips at the take's own rate."""
    sampled = _walk(texture)
    at = np.arange(len(motion)) / texture.frames_each
    ticks = np.arange(len(sampled))
    return np.stack([np.interp(at, ticks, column) for column in sampled.T], axis=1)


@lru_cache(maxsize=8)
def context_moments(
    context: tuple[Take, ...], joints: tuple[str, ...], doubts: Doubts = ()
) -> Moments:
    """Moments of all takes of a context, stacked values at 24 fps, without what looks wrong."""
    centre = centre_of(context, joints)
    parts = []
    for at, take in enumerate(context):
        texture = motion_texture(take, joints)
        wrong = doubted(texture, doubts[at] if doubts else ()).any(axis=1, keepdims=True)
        right = ~stacked(np.asarray(wrong, dtype=np.float64)).any(axis=1)
        parts.append(moments(stacked(texture_values(texture, centre))[right]))
    total = parts[0]
    for one in parts[1:]:
        total = total + one
    # Where everything is doubted, that tells nothing.
    return total if total.count >= _LEAST or not doubts else context_moments(context, joints)


def doubted(texture: MotionTexture, doubts: Sequence[Declared]) -> Mask:
    """(T, m + 2) texture frames at which rows look wrong themselves."""
    rows = [*texture.joints, *ROOT_ROWS]
    wrong = np.zeros((len(texture), len(rows)), dtype=bool)
    for one in doubts:
        if one.row in rows:
            wrong[slice(*texture_span(texture, one)), rows.index(one.row)] = True
    return wrong


def texture_values(texture: MotionTexture, centre: F64) -> F64:
    """(T, 3 m + 3) values of a texture, as in `Material.values`."""
    vectors = rotation_vectors(texture.quaternions, centre.astype(np.float32))
    return np.hstack([vectors, _walk(texture)])


def sampled_stack(values: F64, frames_each: float, at: F64) -> F64:
    """(n, d) stacked values at fractional frames of the take's own rate, held at its ends."""
    parts = []
    for offset in OFFSETS:
        place = np.clip(at + offset * frames_each, 0, len(values) - 1)
        low = np.minimum(place.astype(np.int64), max(len(values) - 2, 0))
        part = (place - low)[:, None]
        high = np.minimum(low + 1, len(values) - 1)
        parts.append(values[low] * (1.0 - part) + values[high] * part)
    return np.concatenate(parts, axis=1)


def _walk(texture: MotionTexture) -> F64:
    columns = [texture.travel[:, 0], texture.travel[:, 1], texture.turning]
    return np.asarray(_WALK_SCALE * np.stack(columns, axis=1), dtype=np.float64)


def _vectors(motion: BodyMotion, centre: F64) -> F64:
    turned = rot.multiply(rot.conjugate(centre), motion.rotations)
    return rot.to_rotation_vector(turned).reshape(len(motion), -1)


@lru_cache(maxsize=8)
def centre_of(context: tuple[Take, ...], joints: tuple[str, ...]) -> F64:
    """(m, 4) mean pose of a context."""
    poses = [motion_texture(t, joints).quaternions.astype(np.float64) for t in context]
    return rot.mean(np.concatenate(poses))


def _mean(texture: MotionTexture) -> F64:
    return rot.mean(texture.quaternions.astype(np.float64))


def frames_each(material: Material) -> float:
    """Frames of the take for one at 24 fps."""
    return material.motion.rate / TEXTURE_RATE
