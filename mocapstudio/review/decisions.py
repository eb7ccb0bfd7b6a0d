"""What each decision makes of a sitting: pure functions from sitting to sitting."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.model import Flag, Proposal
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology
from mocapstudio.review.model import Decision, Edit, QueueItem, Sitting, Verdict
from mocapstudio.review.rows import check_rows, check_span


@dataclass(frozen=True)
class Stamp:
    """Who decides, when (UTC, ISO 8601), and in which group."""

    author: str
    time: str
    group: str


def edit_of(
    take: Take, performer: str, proposal: Proposal, stamp: Stamp, edit_id: str, flag: Flag | None
) -> Edit:
    """Make a stored edit of a proposal.

    The samples are copied, their quaternions continued in sign from the frame before.

    Raises
    ------
    MocapError
        If the proposal does not fit the take.
    """
    check_rows(take, proposal.joints)
    check_span(take, proposal.start, proposal.end)
    rows = _declared_rows(take, proposal, flag)
    what = f"the proposal for {', '.join(rows)}"
    if not rows:
        raise MocapError("the proposal changes nothing")
    shape = (proposal.end - proposal.start, len(proposal.joints), 4)
    moved = proposal.translations
    fits = moved is None or moved.shape == (shape[0], 3)
    if proposal.rotations.shape != shape or not fits:
        raise MocapError(f"{what} has samples of odd shape")
    finite = np.isfinite(proposal.rotations).all() and (moved is None or np.isfinite(moved).all())
    if not finite:
        raise MocapError(f"{what} has missing samples")
    return Edit(
        edit_id,
        performer,
        rows,
        proposal.joints,
        proposal.start,
        proposal.end,
        _continued(take, proposal),
        None if moved is None else _frozen(np.array(moved, dtype=np.float64)),
        proposal.method,
        proposal.donor,
        None if flag is None else flag.id,
        stamp.group,
        stamp.author,
        stamp.time,
    )


def _declared_rows(take: Take, proposal: Proposal, flag: Flag | None) -> tuple[str, ...]:
    """Name the rows as the flag does: the hips' rotation of a heading flag is its root row."""
    hips = take.skeleton.names[topology(take.skeleton).hips]
    heading = flag is not None and flag.joint == ROOT_HEADING
    rows = tuple(ROOT_HEADING if heading and j == hips else j for j in proposal.joints)
    return rows if proposal.translations is None else (*rows, ROOT_POSITION)


def _continued(take: Take, proposal: Proposal) -> NDArray[np.float64]:
    joints = [take.skeleton.index[name] for name in proposal.joints]
    before = take.rotations[max(0, proposal.start - 1)][joints]
    before = np.where(np.isfinite(before).all(axis=-1, keepdims=True), before, rot.IDENTITY)
    chain = np.concatenate([before[None], np.asarray(proposal.rotations, dtype=np.float64)])
    return _frozen(np.array(rot.continuous(chain)[1:]))


def _frozen(samples: NDArray[np.float64]) -> NDArray[np.float64]:
    samples = np.ascontiguousarray(samples)
    samples.setflags(write=False)
    return samples


def decide(
    sitting: Sitting,
    performer: str,
    queue: Sequence[QueueItem],
    items: Sequence[QueueItem],
    verdict: Verdict,
    stamp: Stamp,
    edits: Sequence[Edit] = (),
) -> Sitting:
    """Give flags a verdict, in place of what was decided about them before.

    The edits of earlier decisions go with them. Where several flags of the queue rest on one
    earlier decision, those not decided now keep its verdict, or become open if it had an edit.

    Parameters
    ----------
    queue
        The queue as shown, of the same performer.
    items
        Those of its items to decide; open ones are reopened, which leaves no decision.
    edits
        For accepted flags: their edits, in the order of `items`.
    """
    decided = {item.flag.id for item in items}
    gone = {id(item.decision): item.decision for item in items if item.decision is not None}
    edit_ids = {d.edit for d in gone.values() if d.edit is not None}
    heirs = [
        replace(item.decision, flag=item.flag)
        for item in queue
        if item.decision is not None
        and id(item.decision) in gone
        and item.decision.edit is None
        and item.flag.id not in decided
    ]
    kept = [d for d in sitting.decisions if id(d) not in gone]
    fresh = [] if verdict is Verdict.OPEN else list(_fresh(performer, items, verdict, stamp, edits))
    return replace(
        sitting,
        edits=(*(e for e in sitting.edits if e.id not in edit_ids), *edits),
        decisions=(*kept, *heirs, *fresh),
    )


def _fresh(
    performer: str,
    items: Sequence[QueueItem],
    verdict: Verdict,
    stamp: Stamp,
    edits: Sequence[Edit],
) -> Iterable[Decision]:
    edit_ids: list[str | None] = [edit.id for edit in edits] or [None] * len(items)
    for item, edit_id in zip(items, edit_ids, strict=True):
        yield Decision(performer, item.flag, verdict, stamp.author, stamp.time, edit_id)


def same_samples(edit: Edit, other: Edit) -> bool:
    """Tell whether two edits put the same samples at the same place."""
    if (edit.rows, edit.joints, edit.start, edit.end) != (
        other.rows,
        other.joints,
        other.start,
        other.end,
    ):
        return False
    if (edit.translations is None) != (other.translations is None):
        return False
    moved = edit.translations is None or np.array_equal(
        edit.translations, np.asarray(other.translations)
    )
    return bool(moved and np.array_equal(edit.rotations, other.rotations))


def without_edit(sitting: Sitting, edit_id: str) -> Sitting:
    """Delete an edit; the flag it was accepted for becomes open again."""
    return replace(
        sitting,
        edits=tuple(e for e in sitting.edits if e.id != edit_id),
        decisions=tuple(d for d in sitting.decisions if d.edit != edit_id),
    )


def with_edit_muted(sitting: Sitting, edit_id: str, muted: bool) -> Sitting:
    """Switch an edit off or on."""
    edits = tuple(
        replace(e, muted=muted) if e.id == edit_id and e.muted != muted else e
        for e in sitting.edits
    )
    return replace(sitting, edits=edits)


def alike(item: QueueItem, queue: Iterable[QueueItem], band: float) -> list[QueueItem]:
    """Open flags of the same row and kind with a score within `band`, `item` among them."""
    return [
        other
        for other in queue
        if other is item
        or (
            other.current
            and other.verdict is Verdict.OPEN
            and other.flag.joint == item.flag.joint
            and other.flag.kind == item.flag.kind
            and abs(other.flag.score - item.flag.score) <= band
        )
    ]
