"""How well flags agree with what is known to be wrong.

Words are 15 frames at 24 fps, hopping by 5, mapped to the take's own rate: a frame belongs to
every word whose time span holds it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.model import Flag, Kind
from mocapstudio.evaluation.truth import Array, Mask, Truth

WORD_FRAMES, WORD_HOP, WORD_RATE = 15, 5, 24.0
FOUND_SHARE = 0.3
"""An event is found where at least this share of its erroneous frames is flagged."""
NEAR_FRAMES = 5.0
"""A flag is false where no truth lies on its row within so many frames at 24 fps."""
THRESHOLDS = tuple(round(0.05 * i, 2) for i in range(1, 20))
"""Of the precision–recall curve."""


@dataclass(frozen=True)
class Counts:
    """Hits, false alarms and misses, which add up over takes."""

    hits: int = 0
    false: int = 0
    missed: int = 0

    def __add__(self, other: Counts) -> Counts:
        return Counts(self.hits + other.hits, self.false + other.false, self.missed + other.missed)

    @property
    def recall(self) -> float:
        """Share of what is wrong that was found; NaN where nothing is wrong."""
        wrong = self.hits + self.missed
        return self.hits / wrong if wrong else math.nan

    @property
    def precision(self) -> float:
        """Share of what was found that is wrong; NaN where nothing was found."""
        found = self.hits + self.false
        return self.hits / found if found else math.nan

    @property
    def f1(self) -> float:
        """Harmonic mean of both; NaN where nothing is wrong and nothing found."""
        total = 2 * self.hits + self.false + self.missed
        return 2 * self.hits / total if total else math.nan

    @staticmethod
    def of(found: Mask, wrong: Mask) -> Counts:
        """Count cells of two masks of one shape."""
        hits = int((found & wrong).sum())
        return Counts(hits, int(found.sum()) - hits, int(wrong.sum()) - hits)


@dataclass(frozen=True)
class KindScore:
    """What was found of one kind of error."""

    events: int = 0
    events_found: int = 0
    cells: int = 0
    cells_found: int = 0

    def __add__(self, other: KindScore) -> KindScore:
        return KindScore(
            self.events + other.events,
            self.events_found + other.events_found,
            self.cells + other.cells,
            self.cells_found + other.cells_found,
        )

    @property
    def event_recall(self) -> float:
        """Share of events found."""
        return self.events_found / self.events if self.events else math.nan

    @property
    def frame_recall(self) -> float:
        """Share of erroneous joint-frames flagged."""
        return self.cells_found / self.cells if self.cells else math.nan


@dataclass(frozen=True)
class Scores:
    """Everything that is counted for one or several takes; `+` adds takes up.

    Parameters
    ----------
    words, word_joints
        At word level (any row), and word by row.
    flags, false_flags
        Number of flags, and of those that are false.
    minutes
        Scored time.
    kinds
        What was found, by kind of error.
    edges
        Distances of found spans' edges from the truth's, frames of the take's own rate.
    curve
        Word and word × joint counts by threshold.
    """

    words: Counts = Counts()
    word_joints: Counts = Counts()
    flags: int = 0
    false_flags: int = 0
    minutes: float = 0.0
    kinds: Mapping[Kind, KindScore] = field(default_factory=dict)
    edges: tuple[int, ...] = ()
    curve: Mapping[float, tuple[Counts, Counts]] = field(default_factory=dict)

    def __add__(self, other: Scores) -> Scores:
        kinds = dict(self.kinds)
        for kind, score in other.kinds.items():
            kinds[kind] = kinds.get(kind, KindScore()) + score
        curve = dict(self.curve)
        for threshold, (words, cells) in other.curve.items():
            mine = curve.get(threshold, (Counts(), Counts()))
            curve[threshold] = (mine[0] + words, mine[1] + cells)
        return Scores(
            self.words + other.words,
            self.word_joints + other.word_joints,
            self.flags + other.flags,
            self.false_flags + other.false_flags,
            self.minutes + other.minutes,
            kinds,
            self.edges + other.edges,
            curve,
        )

    @property
    def events(self) -> KindScore:
        """All kinds together."""
        return sum(self.kinds.values(), KindScore())

    @property
    def false_flags_a_minute(self) -> float:
        """False flags a minute of scored time."""
        return self.false_flags / self.minutes if self.minutes else math.nan

    @property
    def flag_precision(self) -> float:
        """Share of flags that are not false."""
        return 1 - self.false_flags / self.flags if self.flags else math.nan

    @property
    def edge(self) -> float:
        """Median distance of edges, frames of the take's own rate."""
        return float(np.median(self.edges)) if self.edges else math.nan


def word_spans(frames: int, rate: float) -> NDArray[np.int64]:
    """(W, 2) half-open spans of the words that fit, at the take's own rate.

    A take shorter than a word is one word.
    """
    step = rate / WORD_RATE
    count = max(1, 1 + math.floor((frames / step - WORD_FRAMES) / WORD_HOP + 1e-9))
    starts = np.ceil(np.arange(count) * WORD_HOP * step - 1e-9)
    ends = np.ceil((np.arange(count) * WORD_HOP + WORD_FRAMES) * step - 1e-9)
    return np.stack([starts, np.minimum(ends, frames)], axis=1).astype(np.int64)


