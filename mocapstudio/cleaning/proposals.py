"""What is offered instead of a flagged span (paper 1, section 4).

Flagged joints take what the other joints and both flanks let expect, or, where one is chosen, the
motion of a neighbour: time-warped to the span, led into what stays at both ends. Sides that were
exchanged are exchanged once more. See the package `repair`.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import numpy as np
from threadpoolctl import threadpool_limits

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.model import Flag, Proposal
from mocapstudio.cleaning.reasons import neighbours
from mocapstudio.cleaning.repair.joints import propose_joints
from mocapstudio.cleaning.root_proposals import propose_heading, propose_position
from mocapstudio.motion.errors import ParameterError
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION, ROOT_ROWS, carrier
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology


def propose(
    analysis: Analysis, flag: Flag, choice: int | None = None, onto: Take | None = None
) -> Proposal:
    """Make the replacement motion for one flag, and for those that belong to one repair with it.

    Parameters
    ----------
    analysis
        The analysis that raised the flag.
    flag
        What to replace: its own row over its span; with a joint also the flagged joints of its
        limb, of its swap, and parents and children that are wrong at the same time.
    choice
        Which of `reasons.neighbours` to take as donor, counted from 0; None for the engine's own
        choice.
    onto
        The take as it is by now, where repairs of other flags share the joints: the replacement
        joins these, and keeps the heading or the tilt that they gave the hips.

    Raises
    ------
    ParameterError
        If there is no such neighbour.
    """
    take = analysis.take if onto is None else onto
    donor = None
    if choice is not None and flag.joint not in ROOT_ROWS:
        near = neighbours(analysis, flag)
        if not 0 <= choice < len(near):
            raise ParameterError(f"there is no neighbour {choice + 1} for this flag")
        donor = near[choice]
    # Small systems are solved ten times slower by threads that wait for each other.
    with threadpool_limits(1, "blas"):
        if flag.joint == ROOT_POSITION:
            proposal = propose_position(analysis, flag, take)
        elif flag.joint == ROOT_HEADING:
            proposal = propose_heading(analysis, flag, take)
        else:
            proposal = propose_joints(analysis, flag, take, donor)
    return measured(take, proposal)


def apply(take: Take, proposal: Proposal) -> Take:
    """Return the take with the proposal's samples in place of its own."""
    rotations, translations = take.rotations, take.translations
    if proposal.joints:
        rotations = rotations.copy()
        columns = [take.skeleton.index[name] for name in proposal.joints]
        rotations[proposal.start : proposal.end, columns] = proposal.rotations
    if proposal.translations is not None:
        translations = translations.copy()
        translations[proposal.start : proposal.end, carrier(take)] = proposal.translations
    return take.with_motion(rotations, translations)


def measured(take: Take, proposal: Proposal, own: Collection[str] | None = None) -> Proposal:
    """Add how far hands, feet and head outside the joints move.

    Parameters
    ----------
    take
        What the proposal is put over.
    own
        Names of the joints that are repaired, where the proposal bends others besides.
    """
    skeleton = take.skeleton
    changed = {skeleton.index[name] for name in (proposal.joints if own is None else own)}
    inner = topology(skeleton).details
    ends = [
        limb.joints[-1] if not set(limb.joints) & inner else _last_outside(limb.joints, inner)
        for limb in topology(skeleton).limbs
        if limb.name != "spine"
    ]
    span = slice(proposal.start, proposal.end)
    before, _ = take_pose(take, span.start, span.stop)
    short = replace(
        take, rotations=take.rotations[span], translations=take.translations[span], trim=None
    )
    moved = apply(short, replace(proposal, start=0, end=span.stop - span.start))
    after, _ = take_pose(moved)
    far = np.linalg.norm(after - before, axis=-1).max(axis=0)
    return replace(
        proposal,
        displacement={
            skeleton.names[j]: float(far[j]) for j in ends if j not in changed and far[j] > 1e-6
        },
    )


def _last_outside(joints: tuple[int, ...], inner: frozenset[int]) -> int:
    return [j for j in joints if j not in inner][-1]
