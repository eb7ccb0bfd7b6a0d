"""Which row of the source answers to which row of the reference."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from mocapstudio.comparison.performance import Performance, Row
from mocapstudio.motion.errors import MocapError, SkeletonMismatchError

LEAST = 3
"""Rows without which two poses cannot be compared."""


@dataclass(frozen=True)
class Match:
    """Rows of two performances that answer to each other, N of them.

    Parameters
    ----------
    reference, source
        (N,) indices of rows, in the reference's order.
    warnings
        Rows without answer, as phrases.
    """

    reference: tuple[int, ...]
    source: tuple[int, ...]
    warnings: tuple[str, ...] = ()


def match(
    reference: Performance, source: Performance, names: Mapping[str, str] | None = None
) -> Match:
    """Match rows by name, by a map of names, or by what they are in any body.

    Parameters
    ----------
    names
        Names in the source and what they are called in the reference.

    Raises
    ------
    MocapError
        If a map names rows that neither has.
    SkeletonMismatchError
        If fewer than `LEAST` rows answer to each other.
    """
    mapped = dict(names or {})
    known = {row.name for row in source.rows} | {row.name for row in reference.rows}
    if mapped and not known & set(mapped):
        raise MocapError(f"the joint map names no joint of {source.name}")
    found: dict[int, int] = {}
    by_role = 0
    keys: tuple[Callable[[Row], str], ...] = (
        lambda row: row.name,
        lambda row: _plain(row.name),
        lambda row: row.role,
    )
    for key in keys:
        theirs = {
            key(row if row.name not in mapped or key is keys[2] else _renamed(row, mapped)): j
            for j, row in reversed(list(enumerate(source.rows)))
            if j not in found.values()
        }
        for i, row in enumerate(reference.rows):
            j = theirs.get(key(row)) if key(row) else None
            if i not in found and j is not None and j not in found.values():
                found[i] = j
                by_role += key is keys[2]
    if len(found) < min(LEAST, len(reference.rows)):
        raise SkeletonMismatchError(
            f"{source.name} cannot be compared with {reference.name}: {len(found)} of"
            f" {len(reference.rows)} joints or markers answer to each other; give a joint map"
        )
    pairs = sorted(found.items())
    warnings = _warnings(reference, source, found, by_role)
    return Match(tuple(i for i, _ in pairs), tuple(j for _, j in pairs), warnings)


def _renamed(row: Row, names: Mapping[str, str]) -> Row:
    return Row(names[row.name], row.limb, row.role)


def _plain(name: str) -> str:
    """Drop subject, case and punctuation."""
    return re.sub(r"[^a-z0-9]", "", name.split(":")[-1].lower())


def _warnings(
    reference: Performance, source: Performance, found: Mapping[int, int], by_role: int
) -> tuple[str, ...]:
    said = []
    if by_role:
        said.append(f"{by_role} of {len(found)} rows are matched by their place in the body")
    for one, matched in ((reference, set(found)), (source, set(found.values()))):
        alone = [row.name for i, row in enumerate(one.rows) if i not in matched]
        if alone:
            more = f" and {len(alone) - 8} more" if len(alone) > 8 else ""
            said.append(f"only in {one.name}: {', '.join(alone[:8])}{more}")
    return tuple(said)
