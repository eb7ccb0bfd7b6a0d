"""Which formats there are. One entry a format; each format is a module of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from mocapstudio.formats.amc_read import looks_like_amc, read_amc
from mocapstudio.formats.amc_write import asf_beside, write_amc
from mocapstudio.formats.atomic import write_whole
from mocapstudio.formats.bvh_read import looks_like_bvh, read_bvh
from mocapstudio.formats.bvh_write import write_bvh
from mocapstudio.formats.c3d_layout import looks_like_c3d
from mocapstudio.formats.c3d_read import read_c3d
from mocapstudio.formats.c3d_write import write_c3d
from mocapstudio.formats.fbx_read import looks_like_fbx, read_fbx
from mocapstudio.formats.fbx_write import write_fbx
from mocapstudio.formats.gltf_write import looks_like_gltf, write_gltf
from mocapstudio.formats.options import ReadOptions, WriteOptions
from mocapstudio.formats.report import ImportReport
from mocapstudio.formats.table_read import looks_like_csv, looks_like_tsv, read_csv, read_tsv
from mocapstudio.formats.table_write import write_marker_table, write_table
from mocapstudio.formats.trc_read import looks_like_trc, read_trc
from mocapstudio.formats.trc_write import write_trc
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import FileError, MarkersOnlyError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take

Recording = Take | MarkerTake
Reader = Callable[[Path, bytes, ReadOptions], tuple[Sequence[Recording], ImportReport]]
Writer = Callable[[Take, Sequence[Declared], WriteOptions], Iterator[bytes]]
MarkerWriter = Callable[[MarkerTake, Sequence[Declared], WriteOptions], Iterator[bytes]]

# The names of a table's columns alone can take many kilobytes.
_SNIFFED = 1 << 16


@dataclass(frozen=True)
class Format:
    """One file format.

    Attributes
    ----------
    name
        Short name, as in `Source.format`.
    suffixes
        Lower case, with the dot.
    looks_like
        Tells the format by a file's first bytes.
    read
        From a file's bytes to takes, or None where the format is only written.
    write
        From a take to a file's bytes, or None where the format does not hold joints.
    write_markers
        From a marker take to a file's bytes, or None where the format does not hold markers.
    beside
        Further files, with their bytes, without which a take written to a path cannot be read.
    common
        True where files of all sorts have its suffixes, so that in a folder the content tells.
    """

    name: str
    suffixes: tuple[str, ...]
    looks_like: Callable[[bytes], bool]
    read: Reader | None
    write: Writer | None = None
    write_markers: MarkerWriter | None = None
    beside: Callable[[Take, Path, WriteOptions], dict[Path, bytes]] | None = None
    common: bool = False


FORMATS = (
    Format("bvh", (".bvh",), looks_like_bvh, read_bvh, write_bvh),
    Format("amc", (".amc",), looks_like_amc, read_amc, write_amc, beside=asf_beside),
    Format("trc", (".trc",), looks_like_trc, read_trc, write_markers=write_trc),
    Format(
        "csv",
        (".csv",),
        looks_like_csv,
        read_csv,
        write_table("csv", ","),
        write_marker_table("csv", ","),
        common=True,
    ),
    Format(
        "tsv",
        (".tsv",),
        looks_like_tsv,
        read_tsv,
        write_table("tsv", "\t"),
        write_marker_table("tsv", "\t"),
        common=True,
    ),
    Format("c3d", (".c3d",), looks_like_c3d, read_c3d, write_markers=write_c3d),
    Format("fbx", (".fbx",), looks_like_fbx, read_fbx, write_fbx),
    Format("glb", (".glb",), looks_like_gltf, None, write_gltf(binary=True)),
    Format("gltf", (".gltf",), looks_like_gltf, None, write_gltf(binary=False)),
)


def readable_suffixes() -> tuple[str, ...]:
    """Suffixes of the files that can be read, lower case, with the dot."""
    return tuple(suffix for one in FORMATS if one.read is not None for suffix in one.suffixes)


def is_take(path: Path) -> bool:
    """Tell whether a file in a folder is meant as a take.

    By its suffix; a table whose content is no motion is not.
    """
    suffix = path.suffix.lower()
    one = next((one for one in FORMATS if suffix in one.suffixes), None)
    if one is None or one.read is None or not one.common:
        return one is not None and one.read is not None
    try:
        with path.open("rb") as file:
            head = file.read(_SNIFFED)
    except OSError:
        # Reading it will tell what is wrong with it.
        return True
    return any(other.looks_like(head) for other in FORMATS if other.common)


def written_suffix(suffix: str, *, markers: bool = False) -> str:
    """Return the suffix itself where takes can be written as it tells, else the usual one.

    That is ``.bvh``, for markers ``.c3d``.
    """
    able = [one for one in FORMATS if (one.write_markers if markers else one.write) is not None]
    written = [known for one in able for known in one.suffixes]
    return suffix if suffix.lower() in written else (".c3d" if markers else ".bvh")


def read_any(
    path: Path | str, options: ReadOptions | None = None
) -> tuple[list[Recording], ImportReport]:
    """Read a motion file of joints or markers: one take a performer, and what was odd about it.

    The format is told by the suffix, or by the content where the suffix tells nothing.

    Raises
    ------
    FileError
        If the file cannot be opened, is of no known format, or is not what it should be.
    """
    path = Path(path)
    try:
        data = path.read_bytes()
    except (OSError, ValueError) as bad:
        # A ValueError is a null byte in the name.
        raise FileError(path, (getattr(bad, "strerror", None) or str(bad)).lower()) from bad
    reader = _reader_of(path, data[:_SNIFFED])
    options = options or ReadOptions()
    found, report = reader(path, data, options)
    return [_with_options(take, options) for take in found], report


def _with_options(take: Recording, options: ReadOptions) -> Recording:
    if take.source is None:
        return take
    return replace(take, source=replace(take.source, options=options))


def read(path: Path | str, options: ReadOptions | None = None) -> tuple[list[Take], ImportReport]:
    """Read a motion file whose takes have a skeleton.

    Raises
    ------
    FileError
        As `read_any`.
    MarkersOnlyError
        If the file holds markers only.
    """
    found, report = read_any(path, options)
    takes = [take for take in found if isinstance(take, Take)]
    if not takes:
        cause = "holds markers and no skeleton; solve it to a skeleton first"
        raise MarkersOnlyError(Path(path), cause)
    return takes, report


def write(
    take: Recording,
    path: Path | str,
    *,
    declared: Sequence[Declared] = (),
    options: WriteOptions | None = None,
    inputs: Iterable[Path] = (),
) -> None:
    """Write a take; the format is told by the suffix. The file appears whole or not at all.

    A take that was read from a file of that format is written from its source: every byte is
    copied but the cells of changed samples, all of which must have been declared.

    Parameters
    ----------
    take
        The motion to write.
    path
        The file.
    declared
        Which rows may differ from the source, over which frames.
    options
        Another layout than the source's, which writes the file anew.
    inputs
        Further files that must not be overwritten; the take's own source never is.

    Raises
    ------
    FileError
        If the format cannot be written, the file is an input, or it cannot be written.
    MocapError
        If a sample changed without being declared, or the format cannot hold it.
    """
    path = Path(path)
    own = [take.source.path] if take.source is not None else []
    options = options or WriteOptions()
    pieces = _pieces(take, path, declared, options)
    companions = _companions(take, path, options)
    write_whole(path, pieces, inputs=[*own, *inputs])
    for companion, data in companions.items():
        write_whole(companion, [data], inputs=[*own, *inputs])


def _companions(take: Recording, path: Path, options: WriteOptions) -> dict[Path, bytes]:
    for one in FORMATS:
        if path.suffix.lower() in one.suffixes and one.beside and isinstance(take, Take):
            return one.beside(take, path, options)
    return {}


def _pieces(
    take: Recording, path: Path, declared: Sequence[Declared], options: WriteOptions
) -> Iterator[bytes]:
    suffix = path.suffix.lower()
    for one in FORMATS:
        if suffix not in one.suffixes:
            continue
        if isinstance(take, Take) and one.write is not None:
            return one.write(take, declared, options)
        if isinstance(take, MarkerTake) and one.write_markers is not None:
            return one.write_markers(take, declared, options)
    joints = isinstance(take, Take)
    able = [one for one in FORMATS if (one.write if joints else one.write_markers) is not None]
    known = ", ".join(s for one in able for s in one.suffixes) or "none yet"
    what = "joints" if joints else "markers"
    raise FileError(
        path, f"cannot write {what} as {path.suffix or 'without suffix'!r}; known are {known}"
    )


def _reader_of(path: Path, head: bytes) -> Reader:
    fitting = [one for one in FORMATS if path.suffix.lower() in one.suffixes]
    fitting += [one for one in FORMATS if one.looks_like(head)]
    known = ", ".join(readable_suffixes())
    if not fitting:
        raise FileError(path, f"cannot read {path.suffix or 'without suffix'!r}; known are {known}")
    if fitting[0].read is None:
        raise FileError(path, f"{fitting[0].suffixes[0]} is written only; read are {known}")
    return fitting[0].read
