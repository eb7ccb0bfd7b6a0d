"""Whether two takes are the same recording: a take is never its own context."""

from __future__ import annotations

from collections.abc import Iterable

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
