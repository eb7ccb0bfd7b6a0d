"""What a detector is given and what is known about it: dirty take, truth, context."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

from mocapstudio.cleaning.model import Kind
from mocapstudio.evaluation.corpora import Entry, Split, entries, join, read_some
from mocapstudio.evaluation.corpora import split as half
from mocapstudio.evaluation.injection import ERRORS_A_MINUTE, KINDS, corrupt, inject_each, recur
from mocapstudio.evaluation.shapes import Family
from mocapstudio.evaluation.truth import Mask, Truth, analysed_rows, erroneous
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.take import Take

ContextSize = Literal["local", "small", "large"]
CONTEXT_TAKES = {"local": 0, "small": 8, "large": 30}
"""How many takes the context holds: the paper has 5 to 10, and 20 to 30."""
LOCAL_SECONDS = 15.0
DIRTY_A_MINUTE = 3.0
"""Errors a minute that make about 5 % of a context's frames erroneous."""


@dataclass(frozen=True, eq=False)
class Case:
    """One take to be analysed.

    Parameters
    ----------
    dirty, clean
        With and without its errors, frame by frame.
    truths
        The errors; none in a negative control.
    context
        Takes to compare with; neither the take nor its clean version is among them.
    ignore
        (F,) frames left out of scoring, or None.
    given
        (F, R) truth where it comes from labels instead of a clean take, else None.
    """

    dirty: Take
    clean: Take
    truths: tuple[Truth, ...]
    context: tuple[Take, ...]
    ignore: Mask | None = field(default=None, repr=False)
    given: Mask | None = field(default=None, repr=False)

    @property
    def rows(self) -> tuple[str, ...]:
        """Names of the scored rows."""
        return analysed_rows(self.clean.skeleton)

    def mask(self) -> Mask:
        """(F, R) truth."""
        if self.given is not None:
            return self.given
        return erroneous(self.clean, self.dirty, self.truths, self.rows)


@dataclass(frozen=True)
class Conditions:
    """What is wrong with the takes and with their context.

    Parameters
    ----------
    kinds, errors_per_minute, family
        See `injection.corrupt`; kinds come in turn; at 0 errors a minute the cases are negative
        controls.
    dirty_context
        Whether about 5 % of the context's frames are erroneous too.
    foreign
        Take the context from this other set.
    recurring
        How many times the first error of a take comes again.
    """

    kinds: Sequence[Kind] = KINDS
    errors_per_minute: float = ERRORS_A_MINUTE
    family: Family = "standard"
    dirty_context: bool = False
    foreign: str | None = None
    recurring: int = 0


USUAL = Conditions()


def cases(
    data: Path | Sequence[Path],
    corpus: str = "locomotion",
    context: ContextSize = "small",
    seed: int = 0,
    count: int = 6,
    split: Split = "development",
    conditions: Conditions = USUAL,
) -> list[Case]:
    """Make `count` cases that share one context, so that it needs preparing only once.

    The context comes from the development half. Takes under test come from the rest of it, or
    from the test half, of which development never sees anything. With fewer takes than `count`
    the same take comes again with other errors.

    Parameters
    ----------
    data
        Folder or files.
    corpus
        A set of `corpora.NAMED`, or ``"own"``.
    context
        ``"local"``: takes of one action joined to at least 15 s, and no context; ``"small"``: 8
        takes; ``"large"``: 30 (at most two thirds of the half while developing).
    seed
        Of split, choice and errors.
    count
        Number of cases.
    split
        Which half.
    conditions
        What is wrong with the takes and with their context.

    Raises
    ------
    MocapError
        If there are too few takes.
    """
    size = CONTEXT_TAKES[context]
    rng = np.random.default_rng([seed, len(corpus), size])
    tested, around = _chosen(data, corpus, size, split, seed, rng)
    if conditions.foreign is not None and around:
        others = entries(data, conditions.foreign)
        around = [others[i] for i in rng.permutation(len(others))[:size]]
    takes_around = tuple(read_some(around, size))
    takes: list[Take] = []
    if context != "local":
        takes = read_some(tested, count, takes_around[0]) if takes_around else []
        if not takes:
            raise MocapError(f"too few takes of one skeleton in the set {corpus!r}")
    if conditions.dirty_context:
        takes_around = tuple(corrupt(t, rng, DIRTY_A_MINUTE)[0] for t in takes_around)
    shares = _Shares(conditions, rng)
    made: list[Case] = []
    for i in range(count):
        clean, ignore = (takes[i % len(takes)], None) if takes else _joined(tested, i, rng)
        case_rng = np.random.default_rng([seed, i, len(takes_around), len(corpus)])
        dirty, truths = _spoilt(clean, shares.of(clean), conditions, case_rng)
        made.append(Case(dirty, clean, truths, takes_around, ignore))
    return made


