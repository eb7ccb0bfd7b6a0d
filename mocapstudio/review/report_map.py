"""The report's picture: a lane a row, the digression map under the flags and edits."""

from __future__ import annotations

import base64
import struct
import zlib
from collections.abc import Sequence
from html import escape

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.model import DigressionMap
from mocapstudio.motion.take import Take
from mocapstudio.review.model import Edit, QueueItem, Verdict
from mocapstudio.review.rows import rows_of

_LANE, _WIDTH, _AXIS = 16, 1000, 24
_LETTER, _LETTERS = 6.4, 26
_COLUMNS = 1200
_MAP_COLOUR = (86, 140, 200)
_TICKS = (0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200)


def flag_map(
    take: Take,
    queue: Sequence[QueueItem],
    edits: Sequence[Edit],
    mapped: DigressionMap | None = None,
) -> str:
    """Return the picture as inline SVG, with its legend.

    Parameters
    ----------
    queue, edits
        Of that take's performer.
    mapped
        The digression map; without it, only rows with flags or edits have a lane.
    """
    lanes = _lanes(take, queue, edits, mapped)
    if not lanes:
        return ""
    lane = {row: i for i, row in enumerate(lanes)}
    height = len(lanes) * _LANE + _AXIS
    left = 12 + round(_LETTER * min(max(map(len, lanes)), _LETTERS))
    scale = _WIDTH / take.frames
    marks = [_edit(edit, lane, scale) for edit in edits if not edit.muted]
    marks += [_flag(item, take, lane, scale) for item in reversed(queue)]
    return "".join(
        [
            f"<h3>{'Flags and changes' if mapped is None else 'Digression map'}</h3>",
            "<figure><svg class='map' role='img'",
            f" viewBox='0 0 {left + _WIDTH + 20} {height}' aria-label='Flags by joint and time'>",
            *(_name(row, i, left) for row, i in lane.items()),
            f"<g transform='translate({left} 0)'>",
            _picture(mapped, lanes) if mapped is not None else "",
            *marks,
            _axis(take, len(lanes) * _LANE, scale),
            f"</g></svg>{_legend(mapped is not None)}</figure>",
        ]
    )


def _lanes(
    take: Take, queue: Sequence[QueueItem], edits: Sequence[Edit], mapped: DigressionMap | None
) -> tuple[str, ...]:
    if mapped is not None:
        return mapped.rows
    used = {item.flag.joint for item in queue} | {row for e in edits for row in e.rows}
    return tuple(row for row in rows_of(take) if row in used)


def _name(row: str, at: int, left: int) -> str:
    shown = row if len(row) <= _LETTERS else f"{row[: _LETTERS - 1]}…"
    y = at * _LANE
    band = f"<rect class='lane' x='{left}' y='{y + 1}' width='{_WIDTH}' height='{_LANE - 2}'/>"
    x, base = left - 8, y + _LANE - 4
    return f"{band}<text x='{x}' y='{base}' text-anchor='end'>{escape(shown)}</text>"


def _flag(item: QueueItem, take: Take, lane: dict[str, int], scale: float) -> str:
    flag = item.flag
    if flag.joint not in lane:
        return ""
    word = item.verdict.value + ("" if item.current else ", no longer flagged")
    title = f"{flag.joint}, {take.seconds(flag.start):.2f} s: {flag.kind.value}, {word}"
    x, width = flag.start * scale, max((flag.end - flag.start) * scale, 2.0)
    y = lane[flag.joint] * _LANE + 2
    style = f"flag {item.verdict.value}{'' if item.current else ' gone'}"
    return (
        f"<rect class='{style}' x='{x:.2f}' y='{y}' width='{width:.2f}' height='{_LANE - 4}'>"
        f"<title>{escape(title)}</title></rect>"
    )


def _edit(edit: Edit, lane: dict[str, int], scale: float) -> str:
    x, width = edit.start * scale, max((edit.end - edit.start) * scale, 2.0)
    return "".join(
        f"<rect class='edit' x='{x:.2f}' y='{lane[row] * _LANE + _LANE - 3}'"
        f" width='{width:.2f}' height='3'/>"
        for row in edit.rows
        if row in lane
    )


def _axis(take: Take, y: int, scale: float) -> str:
    step = next((t for t in _TICKS if take.duration / t <= 12), _TICKS[-1])
    ticks = []
    for n in range(int(take.duration / step) + 1):
        x = n * step * float(take.rate) * scale
        ticks.append(
            f"<path class='tick' d='M{x:.1f} {y}v4'/>"
            f"<text x='{x:.1f}' y='{y + 16}' text-anchor='middle'>{n * step:g}</text>"
        )
    return "".join(ticks) + f"<text x='{_WIDTH + 18}' y='{y + 16}' text-anchor='end'>s</text>"


def _legend(with_map: bool) -> str:
    entries = [f"<span><i class='{v.value}'></i>{v.value}</span>" for v in Verdict]
    entries.append("<span><i class='edit'></i>changed</span>")
    if with_map:
        entries.append(
            "<span><i class='shade'></i>the stronger, the farther from its neighbours</span>"
        )
    return f"<figcaption class='legend'>{''.join(entries)}</figcaption>"


def _picture(mapped: DigressionMap, lanes: Sequence[str]) -> str:
    shades = pooled(np.nan_to_num(mapped.values), _COLUMNS)
    alpha = np.clip(np.round(shades.T * 255), 0, 255).astype(np.uint8)
    pixels = np.empty((*alpha.shape, 4), dtype=np.uint8)
    pixels[..., :3], pixels[..., 3] = _MAP_COLOUR, alpha
    data = base64.b64encode(png(pixels)).decode()
    return (
        f"<image class='shades' x='0' y='0' width='{_WIDTH}' height='{len(lanes) * _LANE}'"
        f" preserveAspectRatio='none' href='data:image/png;base64,{data}'/>"
    )


def pooled(values: NDArray[np.float32], most: int) -> NDArray[np.float32]:
    """Highest value of each of at most `most` equal spans of frames: (F, R) to (at most, R)."""
    if len(values) <= most:
        return values
    edges = np.linspace(0, len(values), most, endpoint=False).astype(int)
    return np.maximum.reduceat(values, edges, axis=0)


def png(pixels: NDArray[np.uint8]) -> bytes:
    """Return a PNG file of RGBA pixels (height, width, 4)."""
    height, width, _ = pixels.shape
    # Every line starts with its filter: none.
    lines = np.zeros((height, 1 + width * 4), dtype=np.uint8)
    lines[:, 1:] = pixels.reshape(height, -1)

    def chunk(name: bytes, data: bytes) -> bytes:
        check = zlib.crc32(name + data)
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", check)

    head = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    body = zlib.compress(lines.tobytes(), 9)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", body) + chunk(b"IEND", b"")
