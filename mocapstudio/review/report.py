"""The report: one self-contained HTML file of what was found, decided and changed."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path
from typing import Any

from mocapstudio import __version__
from mocapstudio.formats.atomic import write_whole
from mocapstudio.motion.take import Take
from mocapstudio.resource_files import resource
from mocapstudio.review.document import Document
from mocapstudio.review.model import Edit, Performer, QueueItem
from mocapstudio.review.provenance import changes, utc_now, verdict_counts
from mocapstudio.review.report_map import flag_map
from mocapstudio.review.report_markers import marker_section
from mocapstudio.review.report_tables import frames, table, when

_HEAD = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy"
 content="default-src 'none'; style-src 'unsafe-inline'; img-src data:">
<title>{title}</title>
<style>
{style}</style>
</head>
<body>
"""


def write_report(document: Document, path: Path | str) -> None:
    """Write the report of a sitting; it needs no other file, and no network.

    Raises
    ------
    FileError
        If the file cannot be written, or is an input of the sitting.
    """
    sources = [one.take.source for one in document.state.everyone]
    inputs = [source.path for source in sources if source is not None]
    if document.state.path is not None:
        inputs.append(document.state.path)
    write_whole(path, [report(document).encode()], inputs=inputs)


def report(document: Document) -> str:
    """Return the report of a sitting as HTML."""
    state = document.state
    shown = [p.take.name for p in state.scene.performers if not p.partner]
    names = ", ".join([*shown, *(one.take.name for one in state.markers)])
    title = f"Review of {names}" if names else "Review of an empty sitting"
    style = resource("styles", "report.css").read_text(encoding="utf-8")
    return "".join(
        [
            _HEAD.format(title=escape(title), style=style),
            f"<header><h1>{escape(title)}</h1>",
            f"<p class='muted'>mocapstudio {escape(__version__)} · {when(utc_now())} UTC</p>",
            "</header>",
            *(_performer(document, p) for p in state.scene.performers if _counts(document, p)),
            *(marker_section(document, one) for one in state.markers),
            *([_analysis(document)] if state.scene.performers or not state.markers else []),
            "</body>\n</html>\n",
        ]
    )


def _counts(document: Document, performer: Performer) -> bool:
    edited = {edit.performer for edit in document.state.sitting.edits}
    return not performer.partner or performer.id in edited or bool(document.queue(performer.id))


def _performer(document: Document, performer: Performer) -> str:
    take, queue = document.source(performer.id), document.queue(performer.id)
    edits = [e for e in document.state.sitting.edits if e.performer == performer.id]
    analysis = document.state.analyses.get(performer.id)
    source = take.source
    place = "made in memory" if source is None else f"{source.path} · SHA-256 {source.digest}"
    rate = f"{float(take.rate):g} frames a second"
    trim = "" if take.trim is None else f" · trimmed to frames {frames(take, *take.trim)}"
    mapped = None if analysis is None else analysis.map
    return "".join(
        [
            f"<section><h2>{escape(take.name)}</h2><p class='muted path'>{escape(place)}</p>",
            f"<p class='muted'>{take.frames} frames · {take.duration:.2f} s · {rate}{trim}</p>",
            _cards(document, performer, queue, edits),
            flag_map(take, queue, edits, mapped),
            _flags(take, queue),
            _edits(take, edits),
            _protected(document, performer, take),
            "</section>",
        ]
    )


def _cards(
    document: Document, performer: Performer, queue: Sequence[QueueItem], edits: Sequence[Edit]
) -> str:
    verdicts = verdict_counts(document, performer.id)
    cards = [("flags", str(len(queue)), "")]
    cards += [(verdict, str(count), verdict) for verdict, count in verdicts.items()]
    cards.append(("changed", _share(document, performer, edits), ""))
    cells = (
        f"<div class='card {kind}'><b>{escape(value)}</b><span>{escape(label)}</span></div>"
        for label, value, kind in cards
    )
    return f"<div class='cards'>{''.join(cells)}</div>"


def _share(document: Document, performer: Performer, edits: Sequence[Edit]) -> str:
    """Share of the take's rows × frames that unmuted edits cover."""
    take = performer.take
    covered = sum(one.end - one.start for one in document.declared(performer.id))
    whole = take.frames * (len(take.skeleton) + 2)
    return f"{100 * covered / whole:.2f} %" if edits else "0 %"


def _flags(take: Take, queue: Sequence[QueueItem]) -> str:
    rows = []
    for rank, item in enumerate(queue, start=1):
        flag, decision = item.flag, item.decision
        word = item.verdict.value + ("" if item.current else ", no longer flagged")
        rows.append(
            [
                str(rank),
                escape(flag.joint),
                f"{take.seconds(flag.start):.2f}",
                frames(take, flag.start, flag.end),
                escape(flag.kind.value),
                f"{flag.score:.2f}",
                f"<span class='verdict {item.verdict.value}'>{word}</span>",
                "" if decision is None else escape(decision.author),
                "" if decision is None else when(decision.time),
            ]
        )
    head = ["#", "Joint", "Time (s)", "Frames", "Kind", "Score", "Verdict", "By", "When (UTC)"]
    return table("What was found", head, rows, "Nothing was flagged.", numbers={0, 2, 3, 5})


def _edits(take: Take, edits: Iterable[Edit]) -> str:
    rows = []
    for one in changes(edits):
        donor = one["donor"]
        source = ""
        if donor is not None:
            source = f"{escape(donor['take'])} {donor['start']}–{donor['end'] - 1}"
        rows.append(
            [
                escape(one["joint"]),
                f"{take.seconds(one['start']):.2f}",
                frames(take, one["start"], one["end"]),
                escape(one["method"]),
                source,
                escape(one["author"]),
                when(one["time"]),
            ]
        )
    head = ["Joint", "Time (s)", "Frames", "Method", "Donor (0-based frames)", "By", "When (UTC)"]
    return table("What was changed", head, rows, "Nothing was changed.", numbers={1, 2})


def _protected(document: Document, performer: Performer, take: Take) -> str:
    spans = [p for p in document.state.sitting.protected if p.performer == performer.id]
    if not spans:
        return ""
    rows = [
        [
            escape(", ".join(sorted(one.joints)) or "all joints"),
            f"{take.seconds(one.start):.2f}",
            frames(take, one.start, one.end),
            escape(one.author),
            when(one.time),
        ]
        for one in spans
    ]
    head = ["Joints", "Time (s)", "Frames", "By", "When (UTC)"]
    return table("What was protected", head, rows, "", numbers={1, 2})


def _analysis(document: Document) -> str:
    state = document.state
    values: list[tuple[str, Any]] = []
    for one in dataclasses.fields(state.parameters):
        schema = one.metadata.get("schema")
        value = getattr(state.parameters, one.name)
        unit = f" {schema.unit}" if schema is not None and schema.unit else ""
        values.append((schema.label if schema is not None else one.name, f"{value}{unit}"))
    values += [("Context", str(path)) for path in state.context] or [("Context", "the take itself")]
    values += [("Session", state.path)] if state.path is not None else []
    values += [("Note", f"{one.path}: {one.what}") for one in state.problems]
    cells = (f"<dt>{escape(k)}</dt><dd class='path'>{escape(str(v))}</dd>" for k, v in values)
    return f"<section><h2>How it was analysed</h2><dl>{''.join(cells)}</dl></section>"
