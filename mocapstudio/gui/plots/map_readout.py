"""What a place in the digression map says in words. No Qt."""

from __future__ import annotations

from collections.abc import Iterable

from mocapstudio.cleaning.model import DigressionMap
from mocapstudio.gui.plots.ticks import clock
from mocapstudio.motion.facing import ROOT_POSITION
from mocapstudio.motion.take import Take
from mocapstudio.review.model import Edit, Protected, QueueItem


def place(mapped: DigressionMap, take: Take, row: str, frame: int) -> str:
    """Say row, time, the file's frame number, digression and residual, as lines."""
    column = mapped.rows.index(row)
    value, residual = mapped.values[frame, column], mapped.residuals[frame, column]
    unit = " cm" if row == ROOT_POSITION else "°"
    when = f"{clock(take.seconds(frame))} · frame {take.first_frame + frame}"
    return f"{row}\n{when}\ndigression {value:.2f} · {residual:.1f}{unit} from its neighbours"


def flag_line(item: QueueItem) -> str:
    """Say what was flagged and decided."""
    if not item.current:
        return f"{item.flag.kind} · {item.verdict} · no longer flagged"
    return f"{item.flag.kind} · score {item.flag.score:.2f} · {item.verdict}"


def edit_lines(edits: Iterable[Edit], frame: int, row: str | None = None) -> list[str]:
    """Say which edits cover a frame (of a row, or of any), by what and by whom."""
    return [
        f"{'muted edit' if one.muted else 'edited'}: {one.method} · {', '.join(one.rows)}"
        f" · {one.author}"
        for one in edits
        if one.start <= frame < one.end and (row is None or row in one.rows)
    ]


def is_protected(spans: Iterable[Protected], frame: int, row: str) -> bool:
    """Tell whether nothing may change a row at a frame."""
    return any(
        one.start <= frame < one.end and (not one.joints or row in one.joints) for one in spans
    )
