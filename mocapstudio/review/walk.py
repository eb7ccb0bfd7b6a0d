"""From one performer to another on the scene's clock."""

from __future__ import annotations

from mocapstudio.review.model import Performer


def same_moment(before: Performer | None, to: Performer, frame: int) -> int:
    """Frame of `to` at the moment of the scene at which `before` shows `frame`."""
    if before is None:
        return 0
    seconds = before.offset + before.take.seconds(frame) - to.offset
    return min(max(round(seconds * float(to.take.rate)), 0), to.take.frames - 1)
