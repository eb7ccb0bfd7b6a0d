"""Whether two takes are the same recording: a take is never its own context."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable

import numpy as np

from mocapstudio.motion.take import Take


def same_recording(one: Take, other: Take) -> bool:
    """Tell whether two takes come from the same file, or from files of the same content."""
    if one.source is None or other.source is None:
        return one is other
    if one.source.performer != other.source.performer:
        return False
    same_file = one.source.path.resolve() == other.source.path.resolve()
    return same_file or one.source.digest == other.source.digest


def without_itself(context: Iterable[Take], take: Take) -> tuple[Take, ...]:
    """Leave the take itself out of its context."""
    return tuple(other for other in context if not same_recording(other, take))


def motion_digest(take: Take) -> str:
    """Digest of skeleton, motion, rate and trimmed span, whatever file they came from."""
    skeleton = take.skeleton
    told = (take.rate, take.span, take.translated, skeleton.names, skeleton.parents.tolist())
    found = hashlib.sha256(repr(told).encode())
    found.update(np.ascontiguousarray(skeleton.offsets, dtype=np.float32).tobytes())
    found.update(np.ascontiguousarray(take.rotations, dtype=np.float32).tobytes())
    found.update(np.ascontiguousarray(take.translations, dtype=np.float32).tobytes())
    return found.hexdigest()
