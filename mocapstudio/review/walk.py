"""Where to go next: through the queue, and between performers on the scene's clock."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from mocapstudio.review.model import Performer, QueueItem, Verdict

_UNDECIDED = (Verdict.OPEN, Verdict.DEFERRED)


def same_moment(before: Performer | None, to: Performer, frame: int) -> int:
    """Frame of `to` at the moment of the scene at which `before` shows `frame`."""
    if before is None:
        return 0
    seconds = before.offset + before.take.seconds(frame) - to.offset
    return min(max(round(seconds * float(to.take.rate)), 0), to.take.frames - 1)


def place(queue: Sequence[QueueItem], flag_id: str | None) -> int | None:
    """Line of the queue that shows a flag, or None."""
    return next((i for i, item in enumerate(queue) if item.flag.id == flag_id), None)


def following(queue: Sequence[QueueItem], decided: Iterable[str]) -> QueueItem | None:
    """Return the next undecided item after the last of those just decided, around the end."""
    ids = set(decided)
    last = max((i for i, item in enumerate(queue) if item.flag.id in ids), default=-1)
    rest = [*queue[last + 1 :], *queue[: last + 1]]
    left = [i for i in rest if i.verdict in _UNDECIDED and i.current and i.flag.id not in ids]
    return next((i for i in left if i.verdict is Verdict.OPEN), left[0] if left else None)


def next_item(
    queue: Sequence[QueueItem],
    selected: str | None,
    step: int,
    undecided: bool,
    resume: tuple[str, int] | None,
) -> str | None:
    """Id of the flag `step` lines on from the selected one, around the ends; None where none is.

    Parameters
    ----------
    undecided
        Count only lines that are open or deferred.
    resume
        A flag that went to the end of the queue when it was deferred, and the line it had left:
        the walk goes on from there.
    """
    count = len(queue)
    start = place(queue, selected)
    if start is None:
        start = -1 if step > 0 else count
    elif resume is not None and resume[0] == selected:
        start = resume[1] - 1 if step > 0 else resume[1]
    direction = 1 if step > 0 else -1
    left, at = abs(step), start
    for _ in range(count * abs(step)):
        at = (at + direction) % count
        item = queue[at]
        if undecided and item.verdict not in _UNDECIDED:
            continue
        left -= 1
        if left == 0:
            return item.flag.id
    return None
