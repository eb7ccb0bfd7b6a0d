"""Flags of the latest analysis merged with what was decided before."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import replace

from mocapstudio.cleaning.model import Flag, Kind
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


def merge(flags: Iterable[Flag], decisions: Iterable[Decision]) -> tuple[QueueItem, ...]:
    """Return the queue: every flag and every decided flag, worst first.

    A decision whose own flag is raised again speaks for that one only. Any other flag takes the
    verdict of the decision that fits it best: of its kind, by frames shared, by likeness of the
    spans, the later one. Decisions that no flag took stay listed as no longer flagged, so that
    none ever disappears. Deferred flags come after the others, and after them those no longer
    flagged.

    Parameters
    ----------
    flags
        Flags of the latest analysis of one performer.
    decisions
        Decisions on the same performer, oldest first.
    """
    flags, decided = tuple(flags), tuple(decisions)
    places = {_place(flag) for flag in flags}
    own: dict[_Place, Decision] = {}
    others: defaultdict[str, list[Decision]] = defaultdict(list)
    for decision in decided:
        if _place(decision.flag) in places:
            own[_place(decision.flag)] = decision
        else:
            others[decision.flag.joint].append(decision)
    items: list[QueueItem] = []
    taken: set[int] = set()
    for flag in flags:
        best = own.get(_place(flag)) or _best(flag, others[flag.joint])
        if best is None:
            items.append(QueueItem(flag, Verdict.OPEN))
        else:
            taken.add(id(best))
            items.append(QueueItem(flag, best.verdict, True, best))
    ids = {item.flag.id for item in items}
    for decision in decided:
        if id(decision) not in taken:
            flag = replace(decision.flag, id=_free_id(decision.flag.id, ids))
            ids.add(flag.id)
            items.append(QueueItem(flag, decision.verdict, False, decision))
    return tuple(sorted(items, key=_order))


_Place = tuple[str, int, int, Kind]


def _place(flag: Flag) -> _Place:
    return flag.joint, flag.start, flag.end, flag.kind


def _best(flag: Flag, decisions: list[Decision]) -> Decision | None:
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


def _order(item: QueueItem) -> tuple[int, float, int, str, str]:
    group = 2 if not item.current else int(item.verdict is Verdict.DEFERRED)
    return group, -item.flag.score, item.flag.start, item.flag.joint, item.flag.id
