"""In which order the file itself turns about the axes."""

from __future__ import annotations

from mocapstudio.formats.bvh_read import BvhRecord
from mocapstudio.motion.take import Take


def euler_order(take: Take, joint: int) -> str | None:
    """Axis letters of a joint's rotation channels in the take's file, outermost first.

    None where the file states no three different axes for the joint, or the take has no file that
    states any.
    """
    record = None if take.source is None else take.source.record
    if not isinstance(record, BvhRecord):
        return None
    order = record.layout.hierarchy.joints[joint].order
    return order if len(set(order)) == 3 else None
