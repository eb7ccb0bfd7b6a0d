"""Where an exported take comes from: what it was made of, and who decided what, when."""

from __future__ import annotations

import dataclasses
import hashlib
from collections import Counter
from collections.abc import Iterable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from mocapstudio import __version__
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take
from mocapstudio.review.document import Document
from mocapstudio.review.model import Decision, Edit, Protected, Verdict


def changes(edits: Iterable[Edit]) -> list[dict[str, Any]]:
    """Return every row × span that unmuted edits may change, by start, then row.

    Frames are 0-based at the take's own rate, ends exclusive. Of overlapping changes the one
    decided last is in force.
    """
    found = [
        change(edit, row) | {"author": edit.author, "time": edit.time}
        for edit in edits
        if not edit.muted
        for row in edit.rows
    ]
    return sorted(found, key=lambda one: (one["start"], one["joint"], one["time"]))


def verdict_counts(document: Document, performer: str) -> dict[str, int]:
    """Return how many flags of a performer's queue have each verdict."""
    counted = Counter(item.verdict for item in document.queue(performer))
    return {verdict.value: counted[verdict] for verdict in Verdict}


def provenance(document: Document, performer: str, output: Path) -> dict[str, Any]:
    """Return the provenance of an exported take, as JSON knows it.

    Parameters
    ----------
    output
        The exported file, already written.
    """
    state = document.state
    take, sitting = document.source(performer), state.sitting
    analysis = state.analyses.get(performer)
    parameters = state.parameters if analysis is None else analysis.parameters
    context = () if analysis is None else analysis.context
    return {
        "program": "mocapstudio",
        "version": __version__,
        "written": utc_now(),
        "take": origin(take) | {"fps": float(take.rate), "frames": take.frames, "trim": take.trim},
        "output": {"path": str(output), "sha256": hashlib.sha256(output.read_bytes()).hexdigest()},
        "session": None if state.path is None else str(state.path),
        "parameters": dataclasses.asdict(parameters),
        "context": {
            "paths": [str(path) for path in state.context],
            "takes": [origin(one) for one in context],
        },
        "verdicts": verdict_counts(document, performer),
        "changes": changes(e for e in sitting.edits if e.performer == performer),
        "decisions": [_decision(d) for d in sitting.decisions if d.performer == performer],
        "protected": [_protected(p) for p in sitting.protected if p.performer == performer],
    }


def utc_now() -> str:
    """Return the present time, UTC, ISO 8601."""
    return datetime.now(UTC).isoformat(timespec="seconds").replace("+00:00", "Z")


def origin(take: Take | MarkerTake) -> dict[str, Any]:
    """Return name, path and SHA-256 of a take's file, as JSON knows them."""
    source = take.source
    return {
        "name": take.name,
        "path": None if source is None else str(source.path),
        "sha256": None if source is None else source.digest,
    }


def change(edit: Edit, row: str) -> dict[str, Any]:
    """Return what an edit does to one of its rows, as JSON knows it."""
    donor = edit.donor
    return {
        "joint": row,
        "start": edit.start,
        "end": edit.end,
        "method": edit.method,
        "donor": donor and {"take": donor.take, "start": donor.start, "end": donor.end},
    }


def _decision(decision: Decision) -> dict[str, Any]:
    flag = decision.flag
    return {
        "joint": flag.joint,
        "start": flag.start,
        "end": flag.end,
        "kind": flag.kind.value,
        "score": flag.score,
        "verdict": decision.verdict.value,
        "author": decision.author,
        "time": decision.time,
    }


def _protected(one: Protected) -> dict[str, Any]:
    return {
        "joints": sorted(one.joints),
        "start": one.start,
        "end": one.end,
        "author": one.author,
        "time": one.time,
    }
