"""Online alignment by weighted open-end time warping (paper 3, WOOE-DTW).

One frame at a time: its distance from every reference frame (equations 1 and 4) becomes a row of
accumulated costs (equation 3), and the row's smallest cost tells where in the reference the
performer is. Only the last row is kept, so a stream may go on for ever.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison.labels import Labels
from mocapstudio.comparison.online_features import F32, F64
from mocapstudio.comparison.online_reference import MOTION_SECONDS, Reference
from mocapstudio.motion.errors import MocapError, ParameterError
from mocapstudio.similarity.online import kernels

FIRST_ANSWER = 3
"""Frames of the action after which the alignment counts: with fewer it only says 'beginning'."""

_LEAST_SEEN = 0.25
_PAST = 256
_SAME_TIME = 1e-6


class Variant(StrEnum):
    """How a path is accumulated."""

    PLAIN = "plain"
    """Equation 2: the smallest sum."""
    DIAGONAL = "diagonal"
    """Equation 2 with diagonal steps that cost double (Dixon 2005)."""
    PATH_LENGTH = "path length"
    """Equation 3: the smallest mean, which does not favour short paths."""


@dataclass(frozen=True)
class AlignmentStep:
    """Where the performer is after a frame.

    Parameters
    ----------
    frame
        Frame of the stream, counted from the action's first.
    reference_frame
        Matching frame of the reference take, 0-based at its own rate.
    at
        The same at the rate of alignment.
    cost
        Mean cost of a step of the path so far.
    pose_cost
        Distance of this pose from the matching one (equation 4).
    misalignment
        Seconds: positive where the performer is ahead of the reference, negative behind; None
        where the stream tells no time.
    label
        Segment of the reference that the matching frame lies in, or None.
    ready
        False for the action's first two frames.
    """

    frame: int
    reference_frame: int
    at: int
    cost: float
    pose_cost: float
    misalignment: float | None
    label: str | None
    ready: bool


class OnlineAligner:
    """Aligns a stream of poses with a reference, a frame at a time and in bounded memory.

    Parameters
    ----------
    reference
        R frames of N rows.
    weights
        Weight of each row by name, those that are not named 0; `Reference.plain_weights` by
        default.
    variant
        How paths are accumulated. The paper's is by path length; on every kind of motion that we
        measured, the smallest sum follows better, so it is the default where none was learnt.
    labels
        Segments of the reference take.
    path_frames
        Over how many of the latest frames `path` can be traced back; each costs R / 4 bytes.

    Raises
    ------
    ParameterError
        If no weight belongs to the reference, or a weight is negative or not finite.
    """

    def __init__(
        self,
        reference: Reference,
        weights: Mapping[str, float] | None = None,
        variant: Variant = Variant.PLAIN,
        labels: Labels | None = None,
        path_frames: int = 0,
    ) -> None:
        self.reference = reference
        self.variant = variant
        self.weights = weights_for(reference, weights)
        self._planes = np.ascontiguousarray(reference.rows.transpose(1, 2, 0))
        self._names = reference.segment_names(labels) if labels is not None else None
        size = len(reference)
        self._costs = np.empty(size, np.float32)
        self._rows = np.zeros((2, 2, size))
        self._steps = np.zeros((max(path_frames, 1), -(-size // 4)), np.uint8)
        self._traced = np.empty((len(self._steps) + size, 2), np.int64)
        self._keeps_path = path_frames > 0
        self.restart()

    def restart(self) -> None:
        """Forget the stream: the next frame is the first of an action."""
        self.frames = 0
        self._fed = 0
        self._resumed = False
        self._turn: F32 | None = None
        self._past: deque[tuple[float, F32]] = deque(maxlen=_PAST)
        self._began: float | None = None
        self._end = 0

    def feed(self, pose: F32, time: float | None = None) -> AlignmentStep | None:
        """Align the next frame.

        Parameters
        ----------
        pose
            (D, 4) as `Features.of` gives them, not yet turned. Rows of NaN are left out, and the
            others count for them.
        time
            Seconds on the stream's own clock.

        Returns
        -------
        Where the performer is, or None where less than a quarter of the weight can be seen: such
        a frame changes nothing.
        """
        if not self._is_seen(pose):
            return None
        features = self.reference.features
        turn = self._turn if self._turn is not None else features.start(pose)
        rows = self._rows_of(pose if turn is None else features.turned(pose, turn), time)
        weights = self._seen_weights(rows)
        self._turn = turn
        if weights is not self.weights:
            rows = np.nan_to_num(rows)
        kernels.pose_costs(rows, self._planes, weights, self.reference.directions, self._costs)
        return self.feed_costs(self._costs, time)

    def feed_costs(self, costs: F32, time: float | None = None) -> AlignmentStep:
        """Align the next frame by its distance (R,) from every reference frame."""
        before, now = self._rows[self.frames % 2], self._rows[1 - self.frames % 2]
        steps = self._steps[self.frames % len(self._steps)]
        by_length = self.variant is Variant.PATH_LENGTH
        diagonal = 2.0 if self.variant is Variant.DIAGONAL else 1.0
        first = self.frames == 0
        self._end = kernels.next_row(
            costs, first, by_length, diagonal, before[0], before[1], now[0], now[1], steps
        )
        if self.frames == 0:
            self._began = time
        self.frames += 1
        return self._step(float(costs[self._end]), now, time)

    def pass_over(self, frames: int) -> None:
        """Let frames pass of which nothing is known: to stand and to go on are equally likely.

        All poses cost what the path cost so far, a frame. It makes no difference before the
        first frame.
        """
        if self.frames == 0:
            return
        now = self._rows[self.frames % 2]
        usual = now[0, self._end] / now[1, self._end]
        nothing = np.full(len(self.reference), usual, np.float32)
        for _ in range(min(frames, len(self.reference))):
            self.feed_costs(nothing)
        self._past.clear()
        self._resumed = True

    def path(self) -> NDArray[np.int64]:
        """(P, 2) pairs of frames, of the reference at the rate of alignment and of the stream.

        Ascending, up to the latest frame, over as many frames as `path_frames` says.

        Raises
        ------
        MocapError
            If no path is kept, or nothing has been fed yet.
        """
        if not self._keeps_path or self.frames == 0:
            raise MocapError("no path is kept: path_frames says over how many frames")
        newest = (self.frames - 1) % len(self._steps)
        begin = kernels.trace_back(self._steps, newest, self.frames - 1, self._end, self._traced)
        return self._traced[begin:].copy()

    @property
    def pose_costs(self) -> F32:
        """(R,) distance of the pose that was fed last from every reference frame."""
        return self._costs.copy()

    def accumulated(self) -> tuple[F64, F64]:
        """Accumulated costs D (R,) and path lengths L (R,) of the latest frame."""
        now = self._rows[self.frames % 2]
        return now[0].copy(), now[1].copy()

    def _step(self, pose_cost: float, now: F64, time: float | None) -> AlignmentStep:
        end, reference = self._end, self.reference
        ahead = None
        if time is not None and self._began is not None:
            ahead = end / reference.rate - (time - self._began)
        return AlignmentStep(
            self.frames - 1,
            reference.own_frame(end),
            end,
            float(now[0, end] / now[1, end]),
            pose_cost,
            ahead,
            self._names[end] if self._names else None,
            self.frames >= FIRST_ANSWER,
        )

    def _rows_of(self, pose: F32, time: float | None) -> F32:
        """(N, 4): a turned pose and, where the reference has it, how it has moved."""
        if not self.reference.motion:
            return np.ascontiguousarray(pose)
        lag = MOTION_SECONDS if time is not None else round(MOTION_SECONDS * self.reference.rate)
        now = time if time is not None else float(self._fed)
        self._fed += 1
        past = self._past
        past.append((now, pose))
        while len(past) > 1 and past[1][0] <= now - lag + _SAME_TIME:
            past.popleft()
        rows = np.empty((2 * len(pose), 4), np.float32)
        rows[: len(pose)] = pose
        directions = self.reference.features.directions
        kernels.displacements(past[0][1], rows[: len(pose)], directions, rows[len(pose) :])
        self._resumed &= past[0][0] > now - lag + _SAME_TIME
        if self._resumed:
            rows[len(pose) :] = np.nan
        return rows

    def _is_seen(self, pose: F32) -> bool:
        # One sum is the cheapest test for any NaN.
        if not np.isnan(pose.sum()):
            return True
        seen = ~np.isnan(pose).any(axis=1)
        weights = self.weights.reshape(-1, len(pose)).sum(axis=0)
        return bool(weights[seen].sum() >= _LEAST_SEEN * weights.sum())

    def _seen_weights(self, rows: F32) -> F32:
        """(N,) the weights, those of missing rows dealt out to the others."""
        if not np.isnan(rows.sum()):
            return self.weights
        seen = np.where(np.isnan(rows).any(axis=1), np.float32(0.0), self.weights)
        share = float(seen.sum()) / float(self.weights.sum())
        return np.asarray(seen / share if share > 0 else seen, dtype=np.float32)


def weights_for(reference: Reference, weights: Mapping[str, float] | None) -> F32:
    """(N,) weights of the reference's rows; those not named are 0.

    Raises
    ------
    ParameterError
        If none of them belongs to a row, or a weight is negative or not finite.
    """
    if weights is None:
        return reference.plain_weights
    for name, weight in weights.items():
        if not (np.isfinite(weight) and weight >= 0):
            raise ParameterError(f"weight {weight} of {name}: a number of at least 0 is wanted")
    found = np.array([weights.get(name, 0.0) for name in reference.names], np.float32)
    if not found.any():
        raise ParameterError("no joint of the reference has a weight")
    return found
