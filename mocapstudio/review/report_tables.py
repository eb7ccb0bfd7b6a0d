"""Tables of the report, and how it writes times and frames."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from mocapstudio.formats import Recording


def when(time: str) -> str:
    """Return date and time of day, without what every time has in common."""
    return escape(time.replace("T", " ").removesuffix("Z"))


def frames(take: Recording, start: int, end: int) -> str:
    """Return the numbers of the first and the last frame, as in the take's own file."""
    first, last = start + take.first_frame, end - 1 + take.first_frame
    return f"{first}" if first == last else f"{first}–{last}"


def table(
    title: str, head: Sequence[str], rows: Sequence[Sequence[str]], empty: str, numbers: set[int]
) -> str:
    """Return a table of cells that were escaped before."""
    if not rows:
        return f"<h3>{title}</h3><p class='muted'>{empty}</p>"

    def line(tag: str, cells: Sequence[str]) -> str:
        marks = (" class='number'" if i in numbers else "" for i in range(len(cells)))
        inside = (f"<{tag}{m}>{c}</{tag}>" for m, c in zip(marks, cells, strict=True))
        return f"<tr>{''.join(inside)}</tr>"

    body = "".join(line("td", cells) for cells in rows)
    return (
        f"<h3>{title}</h3><div class='scroll'><table><thead>{line('th', head)}</thead>"
        f"<tbody>{body}</tbody></table></div>"
    )
