"""The performance that streams are aligned with: its poses, and how they move."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from mocapstudio.comparison.labels import Labels
from mocapstudio.comparison.online_features import (
    F32,
    Features,
    Recording,
    completed,
    features_of,
    unit_rows,
)
from mocapstudio.motion.errors import MocapError
from mocapstudio.similarity.online import kernels

MOTION = " motion"
"""Ending of the names of rows that hold how a joint or bone has moved."""

MOTION_SECONDS = 0.2
"""Over how long that is: long enough to rise above noise, short against a gesture."""

MOTION_WEIGHT = 2.0
"""Weight of those rows where none was learnt, against 1 of the poses themselves."""

ROOT_WEIGHT = 6.0
"""Weight of the root where none was learnt, against 1 of another joint: it turns the whole body,
and tells walking on from turning, in which the legs do the same."""

_FEWEST = 3


@dataclass(frozen=True, eq=False)
class Reference:
    """The performance that others are aligned with, R frames at the rate of alignment.

    Parameters
    ----------
    name
        Of the take.
    features
        What is compared of a pose, D rows.
    rows
        (R, N, 4) without gaps: the D rows of each pose, turned as the action begins; with motion
        another D: the rotation of each since `MOTION_SECONDS` before.
    rate
        Frames a second of `rows`.
    own_rate
        Frames a second of the take.
    start
        The take's own frame that is the first here.
    """

    name: str
    features: Features
    rows: F32
    rate: float
    own_rate: Fraction
    start: int = 0

    def __len__(self) -> int:
        return len(self.rows)

    @property
    def motion(self) -> bool:
        """Whether rows tell how joints move."""
        return bool(self.rows.shape[1] > len(self.features.names))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the N rows: joints or bones, then the same with the ending `MOTION`."""
        names = self.features.names
        return names + tuple(name + MOTION for name in names) if self.motion else names

    @property
    def directions(self) -> int:
        """How many of the rows, from the first, are directions and not rotations."""
        return len(self.features.names) if self.features.directions else 0

    @property
    def plain_weights(self) -> F32:
        """(N,) weights where none were learnt; all alike without motion, as in paper 3."""
        return self.weights(ROOT_WEIGHT if self.motion else 1.0, MOTION_WEIGHT)

    def weights(self, root: float, motion: float) -> F32:
        """(N,) weights of 1, `root` for the root, all times `motion` for the motion rows."""
        poses = pose_weights(self.features, root)
        return np.concatenate([poses, motion * poses]) if self.motion else poses

    def own_frame(self, at: int) -> int:
        """Frame of the take, 0-based at its own rate, nearest to a frame of `rows`."""
        return self.start + round(at * float(self.own_rate) / self.rate)

    def segment_names(self, labels: Labels) -> list[str | None]:
        """Return the segment of each of the R frames, None between segments.

        The labels count in frames of the take.
        """
        labels = labels.at_rate(self.own_rate)
        return [labels.at(self.own_frame(i)) for i in range(len(self))]


def pose_weights(features: Features, root: float = ROOT_WEIGHT) -> F32:
    """(D,) weights of 1, `root` for the root."""
    weights = np.ones(len(features.names), np.float32)
    if features.root is not None:
        weights[features.root] = root
    return weights


def reference_of(
    take: Recording,
    streams: tuple[Recording, ...] = (),
    rate: Fraction | float | None = None,
    *,
    motion: bool = True,
    features: Features | None = None,
) -> Reference:
    """Prepare a take as a reference for streams.

    Parameters
    ----------
    take
        The reference; its trimmed span is the action.
    streams
        Takes that are going to be aligned with it: only what all of them have is compared.
    rate
        Frames a second of the alignment: the take's own by default. Streams of about this rate
        align best, since the paths then run near the diagonal.
    motion
        Whether how joints move counts beside their poses; paper 3 compares poses alone.
    features
        What is compared, in place of what the takes have in common.

    Raises
    ------
    SkeletonMismatchError
        If the takes have too little in common.
    MocapError
        If the reference has fewer than three frames.
    """
    features = features or features_of(take, streams)
    raw = completed(features.of(take))
    turn = features.start(raw[0])
    poses = raw if turn is None else features.turned(raw, turn)
    if rate is not None and float(rate) != float(take.rate):
        poses = _sampled(poses, float(take.rate) / float(rate))
    if len(poses) < _FEWEST:
        raise MocapError(f"{take.name}: {len(poses)} frames are too few for a reference")
    each = float(rate or take.rate)
    rows = with_motion(poses, each, features.directions) if motion else poses
    return Reference(take.name, features, rows, each, take.rate, take.span[0])


def with_motion(poses: F32, rate: float, directions: bool) -> F32:
    """(F, 2 D, 4): poses (F, D, 4) and how each row turned over the last `MOTION_SECONDS`.

    Early frames are compared with the first.
    """
    lag = max(1, round(MOTION_SECONDS * rate))
    rows = np.concatenate([poses, np.empty_like(poses)], axis=1)
    joints = poses.shape[1]
    for i in range(len(poses)):
        kernels.displacements(poses[max(i - lag, 0)], poses[i], directions, rows[i, joints:])
    return rows


def _sampled(poses: F32, each: float) -> F32:
    count = int((len(poses) - 1) / each + 1e-6) + 1
    at = np.arange(count) * each
    low = np.minimum(at.astype(np.int64), max(len(poses) - 2, 0))
    part = (at - low).astype(np.float32)[:, None, None]
    a, b = poses[low], poses[np.minimum(low + 1, len(poses) - 1)]
    return unit_rows(a * (1 - part) + b * part)
