"""What changed in a take against its source, measured against what was declared."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION, carrier
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

Mask = NDArray[np.bool_]

# Chord between quaternions, metres: what renormalising and turning there and back leaves.
_SAME = 1e-9


@dataclass(frozen=True, eq=False)
class Changes:
    """Which samples differ.

    Attributes
    ----------
    rotations
        (F, J) by frame and joint.
    translations
        (F, T) by frame and translated joint.
    """

    rotations: Mask
    translations: Mask


def changes(take: Take, original: Take) -> Changes:
    """Samples of `take` that differ from `original`, which has the same frames and joints.

    Raises
    ------
    MocapError
        If skeletons or frames do not correspond, so that samples cannot be compared.
    """
    if not _corresponds(take, original):
        raise MocapError(
            f"{take.name} has other joints or frames than its source: it must be written anew"
        )
    apart = np.linalg.norm(take.rotations - original.rotations, axis=-1)
    flipped = np.linalg.norm(take.rotations + original.rotations, axis=-1)
    moved = np.linalg.norm(take.translations - original.translations, axis=-1)
    return Changes(~(np.minimum(apart, flipped) <= _SAME), ~(moved <= _SAME))


def _corresponds(take: Take, original: Take) -> bool:
    ours, theirs = take.skeleton, original.skeleton
    return (
        take.rotations.shape == original.rotations.shape
        and take.translated == original.translated
        and np.array_equal(ours.parents, theirs.parents)
        and np.allclose(ours.offsets, theirs.offsets, rtol=0, atol=1e-9)
    )


def covered(take: Take, declared: Sequence[Declared]) -> Changes:
    """Samples that may change: a joint's row is its local rotation, the root rows the body's place.

    ``root position`` is the translation of the joint that carries the body, ``root heading`` the
    rotation of the hips and of the joints above them. The translation of any other joint belongs
    to its own row.

    Raises
    ------
    MocapError
        If a row is not one of the take's.
    """
    rotations = np.zeros(take.rotations.shape[:2], dtype=bool)
    translations = np.zeros(take.translations.shape[:2], dtype=bool)
    body = carrier(take)
    parts = topology(take.skeleton)
    for one in declared:
        span = slice(max(one.start, 0), max(one.end, 0))
        if one.row == ROOT_POSITION:
            translations[span, body] = True
        elif one.row == ROOT_HEADING:
            rotations[span, [parts.hips, *sorted(parts.above_hips)]] = True
        elif one.row in take.skeleton.index:
            joint = take.skeleton.index[one.row]
            rotations[span, joint] = True
            own = [t for t, j in enumerate(take.translated) if j == joint and t != body]
            translations[span, own] = True
        else:
            raise MocapError(f"declared row {one.row} is none of {take.name}'s")
    return Changes(rotations, translations)


def undeclared(take: Take, changed: Changes, declared: Sequence[Declared]) -> str | None:
    """Name the first change outside what was declared, or None where nothing else changed."""
    allowed = covered(take, declared)
    rotations = changed.rotations & ~allowed.rotations
    translations = changed.translations & ~allowed.translations
    for mask, joints, what in (
        (rotations, range(len(take.skeleton)), "rotation"),
        (translations, take.translated, "translation"),
    ):
        frames, at = np.nonzero(mask)
        if len(frames):
            joint = take.skeleton.names[joints[int(at[0])]]
            many = f" and {len(frames) - 1} more" if len(frames) > 1 else ""
            return f"{what} of {joint} at frame {int(frames[0])}{many}"
    return None
