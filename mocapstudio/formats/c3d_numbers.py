"""How the processors that wrote C3D files lay out numbers: Intel, DEC and MIPS."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FIRST_PROCESSOR = 84
_NAMES = ("Intel", "DEC", "MIPS")


@dataclass(frozen=True)
class Numbers:
    """The number format of one file.

    Parameters
    ----------
    processor
        84 Intel (little-endian), 85 DEC (little-endian integers, VAX F floats), 86 MIPS
        (big-endian).
    """

    processor: int

    @property
    def name(self) -> str:
        """Name of the processor."""
        return _NAMES[self.processor - FIRST_PROCESSOR]

    @property
    def order(self) -> str:
        """Byte order in numpy's notation."""
        return ">" if self.name == "MIPS" else "<"

    def words(self, data: bytes | memoryview) -> NDArray[np.int16]:
        """(n,) signed 16-bit integers of 2 n bytes."""
        return np.frombuffer(data, dtype=f"{self.order}i2").astype(np.int16)

    def word(self, data: bytes, at: int) -> int:
        """Unsigned 16-bit integer at a byte."""
        return int(self.words(data[at : at + 2])[0]) & 0xFFFF

    def floats(self, data: bytes | memoryview) -> NDArray[np.float32]:
        """(n,) 32-bit floats of 4 n bytes."""
        if self.name != "DEC":
            return np.frombuffer(data, dtype=f"{self.order}f4").astype(np.float32)
        # A VAX F float is a little-endian pair of words, the high one first, times four.
        halves = np.frombuffer(data, dtype="<u2").reshape(-1, 2)
        bits = (halves[:, 0].astype(np.uint32) << 16) | halves[:, 1]
        with np.errstate(invalid="ignore"):
            values: NDArray[np.float32] = bits.view(np.float32) / np.float32(4)
        return values

    def words_bytes(self, values: NDArray[np.int16]) -> bytes:
        """Inverse of `words`."""
        return values.astype(f"{self.order}i2").tobytes()

    def floats_bytes(self, values: NDArray[np.float32]) -> bytes:
        """Inverse of `floats`."""
        if self.name != "DEC":
            return values.astype(f"{self.order}f4").tobytes()
        flat = np.asarray(values, dtype=np.float32).ravel()
        bits = (flat * np.float32(4)).view(np.uint32)
        halves = np.stack([bits >> 16, bits & 0xFFFF], axis=-1).astype("<u2")
        # What would be a negative zero is no number to a VAX.
        halves[flat == 0] = 0
        return halves.tobytes()
