"""The main job on the demo take from end to end, without the desk."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from mocapstudio import formats
from mocapstudio.cli.clean import repaired
from mocapstudio.cli.detection_options import analyse
from mocapstudio.evaluation.demo import demo_take, write_demo
from mocapstudio.evaluation.scoring import Scores, score
from mocapstudio.evaluation.truth import Truth, analysed_rows, departure, erroneous
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.facing import ROOT_POSITION
from mocapstudio.motion.take import Take

if TYPE_CHECKING:
    from mocapstudio.cleaning.analysis import Analysis
    from mocapstudio.cleaning.model import Flag

_POSES = 4


def do_job(folder: Path) -> Iterator[str]:
    """Detect, repair, export, report and draw; yields what to tell the user, line by line.

    Written are `demo.bvh` with known errors (`truth.json`), its `context`, `demo_clean.bvh` with
    its provenance, `report.html`, and pictures of the map, poses and curves.

    Raises
    ------
    FileError
        If something cannot be written.
    """
    from mocapstudio.cleaning.parameters import DetectionParameters
    from mocapstudio.review.export import export
    from mocapstudio.review.report import write_report

    begun = time.perf_counter()
    files = write_demo(folder)
    take = _read(files.take)
    context = [_read(path) for path in files.context]
    yield f"{files.take}: {take.duration:.0f} s, {len(files.truths)} known errors"
    analysis = analyse(take, context, DetectionParameters())
    document, performer = repaired(analysis, files.context)
    cleaned = folder / "demo_clean.bvh"
    export(document, performer, cleaned)
    write_report(document, folder / "report.html")
    result = document.result(performer)
    yield from _found(analysis, files.truths)
    yield from _repairs(take, result, files.truths)
    for note in _pictures(analysis, result, files.truths, folder):
        yield f"note: {note}"
    yield f"written to {folder}: {cleaned.name}, report.html, map.png, poses and curves"
    yield f"done in {time.perf_counter() - begun:.0f} s"


def _read(path: Path) -> Take:
    takes, _ = formats.read(path)
    return takes[0]


def _found(analysis: Analysis, truths: Sequence[Truth]) -> Iterator[str]:
    clean, rows = demo_take(), analysed_rows(analysis.take.skeleton)
    scored: Scores = score(
        analysis.flags,
        erroneous(clean, analysis.take, truths, rows),
        truths,
        rows,
        float(analysis.take.rate),
    )
    for truth in truths:
        hits = _flags_of(analysis, truth)
        seconds = analysis.take.seconds(truth.start)
        rows_hit = f"{len({flag.joint for flag in hits})}/{len(truth.joints)} rows"
        verdict = f"found ({rows_hit}, score {hits[0].score:.2f})" if hits else "missed"
        what = truth.joints[0] + (f" +{len(truth.joints) - 1}" if len(truth.joints) > 1 else "")
        yield f"  {seconds:6.1f} s  {truth.kind.value:13} {what:18} {verdict}"
    found = sum(bool(_flags_of(analysis, truth)) for truth in truths)
    yield (
        f"{found} of {len(truths)} known errors found; "
        f"{scored.flags} flags, {scored.false_flags} of them false"
    )


def _flags_of(analysis: Analysis, truth: Truth) -> list[Flag]:
    """Flags on a truth's rows that overlap its span, worst first."""
    return [
        flag
        for flag in analysis.flags
        if flag.joint in truth.joints and flag.overlaps(truth.start, truth.end)
    ]


def _repairs(take: Take, result: Take, truths: Sequence[Truth]) -> Iterator[str]:
    """How far the erroneous joints are from the clean take, before and after."""
    clean = demo_take()
    rows = [row for row in analysed_rows(take.skeleton) if row != ROOT_POSITION]
    wrong = erroneous(clean, take, truths, rows)
    before, after = (departure(clean, one, rows)[wrong].mean() for one in (take, result))
    yield f"where joints were wrong, they were {before:.0f}° off, and are {after:.0f}° off now"


def _pictures(
    analysis: Analysis, result: Take, truths: Sequence[Truth], folder: Path
) -> Iterator[str]:
    """Draw the map, and poses and curves of the worst flags; yields notes."""
    from mocapstudio.pictures.curve_picture import curve_picture
    from mocapstudio.pictures.map_picture import map_picture
    from mocapstudio.pictures.pose_picture import pose_picture
    from mocapstudio.pictures.stick import frame_of_change

    known = [Declared(row, one.start, one.end) for one in truths for row in one.joints]
    map_picture(analysis, known=known).save(folder / "map.png")
    notes = set()
    for number, flag in enumerate(_worst_apart(analysis.flags, _POSES), start=1):
        title = f"{flag.joint} · {flag.kind.value} · score {flag.score:.2f}"
        frame = frame_of_change(analysis.take, result, flag.start, flag.end)
        pose = pose_picture(analysis.take, result, frame, flag.joints, title=title)
        pose.save(folder / f"pose-{number}.png")
        curve = curve_picture(
            analysis.take, result, flag.joint, (flag.start, flag.end), title=title
        )
        curve.save(folder / f"curve-{number}.png")
        notes |= {pose.note} if pose.note else set()
    yield from sorted(notes)


def _worst_apart(flags: Sequence[Flag], count: int) -> list[Flag]:
    """Return the worst flags of which no two share a frame."""
    chosen: list[Flag] = []
    for flag in flags:
        if len(chosen) < count and not any(flag.overlaps(c.start, c.end) for c in chosen):
            chosen.append(flag)
    return chosen
