"""Which points of a C3D file are markers, and which are what a model made of them."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from mocapstudio.formats.c3d_parameters import Parameters
from mocapstudio.formats.c3d_points import Points
from mocapstudio.formats.report import Problem

MARKER = "marker"
UNLABELLED = "unlabelled point"
COMPUTED = "computed point"
_GROUPS = {
    "ANGLES": "angle",
    "FORCES": "force",
    "MOMENTS": "moment",
    "POWERS": "power",
    "SCALARS": "scalar",
    "REACTIONS": "reaction",
    "MODELED_MARKERS": "modelled marker",
    "BONES": "point of a segment",
}
_ENDINGS = (
    (re.compile(r".+(AnglesV?|AnkleAngleV?)$"), "angle"),
    (re.compile(r".+(Force|GRF)$"), "force"),
    (re.compile(r".+Moment$"), "moment"),
    (re.compile(r".+Power$"), "power"),
    (re.compile(r"CentreOfMass(Floor)?$"), "modelled marker"),
)
_UNLABELLED = re.compile(r"\*\d+$|unlabell?ed[ _]?\d*$", re.IGNORECASE)
_AXES = "OALP"
_FEWEST_MEASURED = 8
_NAMED = 6


def bare(label: str) -> str:
    """Return a label without its subject's prefix."""
    return label.rpartition(":")[2]


def kinds(
    labels: Sequence[str], parameters: Parameters, points: Points, problems: list[Problem]
) -> list[str]:
    """What each point is; all that are no markers are reported.

    Outputs of a model are told by the file's own lists (``POINT:ANGLES`` and its like), by
    Vicon's names, and, as a guess, by that no camera ever saw them while cameras saw the others.
    """
    found = _by_list(labels, parameters)
    for i, label in enumerate(labels):
        if found[i] == MARKER:
            found[i] = _by_name(bare(label))
    for i in _segment_axes(labels):
        if found[i] == MARKER:
            found[i] = "point of a segment"
    _tell(labels, found, problems)
    unseen = _unseen(found, points)
    if unseen:
        for i in unseen:
            found[i] = COMPUTED
        what = f"{len(unseen)} points that no camera saw: {_listing(labels, unseen)}"
        done = "guessed to be computed; left out of the markers, kept in the file"
        problems.append(Problem(None, what, done, guess=True))
    if MARKER not in found and UNLABELLED in found:
        problems.append(Problem(None, "no point has a label", "read the unlabelled ones"))
        found = [MARKER if kind == UNLABELLED else kind for kind in found]
    return found


def _by_list(labels: Sequence[str], parameters: Parameters) -> list[str]:
    stated = parameters.texts("POINT", "TYPE_GROUPS")
    groups = _GROUPS | {
        name.upper(): kind.lower().replace("_", " ") for name, kind in _pairs(stated)
    }
    kind_of: dict[str, str] = {}
    for group, kind in groups.items():
        for label in parameters.texts("POINT", group):
            kind_of.setdefault(label, kind)
    return [kind_of.get(label, MARKER) for label in labels]


def _pairs(words: Sequence[str]) -> list[tuple[str, str]]:
    return [
        (name, kind)
        for name, kind in zip(words[::2], words[1::2], strict=False)
        if name.upper() not in ("LABELS", "DESCRIPTIONS") and kind.upper() != "MARKER"
    ]


def _by_name(label: str) -> str:
    if _UNLABELLED.match(label):
        return UNLABELLED
    return next((kind for pattern, kind in _ENDINGS if pattern.match(label)), MARKER)


def _segment_axes(labels: Sequence[str]) -> list[int]:
    """Points of which origin and three axes of one segment are there: PELO, PELA, PELL, PELP."""
    by_stem: dict[str, dict[str, int]] = {}
    for i, label in enumerate(labels):
        stem, letter = label[:-1], label[-1:]
        if letter in _AXES and len(bare(stem)) == 3:
            by_stem.setdefault(stem, {})[letter] = i
    return [i for four in by_stem.values() if len(four) == len(_AXES) for i in four.values()]


def _unseen(found: Sequence[str], points: Points) -> list[int]:
    markers = np.array([i for i, kind in enumerate(found) if kind == MARKER], dtype=int)
    present = (~points.missing[:, markers]).sum(axis=0)
    seen = (points.measured & ~points.missing)[:, markers].sum(axis=0)
    mostly = (seen * 2 > present).sum()
    never = markers[(seen == 0) & (present > 0)]
    return [int(i) for i in never] if mostly >= _FEWEST_MEASURED else []


def _tell(labels: Sequence[str], found: Sequence[str], problems: list[Problem]) -> None:
    for kind in dict.fromkeys(found):
        if kind == MARKER:
            continue
        which = [i for i, one in enumerate(found) if one == kind]
        plural = kind if len(which) == 1 else _plural(kind)
        what = f"{len(which)} {plural}: {_listing(labels, which)}"
        done = "left out of the markers, kept in the file"
        problems.append(Problem(None, what, done))


def _plural(kind: str) -> str:
    first, _, rest = kind.partition(" of ")
    return f"{first}s of {rest}" if rest else f"{kind}s"


def _listing(labels: Sequence[str], which: Sequence[int]) -> str:
    named = ", ".join(labels[i] for i in which[:_NAMED])
    more = len(which) - _NAMED
    return f"{named} and {more} more" if more > 0 else named
