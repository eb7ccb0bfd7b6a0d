"""Examples to learn from: takes of a context, spoilt again and again, and what is seen of them.

1. Every take is compared with the others: what residual is usual for a joint; 2. errors are put
into it, half of the time with the nearest takes left out, so that novelty is learnt as normal;
3. nothing near an impossibly fast rotation counts as clean.
"""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.decision import breaks
from mocapstudio.cleaning.decision.features import COLUMN, USUAL, Surroundings
from mocapstudio.cleaning.decision.matching import LEAST_FRAMES, nearest_takes
from mocapstudio.cleaning.decision.model import Seen, examine, halves, pool
from mocapstudio.cleaning.decision.spoiling import Anatomy, spoil
from mocapstudio.cleaning.decision.surroundings import anatomy_of, mean_pose, moments_of
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.recording import motion_digest
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import (
    BodyMotion,
    MotionTexture,
    body_motion,
    comparable_joints,
    texture_of,
)

F32 = NDArray[np.float32]

FRAMES_WANTED = 20_000
_VARIANTS = (2, 16)
_LEAST_USUAL = np.array([2.0, 2.0, 2.0, 0.1, 0.1], dtype=np.float32)
_MOST_DROPPED = 10
_IN_UNITS = [COLUMN[f"{name} usual"] for name in USUAL]


class TooLittleToLearnError(MocapError):
    """A context from which no decision can be learnt."""


@dataclass(frozen=True, eq=False)
class Known:
    """One take of the context, by its `motion_digest`, and what it is compared with."""

    digest: str
    motion: BodyMotion
    texture: MotionTexture
    around: Surroundings


@dataclass(frozen=True, eq=False)
class Example:
    """One spoilt take: what is seen of it, labels, and which half its frames belong to."""

    take: int
    seen: Seen
    labels: NDArray[np.int8]
    half: NDArray[np.int64]

    def doubting(self, doubtful: NDArray[np.bool_]) -> Example:
        """Call nothing clean where it is doubtful, (S, m + 2)."""
        return replace(self, labels=np.where(doubtful & (self.labels == 0), -1, self.labels))

    def only(self, half: int) -> Example:
        """Take the other half's labels away."""
        return replace(self, labels=np.where((self.half == half)[:, None], self.labels, -1))


@dataclass(frozen=True, eq=False)
class Made:
    """All examples of a context, and what they were made from.

    Attributes
    ----------
    joints
        Names of the m compared joints.
    usual
        (5, m) what is usual for clean takes, see `features.USUAL`.
    seen
        What is seen of each take as it came; None where it is too short.
    """

    joints: tuple[str, ...]
    anatomy: Anatomy
    takes: tuple[Known, ...]
    usual: F32
    seen: tuple[Seen | None, ...]
    examples: tuple[Example, ...]


def examples_of(
    context: Sequence[Take],
    joints: Sequence[str] | None,
    rng: np.random.Generator,
    frames_wanted: int = FRAMES_WANTED,
) -> Generator[Progress, None, Made]:
    """Make examples from the takes of a context.

    Parameters
    ----------
    context
        Takes of one skeleton, presumably mostly clean. A single one is compared with itself.
    joints
        Names of the joints to compare, or None for those that all takes have.
    rng
        Chooses the errors.
    frames_wanted
        At 24 fps, of spoilt takes; each take comes 2 to 16 times.

    Raises
    ------
    TooLittleToLearnError
        If no take is as long as a window.
    """
    yield Progress(0.0, "preparing the context")
    names = tuple(joints) if joints is not None else comparable_joints(context[0], context[1:])
    anatomy = anatomy_of(context[0].skeleton, names)
    motions = {motion_digest(take): body_motion(take, names) for take in context}
    motions = {k: one for k, one in motions.items() if len(texture_of(one)) >= LEAST_FRAMES}
    if not motions:
        raise TooLittleToLearnError("no take of the context is long enough to learn from")
    takes = _each_without_itself(motions, anatomy)
    plainly = yield from _seen(takes)
    usual = _usual(plainly)
    seen = tuple(None if one is None else _in_units(one, usual) for one in plainly)
    takes = [replace(one, around=replace(one.around, usual=usual)) for one in takes]
    spoilt = yield from _spoilt(takes, anatomy, rng, frames_wanted)
    right = tuple(_without_breaks(spoilt, takes))
    return Made(names, anatomy, tuple(takes), usual, seen, right)


