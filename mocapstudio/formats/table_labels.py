"""Names of markers: those that repeat and those that are missing."""

from __future__ import annotations

from collections.abc import Sequence

from mocapstudio.formats.report import Problem

UNNAMED = "unnamed"
_NAMED = 4


def unique_labels(names: Sequence[str], line: int, problems: list[Problem]) -> tuple[str, ...]:
    """Give every marker a name of its own: repeated ones get ``#2``, ``#3``, empty ones a word.

    Parameters
    ----------
    names
        As in the file, without the white space around them.
    line
        1-based line of them.
    problems
        Where it is told what was done.
    """
    taken: set[str] = set()
    stated = set(names)
    labels: list[str] = []
    repeated: list[str] = []
    for name in names:
        base = name or UNNAMED
        label, number = base, 2
        while label in taken or (label != name and label in stated):
            label, number = f"{base}#{number}", number + 1
        if name and label != name:
            repeated.append(label)
        taken.add(label)
        labels.append(label)
    empty = sum(not name for name in names)
    if empty:
        what = "a marker has no label" if empty == 1 else f"{empty} markers have no label"
        problems.append(Problem(line, what, f"named {UNNAMED}"))
    if repeated:
        some = ", ".join(repeated[:_NAMED]) + (" and more" if len(repeated) > _NAMED else "")
        problems.append(Problem(line, "labels repeat", f"named {some}"))
    return tuple(labels)
