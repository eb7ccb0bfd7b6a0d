"""Flags of the latest analysis merged with what was decided before."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import replace

from mocapstudio.cleaning.model import Flag
from mocapstudio.review.model import Decision, QueueItem, Verdict


def overlap(a: Flag, b: Flag) -> int:
    """Return the number of frames that two flags share; 0 on different rows."""
    if a.joint != b.joint:
        return 0
    return max(0, min(a.end, b.end) - max(a.start, b.start))


def succeeds(new: Flag, decided: Flag) -> bool:
    """Tell whether a verdict on `decided` holds for `new`.

    It does where they share a frame and are about the same thing: the new peak lies inside what
    was decided, or at least half of the new flag does. A short flag once rejected thus does not
    speak for a long one that grew around it with a peak elsewhere.
    """
    shared = overlap(new, decided)
    peak_inside = decided.start <= new.peak_frame < decided.end
    return shared > 0 and (peak_inside or 2 * shared >= new.end - new.start)


class Queue:
    """The queue of one performer: flags of one analysis, merged with ever new decisions.

    A decision whose own flag is raised again speaks for that one only. Any other flag takes the
    verdict of the decision that fits it best: of its kind, by frames shared, by likeness of the
    spans, the later one. Decisions that no flag took stay listed as no longer flagged, so that
    none ever disappears.

    Parameters
    ----------
    flags
        Flags of the latest analysis of one performer.
    """

    def __init__(self, flags: Iterable[Flag]) -> None:
        # Sorted once: a decision changes groups, not the order inside them.
        self._flags = sorted(flags, key=_rank)
        self._places = [_place(flag) for flag in self._flags]
        self._place_set = frozenset(self._places)
        self._ids = frozenset(flag.id for flag in self._flags)
        self._items = [QueueItem(flag, Verdict.OPEN) for flag in self._flags]

    def merged(self, decisions: Iterable[Decision]) -> tuple[QueueItem, ...]:
        """Return every flag and every decided flag, worst first.

        Deferred flags come after the others, and after them those no longer flagged. Items that
        are as they were the last time are the same objects.

        Parameters
        ----------
        decisions
            Decisions on the same performer, oldest first.
        """
        decided = tuple(decisions)
        own: dict[_Place, Decision] = {}
        others: defaultdict[str, list[Decision]] = defaultdict(list)
        for decision in decided:
            place = _place(decision.flag)
            if place in self._place_set:
                own[place] = decision
            else:
                others[decision.flag.joint].append(decision)
        for i, flag in enumerate(self._flags):
            best = own.get(self._places[i])
            if best is None and others:
                best = _best(flag, others.get(flag.joint, ()))
            if self._items[i].decision is not best:
                verdict = Verdict.OPEN if best is None else best.verdict
                self._items[i] = QueueItem(flag, verdict, True, best)
        taken = {id(item.decision) for item in self._items}
        left = [decision for decision in decided if id(decision) not in taken]
        deferred = [item for item in self._items if item.verdict is Verdict.DEFERRED]
        rest = [item for item in self._items if item.verdict is not Verdict.DEFERRED]
        return (*rest, *deferred, *self._gone(left))

    def _gone(self, decisions: Iterable[Decision]) -> list[QueueItem]:
        """Decided flags that are no longer raised, with ids that no other line has."""
        used = set(self._ids)
        items = []
        for decision in decisions:
            flag = replace(decision.flag, id=_free_id(decision.flag.id, used))
            used.add(flag.id)
            items.append(QueueItem(flag, decision.verdict, False, decision))
        return sorted(items, key=lambda item: _rank(item.flag))


_Place = tuple[str, int, int, str]


def _place(flag: Flag) -> _Place:
    return flag.joint, flag.start, flag.end, flag.kind.value


def _best(flag: Flag, decisions: Iterable[Decision]) -> Decision | None:
    best, most = None, (False, 0, 0.0)
    for decision in decisions:
        if not succeeds(flag, decision.flag):
            continue
        shared = overlap(flag, decision.flag)
        together = (flag.end - flag.start) + (decision.flag.end - decision.flag.start) - shared
        fit = (decision.flag.kind == flag.kind, shared, shared / together)
        if fit >= most:
            best, most = decision, fit
    return best


def _free_id(wanted: str, used: set[str]) -> str:
    candidate, n = wanted, 2
    while candidate in used:
        candidate, n = f"{wanted}~{n}", n + 1
    return candidate


def _rank(flag: Flag) -> tuple[float, int, str, str]:
    return -flag.score, flag.start, flag.joint, flag.id
