"""Takes with planted feet whose contacts are known exactly, for tests of contacts."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np

from mocapstudio.evaluation.contacts_cases import ContactCase, made_case
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take


@cache
def planted(kind: str) -> ContactCase:
    """The first seconds of a made take; all kinds are of one walk."""
    return cut(made_case(kind, "test", 7))


def cut(case: ContactCase, seconds: float = 12.0) -> ContactCase:
    frames = round(seconds * float(case.take.rate))
    take = case.take.with_motion(case.take.rotations[:frames], case.take.translations[:frames])
    return replace(
        case,
        take=take,
        truth={key: mask[:frames] for key, mask in case.truth.items()},
        sure={key: mask[:frames] for key, mask in case.sure.items()},
    )


def scaled(take: Take, factor: float) -> Take:
    skeleton = replace(
        take.skeleton,
        offsets=take.skeleton.offsets * factor,
        end_offsets=take.skeleton.end_offsets * factor,
    )
    return replace(take, skeleton=skeleton, translations=take.translations * factor)


def without_tips(take: Take) -> Take:
    """End sites of no length, as many conversions leave them."""
    return replace(
        take, skeleton=replace(take.skeleton, end_offsets=take.skeleton.end_offsets * 0.0)
    )


def rod(places: np.ndarray, rotations: np.ndarray, rate: Fraction) -> Take:
    """A prop of one joint: (F, 3) places, (F, 4) rotations."""
    skeleton = Skeleton(
        ("Rod",),
        np.array([-1]),
        np.zeros((1, 3)),
        np.array([0]),
        np.array([[0.0, 0.5, 0.0]]),
    )
    return Take("rod", skeleton, rotations[:, None], places[:, None], rate)
