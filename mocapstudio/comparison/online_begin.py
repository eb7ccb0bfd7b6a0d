"""Where an action begins and ends in a stream: follow it when it does, and wait in between.

Paper 3 needs the first frame of the action from elsewhere. Here the performer stands still before:
an action begins where she starts to move out of a pose like the reference's first, and ends where
the reference has ended and she is still. All memory is bounded.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from mocapstudio.comparison.online import AlignmentStep, OnlineAligner
from mocapstudio.comparison.online_features import F32, F64
from mocapstudio.comparison.online_reference import MOTION_SECONDS, with_motion

_STILL_SHARE = 0.25
_STILL_SECONDS = 0.3
_CONFIRM_SECONDS = 0.1
_END_SHARE = 0.05
_LEAD_SECONDS = 2.0
_LOST_SECONDS = 1.5


class Following(StrEnum):
    """What the follower is doing."""

    WAITING = "waiting"
    FOLLOWING = "following"


@dataclass(frozen=True)
class FollowerState:
    """What is known after a frame.

    Parameters
    ----------
    following
        Whether an action is under way.
    action
        How many actions have begun so far.
    began
        Frame of the stream that is the first of the latest action, or None before the first.
    step
        Where in the reference the performer is, None while waiting.
    """

    following: Following
    action: int
    began: int | None
    step: AlignmentStep | None


class ActionFollower:
    """Feeds an aligner with the frames of each action, and restarts it between them.

    Parameters
    ----------
    aligner
        Fed and restarted here.
    """

    def __init__(self, aligner: OnlineAligner) -> None:
        self.aligner = aligner
        reference = aligner.reference
        rate, poses = reference.rate, reference.rows[:, : len(reference.features.names)]
        self._speeds = _speeds(poses, rate, reference.features.directions)
        slowest, fastest = np.quantile(self._speeds, [0.05, 0.9])
        # Jitter is no movement: what counts as still depends on how still the reference can be.
        self._still = float(slowest + _STILL_SHARE * (fastest - slowest))
        moving = np.flatnonzero(self._speeds > self._still)
        self._onset = int(moving[0]) if len(moving) else 0
        self._last_moving = int(moving[-1]) if len(moving) else len(reference) - 1
        self._like_start = _typical_distance(poses, reference.features.directions)
        lead = min(self._onset, round(_LEAD_SECONDS * rate))
        self._confirm = max(2, round(_CONFIRM_SECONDS * rate))
        self._patience = max(2, round(_STILL_SECONDS * rate))
        self._lost = round(_LOST_SECONDS * rate)
        self._buffer: deque[tuple[F32, float | None, int]] = deque(maxlen=lead + self._confirm)
        self._recent: deque[F32] = deque(maxlen=max(1, round(MOTION_SECONDS * rate)) + 1)
        self.action = 0
        self.began: int | None = None
        self.restart()

    def restart(self) -> None:
        """Give the present action up and wait for the next."""
        self._following = False
        # What ends in a silence, or begins a stream, is a silence to begin from.
        self._armed = True
        self._quiet = 0
        self._moving = 0
        self._buffer.clear()

    def feed(self, pose: F32, time: float | None, frame: int) -> FollowerState:
        """Take the next frame, `frame` its number in the stream; see `OnlineAligner.feed`."""
        self._recent.append(pose)
        if len(self._recent) == self._recent.maxlen:
            still = self._speed() <= self._still
            self._quiet = self._quiet + 1 if still else 0
            self._moving = 0 if still else self._moving + 1
        if self._following:
            step = self.aligner.feed(pose, time)
            if step is not None and self._is_over(step, pose):
                self.restart()
            return self._state(step)
        self._buffer.append((pose, time, frame))
        self._armed |= self._quiet >= self._patience
        if self._armed and self._moving >= self._confirm:
            if self._begins(self._buffer[0][0]):
                return self._begin()
            self._armed = False
        return self._state(None)

    def _begin(self) -> FollowerState:
        self.action += 1
        self.began = self._buffer[0][2]
        self._following = True
        self.aligner.restart()
        step = None
        for pose, time, _ in self._buffer:
            step = self.aligner.feed(pose, time) or step
        self._buffer.clear()
        return self._state(step)

    def _begins(self, pose: F32) -> bool:
        """Tell whether a pose is nearer to the reference's first than most of its frames are."""
        reference = self.aligner.reference
        features, first = reference.features, reference.rows[0, : len(pose)]
        turn = features.start(pose)
        turned = pose if turn is None else features.turned(pose, turn)
        apart = _distances(turned[None], first, features.directions)[0]
        return bool(np.nan_to_num(apart, nan=0.0) <= self._like_start)

    def _is_over(self, step: AlignmentStep, pose: F32) -> bool:
        ending = step.at >= self._last_moving - _END_SHARE * len(self._speeds)
        if ending and self._quiet >= self._confirm:
            return True
        # Given up: still for long where the reference moves, and back in the first pose.
        lost = self._quiet >= self._lost and self._speeds[step.at] > self._still
        return lost and self._begins(pose)

    def _speed(self) -> float:
        """Mean turning rate of the rows over the last `MOTION_SECONDS`, rad/s."""
        reference, recent = self.aligner.reference, self._recent
        seconds = (len(recent) - 1) / reference.rate
        return _turning(recent[0], recent[-1], reference.features.directions) / seconds

    def _state(self, step: AlignmentStep | None) -> FollowerState:
        doing = Following.FOLLOWING if self._following else Following.WAITING
        return FollowerState(doing, self.action, self.began, step)


def _speeds(poses: F32, rate: float, directions: bool) -> F64:
    """(R,) mean turning rate of the rows over the last `MOTION_SECONDS`, rad/s."""
    joints = poses.shape[1]
    moved = with_motion(np.ascontiguousarray(poses), rate, directions)[:, joints:]
    angles = 2.0 * np.arccos(np.clip(np.abs(moved[..., 3]), 0.0, 1.0))
    lag = min(max(1, round(MOTION_SECONDS * rate)), len(poses) - 1)
    speeds: F64 = angles.astype(np.float64) @ np.full(joints, rate / lag / joints)
    speeds[:lag] = speeds[lag]
    return speeds


def _turning(before: F32, now: F32, directions: bool) -> float:
    """Mean angle between rows, rad; missing rows left out."""
    dots = np.einsum("dk,dk->d", before, now, dtype=np.float64)
    seen = dots[~np.isnan(dots)]
    if not len(seen):
        return 0.0
    # A rotation turns by twice the angle between its quaternions.
    cosines, scale = (seen, 1.0) if directions else (np.abs(seen), 2.0)
    return scale * float(np.arccos(np.clip(cosines, -1.0, 1.0)).mean())


def _distances(poses: F32, other: F32, directions: bool) -> F64:
    """(n,) mean distance of rows (equation 1), missing rows left out."""
    dots = np.sum(poses * other, axis=-1)
    apart = 0.5 * (1 - dots) if directions else 1 - np.abs(dots)
    seen = ~np.isnan(apart)
    total = np.where(seen, apart, 0).sum(axis=-1)
    return np.asarray(total / np.maximum(seen.sum(axis=-1), 1), dtype=np.float64)


def _typical_distance(poses: F32, directions: bool) -> float:
    """Mean distance of the reference's frames from its first."""
    return float(_distances(poses, poses[0], directions).mean())
