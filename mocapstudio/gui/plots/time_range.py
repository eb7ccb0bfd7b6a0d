"""The stretch of time that the plots of the desk show, shared by all of them."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

SHORTEST = 6.0
"""Frames that the closest zoom shows."""

_ROOM = 1.5
"""Times a span's own length that is left free on either side when it is zoomed to."""


class TimeRange(QObject):
    """The visible frames of the take under review.

    Frame ``n`` lies at ``n`` and covers ``n - 0.5`` to ``n + 0.5``, so a half-open span
    ``[start, end)`` covers ``start - 0.5`` to ``end - 0.5``. Every change is clipped to the take.

    Parameters
    ----------
    parent
        Qt's parent.
    """

    changed = Signal()
    """Emitted after `start` or `end` took another value."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._frames = 1
        self._start = -0.5
        self._end = 0.5

    @property
    def frames(self) -> int:
        """Number of frames of the take."""
        return self._frames

    @property
    def start(self) -> float:
        """Left edge, in frames."""
        return self._start

    @property
    def end(self) -> float:
        """Right edge, in frames."""
        return self._end

    @property
    def length(self) -> float:
        """Visible length, in frames."""
        return self._end - self._start

    @property
    def is_whole(self) -> bool:
        """Whether the whole take is visible."""
        return self._start <= -0.5 and self._end >= self._frames - 0.5

    def set_frames(self, frames: int) -> None:
        """Say how long the take is; another length shows the whole take."""
        frames = max(int(frames), 1)
        if frames != self._frames:
            self._frames = frames
            self.whole()

    def whole(self) -> None:
        """Show the whole take."""
        self.show(-0.5, self._frames - 0.5)

    def show(self, start: float, end: float) -> None:
        """Show the frames from `start` to `end`, moved and clipped to fit into the take."""
        longest = float(self._frames)
        length = min(max(end - start, min(SHORTEST, longest)), longest)
        middle = 0.5 * (start + end)
        left = min(max(middle - 0.5 * length, -0.5), longest - 0.5 - length)
        if (left, left + length) != (self._start, self._end):
            self._start, self._end = left, left + length
            self.changed.emit()

    def zoom(self, factor: float, about: float) -> None:
        """Make the visible length `factor` times as long; frame `about` stays in its place."""
        length = min(max(self.length * factor, SHORTEST), float(self._frames))
        share = (about - self._start) / self.length
        left = about - share * length
        self.show(left, left + length)

    def pan(self, frames: float) -> None:
        """Move the visible stretch later by `frames`."""
        self.show(self._start + frames, self._end + frames)

    def focus(self, start: int, end: int) -> None:
        """Zoom to the half-open span [start, end) with room on both sides."""
        room = max(_ROOM * (end - start), 12.0)
        self.show(start - 0.5 - room, end - 0.5 + room)

    def reveal(self, frame: float) -> None:
        """Turn the page so that `frame` is visible; nothing moves where it already is."""
        if not self._start <= frame <= self._end:
            left = frame - 0.1 * self.length
            self.show(left, left + self.length)
