"""Motion files: readers, writers, and the report of what an import found."""

from mocapstudio.formats.find import find_takes
from mocapstudio.formats.options import ReadOptions, WriteOptions
from mocapstudio.formats.registry import read, readable_suffixes
from mocapstudio.formats.report import ImportReport, Problem

__all__ = [
    "ImportReport",
    "Problem",
    "ReadOptions",
    "WriteOptions",
    "find_takes",
    "read",
    "readable_suffixes",
]
