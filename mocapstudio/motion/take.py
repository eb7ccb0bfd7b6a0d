"""The take: one recording of one performer."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.timed import Timed


@dataclass(frozen=True, eq=False)
class Source:
    """Where a take came from, and what is needed to write it back untouched.

    Parameters
    ----------
    path
        The file as it was read.
    format
        Short name of the format, such as ``"bvh"``.
    digest
        SHA-256 of the file's bytes, and of those of its skeleton where that is a file of its own,
        hexadecimal.
    unit
        Metres per unit of the file.
    to_inside
        Quaternion (x, y, z, w) that turns the file's world axes into ours (Y up).
    performer
        Which performer of the file this is, counted from 0.
    record
        The format's own record of the text, channel order and so on; only the format's modules
        look into it.
    options
        How the reader was told to read the file, as formats know it; None where nobody said.
    """

    path: Path
    format: str
    digest: str
    unit: float = 1.0
    to_inside: NDArray[np.float64] = field(default_factory=lambda: np.array([0.0, 0.0, 0.0, 1.0]))
    performer: int = 0
    record: Any = None
    options: Any = None


@dataclass(frozen=True, eq=False)
class Take(Timed):
    """Skeleton and motion of one performer, in metres, radians and seconds, Y up, right-handed.

    Parameters
    ----------
    name
        What the user calls it: by default the file's stem.
    skeleton
        J joints.
    rotations
        (F, J, 4) local rotations relative to the parent; unit quaternions (x, y, z, w),
        sign-continuous in time.
    translated
        Indices of the T joints whose local translation changes in time. The root is always the
        first of them.
    translations
        (F, T, 3) metres: local translation of those joints in their parent's frame, in place of
        the skeleton's offset. For the root this is its position in the world.
    rate
        Frames a second.
    first_frame
        The number that the file gives its first frame.
    timecode
        SMPTE timecode of the first frame, or None.
    trim
        Half-open span of frames that analysis and report look at, or None for all.
    source
        The file behind it, or None for a take made in memory.
    """

    name: str
    skeleton: Skeleton
    rotations: NDArray[np.float64]
    translations: NDArray[np.float64]
    rate: Fraction
    translated: tuple[int, ...] = (0,)
    first_frame: int = 0
    timecode: str | None = None
    trim: tuple[int, int] | None = None
    source: Source | None = None

    def __post_init__(self) -> None:
        frames, joints = self.rotations.shape[:2]
        if joints != len(self.skeleton) or self.rotations.shape[2:] != (4,):
            raise MocapError("rotations must have shape (frames, joints, 4)")
        if self.translations.shape != (frames, len(self.translated), 3):
            raise MocapError("translations must have shape (frames, translated joints, 3)")
        if not self.translated or self.translated[0] != 0:
            raise MocapError("the first translated joint must be the root")
        self.check_time()

    @property
    def frames(self) -> int:
        """Number of frames."""
        return len(self.rotations)

    def with_motion(
        self,
        rotations: NDArray[np.float64] | None = None,
        translations: NDArray[np.float64] | None = None,
    ) -> Take:
        """Return the same take with other samples of the same shape."""
        return replace(
            self,
            rotations=self.rotations if rotations is None else rotations,
            translations=self.translations if translations is None else translations,
        )
