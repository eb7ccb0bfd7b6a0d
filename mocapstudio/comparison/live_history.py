"""What has happened in a live alignment so far, in bounded memory: for pictures that grow.

Frames are collected in columns. When all columns are taken, every two become one, so that the
whole action stays in sight however long it gets, the coarser the longer.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.comparison.online import AlignmentStep
from mocapstudio.comparison.online_features import F32, F64

MOST_COLUMNS = 1024
MOST_ROWS = 192


@dataclass(frozen=True, eq=False)
class LiveCourse:
    """The course of an action, C columns.

    Parameters
    ----------
    stride
        Frames of the action a column.
    frames
        Frames of the action so far.
    at
        (C,) matching frame of the reference, at the rate of alignment.
    misalignment
        (C,) seconds ahead, NaN where the stream tells no time.
    cost, pose_cost
        (C,) of the path so far and of the pose.
    """

    stride: int
    frames: int
    at: F64
    misalignment: F64
    cost: F64
    pose_cost: F64


class LiveHistory:
    """The course of the action under way, and how far each pose was from every reference frame.

    Parameters
    ----------
    reference_frames
        R, frames of the reference at the rate of alignment.
    most_columns, most_rows
        What is kept at most.
    """

    def __init__(
        self,
        reference_frames: int,
        most_columns: int = MOST_COLUMNS,
        most_rows: int = MOST_ROWS,
    ) -> None:
        self.reference_frames = reference_frames
        self.block = max(1, -(-reference_frames // most_rows))
        self._starts = np.arange(0, reference_frames, self.block)
        self._sizes = np.diff(np.append(self._starts, reference_frames)).astype(np.float32)
        # An even number, so that columns can be paired.
        columns = max(2, most_columns // 2 * 2)
        self._distances = np.zeros((columns, len(self._starts)), np.float32)
        self._course = np.zeros((columns, 4))
        self.clear()

    def clear(self) -> None:
        """Forget the action."""
        self.stride = 1
        self.frames = 0
        self._filled = np.zeros(len(self._course), np.int64)

    def add(self, step: AlignmentStep, distances: F32) -> None:
        """Take in a frame of the action; frames that were passed over take its column too.

        Parameters
        ----------
        step
            Frames that do not advance the action change nothing.
        distances
            (R,) of this pose from every reference frame.
        """
        if step.frame < self.frames:
            return
        pooled = np.add.reduceat(distances, self._starts) / self._sizes
        ahead = np.nan if step.misalignment is None else step.misalignment
        values = np.array([step.at, ahead, step.cost, step.pose_cost])
        while self.frames <= step.frame:
            while self.frames // self.stride >= len(self._filled):
                self._halve()
            column = self.frames // self.stride
            before = self._filled[column]
            self._distances[column] += (pooled - self._distances[column]) / (before + 1)
            self._course[column] = values
            self._filled[column] += 1
            self.frames += 1

    @property
    def columns(self) -> int:
        """How many columns are taken, the last of which may not be full."""
        return -(-self.frames // self.stride)

    @property
    def distances(self) -> F32:
        """(columns, blocks) mean pose distances, `stride` frames by `block` reference frames."""
        return self._distances[: self.columns]

    @property
    def course(self) -> LiveCourse:
        """The course so far; of each column its last frame."""
        at, ahead, cost, pose = self._course[: self.columns].T.copy()
        return LiveCourse(self.stride, self.frames, at, ahead, cost, pose)

    def _halve(self) -> None:
        half = len(self._filled) // 2
        counts = self._filled.reshape(half, 2)
        total = np.maximum(counts.sum(axis=1), 1)
        share: NDArray[np.float32] = (counts / total[:, None]).astype(np.float32)
        pairs = self._distances.reshape(half, 2, -1)
        self._distances[:half] = (pairs * share[..., None]).sum(axis=1)
        self._distances[half:] = 0.0
        second = counts[:, 1] > 0
        course = self._course.reshape(half, 2, -1)
        self._course[:half] = np.where(second[:, None], course[:, 1], course[:, 0])
        self._filled = np.concatenate([counts.sum(axis=1), np.zeros(half, np.int64)])
        self.stride *= 2
