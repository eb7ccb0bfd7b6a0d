"""What the report says of a take of markers."""

from __future__ import annotations

from html import escape

from mocapstudio.motion.markers import MarkerTake
from mocapstudio.review.document import Document
from mocapstudio.review.marker_changes import marker_changes
from mocapstudio.review.marker_gaps import TakeGaps, take_gaps
from mocapstudio.review.marker_model import MarkerPerformer
from mocapstudio.review.report_tables import frames, table, when


def marker_section(document: Document, performer: MarkerPerformer) -> str:
    """Return the section of one take of markers as HTML: what is missing, filled and changed."""
    take, result = performer.take, document.marker_result(performer.id)
    source = take.source
    place = "made in memory" if source is None else f"{source.path} · SHA-256 {source.digest}"
    facts = (
        f"{len(take.labels)} markers · {take.frames} frames · {take.duration:.2f} s"
        f" · {float(take.rate):g} frames a second"
    )
    gaps = take_gaps(result)
    return "".join(
        [
            f"<section><h2>{escape(take.name)}</h2><p class='muted path'>{escape(place)}</p>",
            f"<p class='muted'>{facts}</p>",
            _cards(take, result, gaps),
            _gaps(gaps),
            _changes(document, performer),
            "</section>",
        ]
    )


def _cards(take: MarkerTake, result: MarkerTake, gaps: TakeGaps) -> str:
    filled = 0.0
    if result.filled is not None:
        filled = float((result.filled & ~result.missing).mean())
    cards = (
        ("gaps at first", str(len(take_gaps(take).in_time))),
        ("gaps left", str(len(gaps.in_time))),
        ("missing", f"{100 * result.missing.mean():.2f} %"),
        ("filled", f"{100 * filled:.2f} %"),
    )
    cells = (
        f"<div class='card'><b>{escape(value)}</b><span>{escape(name)}</span></div>"
        for name, value in cards
    )
    return f"<div class='cards'>{''.join(cells)}</div>"


def _gaps(gaps: TakeGaps) -> str:
    rows = [
        [
            escape(one.label),
            str(len(one.gaps)),
            str(one.longest),
            f"{100 * one.share:.2f} %",
            f"{100 * one.share_filled:.2f} %",
        ]
        for one in gaps.markers
        if one.gaps or one.filled
    ]
    head = ["Marker", "Gaps left", "Longest (frames)", "Missing", "Filled"]
    return table("What is missing", head, rows, "Nothing is missing.", numbers={1, 2, 3, 4})


def _changes(document: Document, performer: MarkerPerformer) -> str:
    take = performer.take
    rows = [
        [
            escape(one["marker"]),
            f"{take.seconds(one['start']):.2f}",
            frames(take, one["start"], one["end"]),
            escape(one["method"]) + (f" with {escape(one['with'])}" if one["with"] else ""),
            escape(one["author"]),
            when(one["time"]),
        ]
        for one in marker_changes(document.marker_edits(performer.id))
    ]
    head = ["Marker", "Time (s)", "Frames", "Method", "By", "When (UTC)"]
    return table("What was changed", head, rows, "Nothing was changed.", numbers={1, 2})
