"""The benchmark's page: one HTML file with everything in it."""

from __future__ import annotations

import base64
import html
import struct
import zlib
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from mocapstudio.evaluation.experiments import Section
from mocapstudio.evaluation.tables import Table

_STYLE = """
:root { color-scheme: light dark; --ink: #1d2329; --soft: #69737d; --line: #d9dee3; --back: #fff;
        --stripe: #f5f7f9; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6eaee; --soft: #97a1ab; --line: #39424b;
        --back: #15191d; --stripe: #1c2126; } }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--back);
       max-width: 1180px; margin: 2.5rem auto; padding: 0 1.5rem; }
h1 { font-size: 1.7rem; margin-bottom: .2rem; } h2 { font-size: 1.1rem; margin: 2.2rem 0 .5rem; }
p.note, figcaption, footer { color: var(--soft); font-size: .85rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .88rem; }
th, td { padding: .3rem .7rem; text-align: right; border-bottom: 1px solid var(--line);
         white-space: nowrap; }
th { font-weight: 600; color: var(--soft); } th:first-child, td:first-child { text-align: left; }
tbody tr:first-child td { font-weight: 600; }
tbody tr:nth-child(even) { background: var(--stripe); }
.curves { display: flex; flex-wrap: wrap; gap: 1.5rem; } figure { margin: 0; }
svg text { font: 11px system-ui, sans-serif; fill: var(--soft); }
svg .axis { stroke: var(--line); } svg .name { fill: var(--ink); }
img.map { width: 100%; image-rendering: pixelated; border: 1px solid var(--line); display: block; }
"""

# Okabe and Ito's colours, distinct to the colour-blind.
_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8c8c8c")
_INFERNO = np.array(
    [[0, 0, 4], [87, 16, 110], [188, 55, 84], [249, 142, 9], [252, 255, 164]], dtype=float
)


def page(title: str, lead: str, parts: Sequence[str], foot: str) -> str:
    """Put parts of HTML into a page of their own."""
    return (
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{html.escape(title)}</title>'
        f"<style>{_STYLE}</style><h1>{html.escape(title)}</h1>"
        f'<p class="note">{html.escape(lead)}</p>{"".join(parts)}'
        f"<footer><p>{html.escape(foot)}</p></footer></html>\n"
    )


def table_html(table: Table) -> str:
    """Write a table as HTML."""

    def cells(texts: Sequence[str], tag: str) -> str:
        return "".join(f"<{tag}>{html.escape(text)}</{tag}>" for text in texts)

    rows = "".join(f"<tr>{cells(row, 'td')}</tr>" for row in table.rows)
    note = f'<p class="note">{html.escape(table.note)}</p>' if table.note else ""
    return (
        f'<h2>{html.escape(table.title)}</h2><div class="wide"><table><thead><tr>'
        f"{cells(table.head, 'th')}</tr></thead><tbody>{rows}</tbody></table></div>{note}"
    )


def curves_html(sections: Sequence[Section]) -> str:
    """Precision over recall at word level, one picture for each of the paper's rows."""
    figures = "".join(_curve(s) for s in sections if s.experiment.is_main)
    return f'<h2>Precision and recall of words</h2><div class="curves">{figures}</div>'


def _curve(section: Section) -> str:
    width, height, left, top, side = 360, 330, 40, 24, 270
    parts = [f'<text class="name" x="{left}" y="14">{html.escape(section.experiment.title)}</text>']
    for i in range(6):
        at = i / 5
        x, y = left + at * side, top + (1 - at) * side
        parts.append(
            f'<path class="axis" fill="none" d="M{left},{y:.0f}h{side}M{x:.0f},{top}v{side}"/>'
            f'<text x="{left - 6}" y="{y + 4:.0f}" text-anchor="end">{at:.1f}</text>'
            f'<text x="{x:.0f}" y="{top + side + 15}" text-anchor="middle">{at:.1f}</text>'
        )
    parts.append(
        f'<text x="{left + side}" y="{top + side + 30}" text-anchor="end">recall</text>'
        f'<text x="{left + side}" y="14" text-anchor="end">precision (up)</text>'
    )
    for i, row in enumerate(section.rows):
        colour = _COLOURS[i % len(_COLOURS)]
        counts = [words for _, (words, _) in sorted(row.scores.curve.items())]
        kept = [c for c in counts if c.hits + c.false and c.hits + c.missed]
        points = " ".join(
            f"{left + c.recall * side:.1f},{top + (1 - c.precision) * side:.1f}" for c in kept
        )
        label = top + side - 8 - 14 * (len(section.rows) - 1 - i)
        parts.append(
            f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="2"/>'
            f'<text x="{left + 10}" y="{label}" style="fill:{colour}">'
            f"{html.escape(row.name)}</text>"
        )
        words = row.scores.words
        if words.hits + words.false and words.hits + words.missed:
            x, y = left + words.recall * side, top + (1 - words.precision) * side
            parts.append(f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{colour}"/>')
    caption = "one line a method over all thresholds; the dot is the threshold as set"
    return (
        f'<figure><svg viewBox="0 0 {width} {height}" width="{width}" height="{height}">'
        f"{''.join(parts)}</svg><figcaption>{caption}</figcaption></figure>"
    )


def maps_html(title: str, maps: Sequence[tuple[str, NDArray[np.float64]]], rows: str) -> str:
    """Maps (F, R) of values in 0..1, one above the other, time to the right."""
    figures = "".join(
        f'<figure><img class="map" style="height:220px" alt="{html.escape(name)}"'
        f' src="{_png(values)}"><figcaption>{html.escape(name)}</figcaption></figure><br>'
        for name, values in maps
    )
    return f'<h2>{html.escape(title)}</h2><p class="note">{html.escape(rows)}</p>{figures}'


def _png(values: NDArray[np.float64]) -> str:
    """Write values as a data address of a PNG: rows from the top, time to the right."""
    at = np.clip(values.T, 0.0, 1.0) * (len(_INFERNO) - 1)
    low = np.minimum(at.astype(int), len(_INFERNO) - 2)
    part = (at - low)[..., None]
    pixels = (_INFERNO[low] * (1 - part) + _INFERNO[low + 1] * part).astype(np.uint8)
    height, width, _ = pixels.shape
    lines = b"".join(b"\0" + row.tobytes() for row in pixels)

    def chunk(kind: bytes, body: bytes) -> bytes:
        return (
            struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
        )

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    data = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(lines))
    return "data:image/png;base64," + base64.b64encode(data + chunk(b"IEND", b"")).decode()
