"""What recordings of joints and of markers have in common: frames at a rate."""

from __future__ import annotations

from abc import ABC, abstractmethod
from fractions import Fraction

from mocapstudio.motion.errors import MocapError


class Timed(ABC):
    """A number of frames at a rate, of which a span may be looked at."""

    rate: Fraction
    trim: tuple[int, int] | None

    @property
    @abstractmethod
    def frames(self) -> int:
        """Number of frames."""

    @property
    def duration(self) -> float:
        """Length in seconds."""
        return self.frames / float(self.rate)

    @property
    def span(self) -> tuple[int, int]:
        """The trimmed span, or all frames."""
        return self.trim or (0, self.frames)

    def seconds(self, frame: float) -> float:
        """Time of a 0-based frame, in seconds."""
        return frame / float(self.rate)

    def check_time(self) -> None:
        """Check frames, rate and trim.

        Raises
        ------
        MocapError
            If there is no frame, the rate is not positive, or the trim lies outside the frames.
        """
        if self.frames == 0:
            raise MocapError("a take needs at least one frame")
        if self.rate <= 0:
            raise MocapError("a take needs a positive rate")
        if self.trim is not None and not 0 <= self.trim[0] < self.trim[1] <= self.frames:
            raise MocapError(f"trim {self.trim} lies outside the take's {self.frames} frames")
