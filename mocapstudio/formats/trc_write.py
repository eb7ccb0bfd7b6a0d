"""TRC: from a marker take to a file's bytes, from its source text where it has one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from mocapstudio.formats.options import WriteOptions
from mocapstudio.formats.table_layout import Layout, lay_out
from mocapstudio.formats.table_patch import patched
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.markers import MarkerTake

_TIME_DECIMALS = 6


def write_trc(
    take: MarkerTake, declared: Sequence[Declared], options: WriteOptions
) -> Iterator[bytes]:
    """Bytes of the take as TRC; `declared` counts where the source's text is kept.

    Written anew, lengths are in the source's unit if that was TRC, else in millimetres; missing
    positions are blank.

    Raises
    ------
    MocapError
        If a sample changed without being declared.
    """
    source = take.source
    kept = source is not None and source.format == "trc" and source.record is not None
    if kept and not options.relayout and not options.trim:
        return patched(take, declared)
    return _composed(take, lay_out(take, options, "trc", "mm"))


def _composed(take: MarkerTake, layout: Layout) -> Iterator[bytes]:
    rate, frames, markers = float(take.rate), layout.end - layout.start, len(take.labels)
    stated = f"{rate:.10g}" if rate != round(rate) else f"{rate:.2f}"
    first = take.first_frame + layout.start
    keys = "DataRate CameraRate NumFrames NumMarkers Units OrigDataRate OrigDataStartFrame"
    yield f"PathFileType\t4\t(X/Y/Z)\t{_one_line(take.name)}.trc\n".encode()
    yield f"{keys} OrigNumFrames\n".replace(" ", "\t").encode()
    yield (
        f"{stated}\t{stated}\t{frames}\t{markers}\t{layout.unit_name}"
        f"\t{stated}\t{first}\t{frames}\n"
    ).encode()
    labels = "".join(f"{_one_line(label)}\t\t\t" for label in take.labels)
    yield f"Frame#\tTime\t{labels}\n".encode()
    yield ("\t\t" + "".join(f"X{i}\tY{i}\tZ{i}\t" for i in range(1, markers + 1)) + "\n\n").encode()
    cell = f"\t%.{layout.decimals}f"
    row_format = f"%d\t%.{_TIME_DECIMALS}f" + cell * (3 * markers) + "\n"
    table = layout.outside(take.positions[layout.start : layout.end]).reshape(frames, -1)
    for i, row in enumerate(table, layout.start):
        text = row_format % (take.first_frame + i, take.seconds(i), *row)
        yield text.replace("nan", "").encode()


def _one_line(name: str) -> str:
    return " ".join(name.split())