class _Shares:
    """Deals errors out evenly, not drawn, so that few cases already hold their share of them."""

    def __init__(self, conditions: Conditions, rng: np.random.Generator) -> None:
        self._a_minute = conditions.errors_per_minute
        self._due, self._in_turn = 0.5, _in_turn(conditions.kinds, rng)

    def of(self, take: Take) -> list[Kind]:
        self._due += self._a_minute * take.duration / 60.0
        share = [next(self._in_turn) for _ in range(int(self._due))]
        self._due -= len(share)
        return share


def _spoilt(
    clean: Take, kinds: Sequence[Kind], conditions: Conditions, rng: np.random.Generator
) -> tuple[Take, tuple[Truth, ...]]:
    dirty, truths = inject_each(clean, kinds, rng, family=conditions.family)
    if truths and conditions.recurring:
        dirty, again = recur(dirty, truths[0], rng, conditions.recurring, avoid=truths[1:])
        truths = tuple(sorted((*again, *truths[1:]), key=lambda t: t.start))
    return dirty, truths


def _in_turn(kinds: Sequence[Kind], rng: np.random.Generator) -> Iterator[Kind]:
    while True:
        yield from (kinds[i] for i in rng.permutation(len(kinds)))


def _chosen(
    data: Path | Sequence[Path],
    corpus: str,
    size: int,
    part: Split,
    seed: int,
    rng: np.random.Generator,
) -> tuple[list[Entry], list[Entry]]:
    everything = entries(data, corpus)
    development = half(everything, "development", seed)
    shuffled = [development[i] for i in rng.permutation(len(development))]
    if part == "development":
        size = min(size, (2 * len(shuffled)) // 3)
        around, tested = shuffled[:size], shuffled[size:]
    else:
        test = half(everything, "test", seed)
        around, tested = shuffled[:size], [test[i] for i in rng.permutation(len(test))]
    if not tested or (size and not around):
        raise MocapError(f"too few takes in the set {corpus!r}: {len(everything)}")
    return _mixed(tested), around


def _mixed(chosen: Sequence[Entry]) -> list[Entry]:
    """Deal entries out action by action, so that a few of them already hold every action."""
    groups: dict[str, list[Entry]] = {}
    for entry in chosen:
        groups.setdefault(entry.action, []).append(entry)
    queues, result = list(groups.values()), []
    while any(queues):
        result += [q.pop(0) for q in queues if q]
    return result


def _joined(tested: Sequence[Entry], i: int, rng: np.random.Generator) -> tuple[Take, Mask]:
    """Join takes of one action, then of others, until they last long enough."""
    actions = sorted({e.action for e in tested})
    action = actions[i % len(actions)]
    order = [tested[k] for k in rng.permutation(len(tested))]
    order.sort(key=lambda e: e.action != action)
    takes: list[Take] = []
    while sum(t.duration for t in takes) < LOCAL_SECONDS:
        more = read_some(order, len(takes) + 1)
        if len(more) == len(takes):
            break
        takes = more
    if not takes:
        raise MocapError("no take of the set can be read")
    return join(takes)
