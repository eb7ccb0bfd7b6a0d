"""Comparisons as tables of comma-separated values. No Qt."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence

import numpy as np

from mocapstudio.comparison.model import Comparison
from mocapstudio.gui.compare.colours import TIMING_WORDS
from mocapstudio.review.comparing import Compared, ComparingState, Linked


def frames_table(comparison: Comparison) -> bytes:
    """One line a source frame: matched frame, misalignment, timing, differences."""
    rates = float(comparison.source_rate), float(comparison.reference_rate)
    head = (
        "source frame", "source s", "reference frame", "reference s", "misalignment s",
        "misalignment relative s", "timing", "pose difference", *comparison.rows,
    )  # fmt: skip
    lines = (
        (
            n, f"{n / rates[0]:.4f}", f"{comparison.warp[n]:.3f}",
            f"{comparison.warp[n] / rates[1]:.4f}", f"{comparison.misalignment[n]:.4f}",
            f"{comparison.misalignment_relative[n]:.4f}",
            TIMING_WORDS[int(comparison.timing[n])], f"{comparison.pose_difference[n]:.5f}",
            *(f"{value:.5f}" for value in comparison.joint_difference[n]),
        )
        for n in range(len(comparison.warp))
    )  # fmt: skip
    return _csv(head, lines)


def segments_table(state: ComparingState) -> bytes:
    """One line a segment and source: where it is, how long it lasts, how late it comes."""
    head = (
        "segment", "source", "reference start", "reference end", "source start", "source end",
        "reference s", "source s", "delay s", "delay relative s", "pose difference",
    )  # fmt: skip
    lines = (
        (
            one.reference.name, source, one.reference.start, one.reference.end,
            one.source.start, one.source.end, f"{one.reference_duration:.4f}",
            f"{one.source_duration:.4f}", f"{one.delay:.4f}", f"{one.delay_relative:.4f}",
            f"{one.pose_difference:.5f}",
        )
        for source, linked in _linked(state.sources)
        for one in linked.carried(state.segments)
    )  # fmt: skip
    return _csv(head, lines)


def ranking_table(state: ComparingState) -> bytes:
    """One line a source, the most alike first."""
    head = (
        "rank", "source", "seconds", "dissimilarity", "mean misalignment s",
        "mean misalignment relative s", "hastened", "on time", "delayed", "warnings",
    )  # fmt: skip
    lines = []
    for rank, (source, linked) in enumerate(_linked(state.ranking), start=1):
        one = linked.comparison
        shares = (f"{np.mean(one.timing == kind):.4f}" for kind in (1, 0, -1))
        lines.append(
            (
                rank, source, f"{len(one.warp) / float(one.source_rate):.3f}",
                f"{one.dissimilarity:.5f}", f"{np.abs(one.misalignment).mean():.4f}",
                f"{np.abs(one.misalignment_relative).mean():.4f}", *shares,
                "; ".join(one.warnings),
            )
        )  # fmt: skip
    return _csv(head, lines)


def _linked(sources: Iterable[Compared]) -> list[tuple[str, Linked]]:
    return [(one.id, one.linked) for one in sources if one.linked is not None]


def _csv(head: Sequence[str], lines: Iterable[Sequence[object]]) -> bytes:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(head)
    writer.writerows(lines)
    return text.getvalue().encode()