def _without_breaks(examples: Sequence[Example], takes: Sequence[Known]) -> list[Example]:
    """Take what surrounds impossibly fast rotations of the context itself for unknown."""
    limit = breaks.limits([one.motion for one in takes])
    doubts = {i: breaks.doubtful(one.motion, one.texture, limit) for i, one in enumerate(takes)}
    return [one.doubting(doubts[one.take]) for one in examples]


def _each_without_itself(motions: Mapping[str, BodyMotion], anatomy: Anatomy) -> list[Known]:
    textures = [texture_of(one) for one in motions.values()]
    centre = mean_pose(textures)
    moments = [moments_of(one, centre) for one in textures]
    total = moments[0]
    for one in moments[1:]:
        total = total + one
    takes = []
    for i, ((digest, motion), texture) in enumerate(zip(motions.items(), textures, strict=True)):
        others = [other for k, other in enumerate(textures) if k != i]
        rest = total - moments[i] if others else total
        takes.append(
            Known(digest, motion, texture, Surroundings(others, rest, centre, anatomy.limb))
        )
    return takes


def _seen(takes: Sequence[Known]) -> Generator[Progress, None, list[Seen | None]]:
    """Look at all takes as they came, every take without itself."""
    found = []
    for i, one in enumerate(takes):
        yield Progress(0.08 + 0.15 * i / len(takes), "measuring what is usual")
        found.append(examine(one.motion, one.around))
    return found


def _usual(seen: Sequence[Seen | None]) -> F32:
    """(5, m) 98 % quantiles of clean takes' own residuals."""
    found = [one.joints[..., _IN_UNITS] for one in seen if one is not None]
    quantiles = np.nanquantile(np.concatenate(found), 0.98, axis=0).T
    return np.asarray(np.maximum(np.nan_to_num(quantiles), _LEAST_USUAL[:, None]), dtype=np.float32)


def _in_units(seen: Seen, usual: F32) -> Seen:
    """Give residuals that were measured as they are in units of what is usual."""
    joints = seen.joints.copy()
    joints[..., _IN_UNITS] /= usual.T
    return replace(seen, joints=joints)


def _spoilt(
    takes: Sequence[Known], anatomy: Anatomy, rng: np.random.Generator, frames_wanted: int
) -> Generator[Progress, None, list[Example]]:
    frames = sum(len(one.texture) for one in takes)
    variants = int(np.clip(round(frames_wanted / frames), *_VARIANTS))
    examples = []
    for n in range(variants * len(takes)):
        yield Progress(0.23 + 0.77 * n / (variants * len(takes)), "making examples of errors")
        one, variant = takes[n % len(takes)], n // len(takes)
        motion, label = spoil(one.motion, anatomy, rng)
        seen = examine(motion, one.around)
        if seen is None:
            continue
        if variant % 2 and len(one.around.textures) > 2:
            seen = _without_nearest(motion, one, seen, rng)
        take, labels = n % len(takes), _pooled_labels(label, one.texture)
        examples.append(Example(take, seen, labels, halves(len(labels), take, len(takes))))
    return examples


def _without_nearest(motion: BodyMotion, one: Known, seen: Seen, rng: np.random.Generator) -> Seen:
    most = min(_MOST_DROPPED, len(one.around.textures) - 1)
    barred = nearest_takes(seen.matches)[: int(rng.integers(1, most + 1))]
    again = examine(motion, one.around, barred.tolist())
    return again if again is not None else seen


def _pooled_labels(label: NDArray[np.int8], texture: MotionTexture) -> NDArray[np.int8]:
    wrong = pool((label == 1).astype(np.float32), texture)
    unsure = pool((label != 0).astype(np.float32), texture)
    return np.where(wrong > 0, 1, np.where(unsure > 0, -1, 0)).astype(np.int8)
