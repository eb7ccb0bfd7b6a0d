"""What a segment is in the reference and in a source: durations and delay. No Qt."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mocapstudio.comparison.model import Segment
from mocapstudio.review.comparing import Linked, Recording


@dataclass(frozen=True)
class SegmentFacts:
    """One segment; times in seconds.

    Parameters
    ----------
    name
        What is done.
    start, duration
        In the reference.
    source_start, source_duration
        As carried over to the source, or None without a comparison.
    delay
        How much later the source begins it than the reference does, or None.
    """

    name: str
    start: float
    duration: float
    source_start: float | None = None
    source_duration: float | None = None
    delay: float | None = None

    def texts(self) -> tuple[str, str, str, str, str]:
        """Name, start, duration, the source's duration, delay, as a table shows them."""
        source = "" if self.source_duration is None else f"{self.source_duration:.2f}"
        delay = "" if self.delay is None else f"{self.delay:+.2f}".replace("-", "−")
        return self.name, f"{self.start:.2f}", f"{self.duration:.2f}", source, delay


def segment_facts(
    reference: Recording | None, linked: Linked | None, segments: Sequence[Segment]
) -> tuple[SegmentFacts, ...]:
    """Measure the segments of the reference as a source performs them."""
    if reference is None:
        return ()
    found = []
    for one in segments:
        start, length = reference.seconds(one.start), reference.seconds(one.end - one.start)
        if linked is None:
            found.append(SegmentFacts(one.name, start, length))
            continue
        rate = float(linked.comparison.source_rate)
        first, end = linked.carried(one)
        begun, lasts = first / rate, (end - first) / rate
        delay = -float(linked.comparison.misalignment[first])
        found.append(SegmentFacts(one.name, start, length, begun, lasts, delay))
    return tuple(found)
