"""Which flags are repaired by one proposal."""

from __future__ import annotations

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.model import Flag
from mocapstudio.cleaning.repair.material import is_repaired
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

_ALIKE = 0.5


def together(
    analysis: Analysis, flag: Flag, take: Take, *, both_sides: bool = False
) -> tuple[Flag, ...]:
    """Flags whose joints belong to one repair, `flag` first.

    Those of the same limb or swap that overlap in time, and those of parents and children that
    share most of their frames: joints that are wrong against each other look worse repaired one
    by one. Flags of which `take` has been repaired already are left out.

    Parameters
    ----------
    analysis, flag, take
        As in `proposals.propose`.
    both_sides
        Whether flags of mirror images that share most of their frames belong to it too, as where
        the sides have been exchanged.
    """
    index, parents = take.skeleton.index, take.skeleton.parents
    mirror = topology(take.skeleton).mirror

    def related(a: int, b: int) -> bool:
        return b in (parents[a], mirror[a] if both_sides else a) or a == parents[b]

    left = [
        one
        for one in analysis.flags
        if one.id != flag.id
        and one.joint not in (flag.joint, *ROOT_ROWS)
        and one.overlaps(flag.start, flag.end)
        and not is_repaired(analysis.take, take, one)
    ]
    found, grown = [flag], True
    while grown:
        grown = False
        for one in list(left):
            near = one.joint in flag.joints or any(
                _alike(one, mate) and related(index[one.joint], index[mate.joint]) for mate in found
            )
            if near:
                left.remove(one)
                found.append(one)
                grown = True
    return tuple(found)


def _alike(one: Flag, other: Flag) -> bool:
    shared = min(one.end, other.end) - max(one.start, other.start)
    return shared > _ALIKE * (max(one.end, other.end) - min(one.start, other.start))