def score_map(flags: Sequence[Flag], rows: Sequence[str], frames: int) -> Array:
    """(F, R) highest score of the flags over each cell, -1 where there is none."""
    column = {row: i for i, row in enumerate(rows)}
    values = np.full((frames, len(rows)), -1.0)
    for flag in flags:
        if flag.joint in column:
            cells = values[flag.start : flag.end, column[flag.joint]]
            np.maximum(cells, flag.score, out=cells)
    return values


def score(
    flags: Sequence[Flag],
    mask: Mask,
    truths: Sequence[Truth],
    rows: Sequence[str],
    rate: float,
    *,
    ignore: Mask | None = None,
    sweep: Mapping[float, Sequence[Flag]] | None = None,
) -> Scores:
    """Score the flags of one take.

    Parameters
    ----------
    flags
        What the detector found, at the take's own rate. All of them count.
    mask
        (F, R) truth, see `evaluation.truth.erroneous`.
    truths
        The events.
    rows
        R names of the mask's columns.
    rate
        The take's own rate.
    ignore
        (F,) frames left out, such as those where takes were joined; words that have lost more
        than half of their frames to it are left out too.
    sweep
        Flags by threshold for the precision–recall curve; where None, `flags` of at least that
        score.
    """
    frames = len(mask)
    ignore = np.zeros(frames, dtype=bool) if ignore is None else ignore
    mask = mask & ~ignore[:, None]
    flags = [f for f in flags if not ignore[f.start : f.end].all()]
    found = (score_map(flags, rows, frames) >= 0) & ~ignore[:, None]
    spans = _kept(word_spans(frames, rate), ignore)
    wrong_words = _by_word(mask, spans)
    false = [f for f in flags if _is_false(f, mask, rows, rate)]
    kinds, edges = _events(truths, found, mask, rows)
    words, cells = _word_counts(found, wrong_words, spans)
    curve = {}
    for threshold in THRESHOLDS if sweep is None else sorted(sweep):
        chosen = flags if sweep is None else sweep[threshold]
        least = threshold if sweep is None else 0.0
        over = (score_map(chosen, rows, frames) >= least) & ~ignore[:, None]
        curve[threshold] = _word_counts(over, wrong_words, spans)
    return Scores(
        words=words,
        word_joints=cells,
        flags=len(flags),
        false_flags=len(false),
        minutes=float((~ignore).sum()) / rate / 60.0,
        kinds=kinds,
        edges=edges,
        curve=curve,
    )


def _kept(spans: NDArray[np.int64], ignore: Mask) -> NDArray[np.int64]:
    lost = np.array([ignore[a:b].mean() for a, b in spans])
    return spans[lost <= 0.5]


def _by_word(cells: Mask, spans: NDArray[np.int64]) -> Mask:
    """(W, R) whether any cell of a row is set within each word."""
    total = np.zeros((len(cells) + 1, cells.shape[1]), dtype=np.int64)
    np.cumsum(cells, axis=0, out=total[1:])
    return np.asarray(total[spans[:, 1]] > total[spans[:, 0]])


def _word_counts(found: Mask, wrong_words: Mask, spans: NDArray[np.int64]) -> tuple[Counts, Counts]:
    found_words = _by_word(found, spans)
    words = Counts.of(np.asarray(found_words.any(axis=1)), np.asarray(wrong_words.any(axis=1)))
    return words, Counts.of(found_words, wrong_words)


def _is_false(flag: Flag, mask: Mask, rows: Sequence[str], rate: float) -> bool:
    if flag.joint not in rows:
        return True
    near = round(NEAR_FRAMES * rate / WORD_RATE)
    around = slice(max(0, flag.start - near), flag.end + near)
    return not mask[around, rows.index(flag.joint)].any()


def _events(
    truths: Sequence[Truth], found: Mask, mask: Mask, rows: Sequence[str]
) -> tuple[dict[Kind, KindScore], tuple[int, ...]]:
    """Return what was found by kind of error, and the distances of the spans' edges."""
    kinds: dict[Kind, KindScore] = {}
    edges: list[int] = []
    for truth in truths:
        one, distances = _event(truth, found, mask, rows)
        if one.events:
            kinds[truth.kind] = kinds.get(truth.kind, KindScore()) + one
            edges += distances
    return kinds, tuple(edges)


def _event(
    truth: Truth, found: Mask, mask: Mask, rows: Sequence[str]
) -> tuple[KindScore, list[int]]:
    """Score one event; nothing where no frame of it is erroneous (or scored)."""
    span = slice(truth.start, truth.end)
    cells = cells_found = 0
    is_found = False
    edges: list[int] = []
    for row in truth.joints:
        if row not in rows:
            continue
        at = rows.index(row)
        wrong = np.flatnonzero(mask[span, at]) + truth.start
        if not len(wrong):
            continue
        hit = int(found[wrong, at].sum())
        cells, cells_found = cells + len(wrong), cells_found + hit
        if hit >= FOUND_SHARE * len(wrong):
            is_found = True
            start, end = _run_around(found[:, at], wrong)
            edges += [abs(start - int(wrong[0])), abs(end - int(wrong[-1]) - 1)]
    return KindScore(int(cells > 0), int(is_found), cells, cells_found), edges


def _run_around(flagged: Mask, wrong: NDArray[np.int64]) -> tuple[int, int]:
    """Outer edges of the flagged spans that touch the erroneous frames."""
    touched = wrong[flagged[wrong]]
    start, end = int(touched[0]), int(touched[-1]) + 1
    while start > 0 and flagged[start - 1]:
        start -= 1
    while end < len(flagged) and flagged[end]:
        end += 1
    return start, end
