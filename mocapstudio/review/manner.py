"""How files are read in a sitting, where they leave it open or the user knows better."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import msgspec

from mocapstudio.formats import ReadOptions
from mocapstudio.review.reading_wire import ReadingRecord, pack_reading, unpack_reading
from mocapstudio.review.records import Record


@dataclass(frozen=True)
class Manner:
    """How takes are read in this sitting.

    Parameters
    ----------
    options
        What replaces the files' own rate, unit and up axis; None for what they say.
    renamed
        Joints of the context, by name, and what they are called in the take.
    own
        Files that are read in a way of their own.
    """

    options: ReadOptions | None = None
    renamed: Mapping[str, str] = field(default_factory=dict)
    own: Mapping[Path, ReadOptions] = field(default_factory=dict)

    def of(self, path: Path) -> ReadOptions:
        """Return how a file is read."""
        return self.own.get(path.resolve()) or self.options or ReadOptions()

    def with_own(self, path: Path, options: ReadOptions) -> Manner:
        """Return the manner in which one file is read otherwise."""
        return replace(self, own={**self.own, path.resolve(): options})


AS_THEY_ARE = Manner()


class MannerRecord(Record, frozen=True):
    """A `Manner`; `own` by absolute path."""

    options: ReadingRecord | None = None
    renamed: dict[str, str] = msgspec.field(default_factory=dict)
    own: dict[str, ReadingRecord] = msgspec.field(default_factory=dict)


def pack_manner(manner: Manner) -> MannerRecord:
    """Make a record of a manner."""
    return MannerRecord(
        None if manner.options is None else pack_reading(manner.options),
        dict(manner.renamed),
        {str(path): pack_reading(options) for path, options in manner.own.items()},
    )


def unpack_manner(record: MannerRecord) -> Manner:
    """Make a manner of its record."""
    return Manner(
        None if record.options is None else unpack_reading(record.options),
        dict(record.renamed),
        {Path(path): unpack_reading(reading) for path, reading in record.own.items()},
    )
