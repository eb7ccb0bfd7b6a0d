"""The learnt decision: what is known of a context, and the trees learnt from it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning import own_rate
from mocapstudio.cleaning.decision.features import COLUMN, Surroundings, features
from mocapstudio.cleaning.decision.forest import Forest, as_probability
from mocapstudio.cleaning.decision.matching import LEAST_FRAMES, Matches, match
from mocapstudio.cleaning.decision.root_features import root_features
from mocapstudio.cleaning.decision.spans import judged
from mocapstudio.cleaning.decision.surroundings import moments_of
from mocapstudio.cleaning.own_rate import OwnRate
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.recording import motion_digest
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import BodyMotion, MotionTexture, texture_of

F32 = NDArray[np.float32]

_BLOCK = 72


@dataclass(frozen=True, eq=False)
class Seen:
    """Features of one motion: (S, m, .) of joints and (S, 2, .) of the root rows."""

    joints: F32
    root: F32
    matches: Matches


@dataclass(frozen=True, eq=False)
class Judge:
    """Trees that decide frame by frame: about joints, and about the two root rows."""

    joints: Forest
    root: Forest

    def odds(self, seen: Seen) -> F32:
        """(S, m + 2) log-odds of an error: joints, root position, root heading."""
        return np.hstack([self.joints.odds(seen.joints), self.root.odds(seen.root)])

    def probability(self, seen: Seen) -> F32:
        """(S, m + 2) probability of an error: joints, root position, root heading."""
        return as_probability(self.odds(seen))

    def arrays(self, suffix: str) -> dict[str, NDArray[Any]]:
        """All parts as arrays for an npz file."""
        return {**self.joints.arrays(f"joints{suffix}"), **self.root.arrays(f"root{suffix}")}

    @staticmethod
    def from_arrays(arrays: Any, suffix: str) -> Judge:
        """Inverse of `arrays`; KeyError where a part is missing."""
        parts = (Forest.from_arrays(arrays, f"{name}{suffix}") for name in ("joints", "root"))
        return Judge(*parts)


@dataclass(frozen=True, eq=False)
class Bench:
    """A judge who knows the context and one who knows motion in general, weighing their odds.

    Parameters
    ----------
    own
        Learnt from the context.
    general
        Learnt from many other contexts, see `general.general_judge`.
    share
        0..1 weight of the general one.
    """

    own: Judge
    general: Judge
    share: float

    def probability(self, seen: Seen) -> F32:
        """(S, m + 2) probability of an error: joints, root position, root heading."""
        own, general = self.own.odds(seen), self.general.odds(seen)
        return as_probability((1.0 - self.share) * own + self.share * general)


@dataclass(frozen=True, eq=False)
class Decision:
    """What was learnt from a context; it serves any take that is compared with the same joints.

    Parameters
    ----------
    joints
        Names of the m joints.
    usual
        (5, m) what is usual for clean takes, see `features.USUAL`.
    judges
        One, or two where a take was all there was to learn from: each learnt from one half of its
        frames (see `halves`) and judges the other.
    spans
        Trees that judge candidate spans.
    doubts
        Spans of the context's own takes that look wrong, by `motion_digest`: they serve no repair.
    """

    joints: tuple[str, ...]
    usual: F32
    judges: tuple[Bench, ...]
    spans: Forest
    doubts: Mapping[str, tuple[Declared, ...]] = field(default_factory=dict)

    def doubted(self, context: Iterable[Take]) -> tuple[tuple[Declared, ...], ...]:
        """Spans that look wrong in each take of a context."""
        if not self.doubts:
            return ()
        return tuple(self.doubts.get(motion_digest(take), ()) for take in context)

    def probabilities(self, motion: BodyMotion, around: Surroundings) -> tuple[F32, F32]:
        """Decide about every row and frame of a motion at 24 fps.

        Parameters
        ----------
        motion
            Of the same joints.
        around
            What it is compared with, without itself.

        Returns
        -------
        probability
            (S, m + 2) that the row is erroneous: joints, root position, root heading.
        residual
            (S, m) degrees to the mean of the neighbours that were found without the limb.
        """
        seen = examine(motion, replace(around, usual=self.usual))
        frames, joints = len(texture_of(motion)), len(self.joints)
        if seen is None:
            return np.zeros((frames, joints + 2), np.float32), np.zeros(
                (frames, joints), np.float32
            )
        first = (
            crossed((self.judges[0], self.judges[1]), seen, halves(frames, 0, 1))
            if len(self.judges) == 2
            else self.judges[0].probability(seen)
        )
        probability = judged(first, seen.joints, around.limb, self.spans)
        name = "context mean" if len(around.textures) else "own mean"
        return probability, np.nan_to_num(seen.joints[..., COLUMN[name]])


def examine(motion: BodyMotion, around: Surroundings, barred: Sequence[int] = ()) -> Seen | None:
    """Compute all features of a motion; None where it is too short for a window."""
    texture = texture_of(motion)
    if len(texture) < LEAST_FRAMES:
        return None
    if not around.textures:
        # A take that is its own context brings its errors along, in the examples as in earnest.
        around = replace(around, moments=moments_of(texture, around.centre))
    rates = pooled(own_rate.of_motion(motion), texture)
    slide = pool(motion.slide.astype(np.float32)[:, None], texture)[:, 0]
    matches = match(texture, around.textures, around.limb, barred)
    return Seen(
        features(motion, texture, around, matches, rates),
        root_features(texture, list(around.textures), matches, rates, slide),
        matches,
    )


def halves(frames: int, take: int, takes: int) -> NDArray[np.int64]:
    """(S,) which half each frame belongs to: whole takes, or blocks of three seconds of one."""
    if takes > 1:
        return np.full(frames, take % 2, dtype=np.int64)
    return np.arange(frames) // _BLOCK % 2


def crossed(judges: tuple[Bench, Bench], seen: Seen, half: NDArray[np.int64]) -> F32:
    """(S, m + 2) probabilities, every frame judged by the half it does not belong to."""
    of_first, of_second = (judge.probability(seen) for judge in judges)
    return np.asarray(np.where((half == 0)[:, None], of_second, of_first), dtype=np.float32)


def pooled(rates: OwnRate, texture: MotionTexture) -> OwnRate:
    """Highest pops and jitter of the own frames that are nearest to each 24 fps frame."""
    return OwnRate(pool(rates.pops, texture), pool(rates.jitter, texture))


def pool(values: NDArray[np.float32], texture: MotionTexture) -> NDArray[np.float32]:
    """Largest of (F, n) values at the own rate around each texture frame, (S, n)."""
    edges = np.round((np.arange(len(texture)) - 0.5) * texture.frames_each).astype(np.int64)
    edges = np.clip(edges, 0, len(values) - 1)
    return np.asarray(np.maximum.reduceat(values, edges, axis=0))
