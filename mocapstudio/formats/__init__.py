"""Motion files: readers, writers, and the report of what an import found."""

from mocapstudio.formats.find import find_takes
from mocapstudio.formats.options import ReadOptions, WriteOptions
from mocapstudio.formats.registry import Recording, read, read_any, readable_suffixes, write
from mocapstudio.formats.report import ImportReport, Problem
from mocapstudio.motion.declared import Declared

__all__ = [
    "Declared",
    "ImportReport",
    "Problem",
    "ReadOptions",
    "Recording",
    "WriteOptions",
    "find_takes",
    "read",
    "read_any",
    "readable_suffixes",
    "write",
]
