"""What the parts of a text format's reader share."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from mocapstudio.formats.report import Problem
from mocapstudio.motion.errors import FileError


@dataclass
class Reading:
    """What the parts of the reader share: the file, its options, the problems found so far."""

    path: Path
    data: bytes
    lenient: bool
    problems: list[Problem]

    def error(self, at: int, cause: str) -> FileError:
        """Return an error that names the line of byte `at`."""
        return FileError(self.path, cause, line=self.line(at))

    def line(self, at: int) -> int:
        """1-based line of byte `at`."""
        before = self.data[:at]
        carriage = before.count(b"\r") - before.count(b"\r\n")
        return 1 + before.count(b"\n") + carriage
