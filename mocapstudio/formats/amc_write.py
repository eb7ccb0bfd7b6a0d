"""AMC: from a take to a file's bytes, on the skeleton that it was read with."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from mocapstudio.formats.amc_cells import as_read, frame_cells
from mocapstudio.formats.amc_compose import composed_amc, composed_asf
from mocapstudio.formats.amc_read import AmcRecord
from mocapstudio.formats.amc_text import AmcText
from mocapstudio.formats.asf_find import find_skeleton
from mocapstudio.formats.changes import changes, undeclared
from mocapstudio.formats.options import WriteOptions
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import FileError, MocapError
from mocapstudio.motion.take import Take


def write_amc(take: Take, declared: Sequence[Declared], options: WriteOptions) -> Iterator[bytes]:
    """Bytes of the take as AMC: its source's, but for the cells of changed samples.

    AMC holds angles about the axes of a skeleton in an ASF, in the ASF's unit and directions. A
    take that was not read from AMC gets an ASF of its own.

    Raises
    ------
    MocapError
        If a sample changed without being declared, if another layout is asked for than the
        ASF's, or if a bone lacks the axes for a changed rotation.
    """
    source = take.source
    if source is None or source.format != "amc":
        yield from composed_amc(take, options)
        return
    if options.relayout:
        raise MocapError(f"{take.name}: AMC has the joints, frames, unit and axes of its source")
    record: AmcRecord = source.record
    changed = changes(take, as_read(source))
    beyond = undeclared(take, changed, declared)
    if beyond is not None:
        raise MocapError(f"{take.name}: changed without being declared: {beyond}")
    span = take.trim if options.trim else None
    if span is None and not changed.rotations.any() and not changed.translations.any():
        yield record.data
        return
    text = AmcText(record)
    cells = frame_cells(take, source, changed)
    yield from text.spliced(cells, span or (0, take.frames))


def asf_beside(take: Take, path: Path, options: WriteOptions) -> dict[Path, bytes]:
    """Return the ASF that an AMC at `path` needs beside it, unless the reader finds it there.

    That of the take's source, else one of its own with the AMC's stem.

    Raises
    ------
    FileError
        If another skeleton lies at its place.
    """
    source = take.source
    if source is None or source.format != "amc":
        data, target = composed_asf(take, options), path.with_suffix(".asf")
    else:
        data, target = source.record.asf.data, path.with_name(source.record.asf.path.name)
    try:
        found = find_skeleton(path).read_bytes()
    except (FileError, OSError):
        found = b""
    if found == data:
        return {}
    if target.exists() and target.read_bytes() != data:
        raise FileError(target, "is another skeleton than that of the take to be written beside it")
    return {target: data}
