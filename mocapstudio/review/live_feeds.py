"""Where the frames of a live performance come from: a take played as if it arrived now, a stream.

A feed is asked what has arrived by now, again and again; it never waits.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from mocapstudio.comparison.online_features import F32, Features, JointRotations, Recording
from mocapstudio.comparison.online_stream import StreamFrame, StreamPoses, read_frame
from mocapstudio.motion.errors import FileError, SkeletonMismatchError

RATE_FRAMES = 8
"""Frames from whose times the rate of a stream is told."""

_NEW_CLOCK_SECONDS = 1.0
_RATES = 1.0, 2000.0
_POURED = 0.5

Rotation = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True, eq=False)
class Arrived:
    """A frame that has arrived.

    Parameters
    ----------
    pose
        (D, 4), see `LiveAlignment.feed`.
    time
        Seconds on the performer's own clock, or None.
    frame
        Of the take that is played, or None.
    joints, root
        What a stream sent: local rotations by the reference's names, and the root's place.
    """

    pose: F32
    time: float | None
    frame: int | None = None
    joints: Mapping[str, Rotation] | None = None
    root: tuple[float, float, float] | None = None


class Feed(Protocol):
    """Gives frames when they are due."""

    @property
    def ended(self) -> bool:
        """Whether nothing is going to come any more."""

    @property
    def slips(self) -> bool:
        """Whether it can be played later than it wanted, as a take can and a stream cannot."""

    def due(self, seconds: float) -> Arrived | FileError | None:
        """Return the next frame, if it has arrived `seconds` after the beginning."""


class TakeFeed:
    """Plays the trimmed span of a take at its own rate.

    Parameters
    ----------
    take
        The take.
    features
        What is compared.

    Raises
    ------
    SkeletonMismatchError
        If the take lacks what is compared.
    """

    slips = True

    def __init__(self, take: Recording, features: Features) -> None:
        self._take = take
        self._poses = features.of(take)
        self._next = 0

    @property
    def ended(self) -> bool:
        """Whether the last frame was given."""
        return self._next >= len(self._poses)

    def rewind(self) -> None:
        """Begin anew."""
        self._next = 0

    def due(self, seconds: float) -> Arrived | None:
        """Return the next frame, if it is due by now."""
        at = self._next
        if self.ended or self._take.seconds(at) > seconds + 1e-9:
            return None
        self._next += 1
        return Arrived(self._poses[at], self._take.seconds(at), self._take.span[0] + at)


class StreamFeed:
    """Reads JSON lines; see `comparison.online_stream`.

    A line is shown when it comes; what waited while there was no alignment is made up for. Lines
    of a file that is poured in, which come faster than their own times tell, are held back until
    those times, so that they are played and not rushed through.

    Parameters
    ----------
    next_line
        Returns when the next line came, by `clock`, and the line; None where there is none now.
        It never waits.
    over
        Tells whether there will be no more.
    names
        Joints of the stream, and what they are called in the reference.
    clock
        Seconds.
    """

    slips = False

    def __init__(
        self,
        next_line: Callable[[], tuple[float, bytes] | None],
        over: Callable[[], bool],
        names: Mapping[str, str] | None = None,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        self._next_line, self._over, self._clock = next_line, over, clock
        self._names = names
        self._poses: StreamPoses | None = None
        self._ahead: deque[StreamFrame | FileError] = deque()
        self._line = 0
        self._came: list[tuple[float, float]] = []
        self._last: float | None = None
        self._origin: float | None = None

    @property
    def ended(self) -> bool:
        """Whether the stream was closed and all of it was given."""
        return not self._ahead and self._over()

    def settle(self, features: JointRotations) -> None:
        """Say what is compared, before the first frame is asked for."""
        self._poses = StreamPoses(features, self._names)

    def rate(self) -> float | None:
        """Frames a second as the first frames tell, or None while it is too early.

        0 where they tell no time, or none that can be.
        """
        frames = [one for one in self._ahead if isinstance(one, StreamFrame)]
        while len(frames) < RATE_FRAMES and len(self._ahead) < 8 * RATE_FRAMES:
            one = self._read()
            if one is None:
                break
            self._ahead.append(one)
            if isinstance(one, StreamFrame):
                frames.append(one)
        known = len(frames) >= RATE_FRAMES or len(self._ahead) >= 8 * RATE_FRAMES or self._over()
        if not known:
            return None
        times = np.array([one.time for one in frames if one.time is not None])
        steps = np.diff(times)
        steps = steps[steps > 1e-4]
        rate = float(1.0 / np.median(steps)) if len(steps) else 0.0
        return rate if _RATES[0] <= rate <= _RATES[1] else 0.0

    def due(self, seconds: float) -> Arrived | FileError | None:
        """Return the next frame, or what is wrong with a line.

        Raises
        ------
        SkeletonMismatchError
            If the stream is of another skeleton.
        """
        if self._poses is None:
            raise SkeletonMismatchError("nothing is compared yet")
        fresh = not self._ahead
        if fresh:
            one = self._read()
            if one is None:
                return None
            self._ahead.append(one)
        frame = self._ahead[0]
        if isinstance(frame, StreamFrame):
            if frame.time is not None and not self._is_due(frame.time, seconds, fresh=fresh):
                return None
            self._ahead.popleft()
            known, pose = self._poses.of(frame)
            return Arrived(pose, frame.time, None, known.joints, frame.root)
        self._ahead.popleft()
        return frame

    def _is_due(self, own: float, seconds: float, *, fresh: bool) -> bool:
        back = self._last is not None and own < self._last - _NEW_CLOCK_SECONDS
        if self._origin is None:
            self._origin = seconds - own - self._lag()
        elif back:
            self._origin = seconds - own
        elif fresh and not self._more_wait():
            # It has come just now: nothing is won by holding it back.
            self._origin = min(self._origin, seconds - own)
        if own + self._origin > seconds + 1e-9:
            return False
        self._last = own
        return True

    def _lag(self) -> float:
        """Seconds since the first frame came, or 0 where the first were poured in."""
        (first, begin), (last, end) = self._came[0], self._came[-1]
        poured = last - first < _POURED * (end - begin)
        return 0.0 if poured else self._clock() - first

    def _more_wait(self) -> bool:
        """Whether another line lies behind the present one."""
        if len(self._ahead) < 2:
            behind = self._read()
            if behind is not None:
                self._ahead.append(behind)
        return len(self._ahead) > 1

    def _read(self) -> StreamFrame | FileError | None:
        while (found := self._next_line()) is not None:
            came, line = found
            self._line += 1
            if line.strip():
                frame = read_frame(self._line, line)
                if isinstance(frame, StreamFrame) and frame.time is not None:
                    self._note(came, frame.time)
                return frame
        return None

    def _note(self, came: float, own: float) -> None:
        if len(self._came) < RATE_FRAMES:
            self._came.append((came, own))
