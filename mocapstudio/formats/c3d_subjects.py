"""Which markers of a C3D file belong to which performer."""

from __future__ import annotations

import re

from mocapstudio.formats.c3d_parameters import Parameters
from mocapstudio.formats.report import Problem

_FEWEST_OF_A_BODY = 10
_NUMBERED = re.compile(r"(marker|m|point|p|unlabell?ed|u)?[ _*-]*\d*", re.IGNORECASE)
"""What software calls the markers of any rigid body: no sign that two bodies are alike."""


def subjects(
    markers: dict[int, str], parameters: Parameters, problems: list[Problem]
) -> list[tuple[str, list[int]]]:
    """Name and points of each performer; the name is empty where there is one.

    A label's prefix before a colon names its subject. Prefixes also name the rigid bodies of one
    performer; they count as performers where the file says that it holds several subjects, where
    two of them at least have a body's number of markers, or where they share most of their names.

    Parameters
    ----------
    markers
        Labels by index of the point.
    """
    groups: dict[str, list[int]] = {}
    for i, label in markers.items():
        groups.setdefault(label.rpartition(":")[0], []).append(i)
    everything = [("", list(markers))]
    if len(groups) < 2:
        return everything
    stated = _stated(groups, parameters)
    bodies = [name for name, own in groups.items() if name and len(own) >= _FEWEST_OF_A_BODY]
    named = ", ".join(name for name in groups if name)
    if not stated and len(bodies) < 2 and not _alike(groups, markers):
        if len([name for name in groups if name]) > 1:
            what = f"labels of several bodies: {named}"
            problems.append(Problem(None, what, "guessed to be parts of one take", guess=True))
        return everything
    done = f"{len(groups)} takes in one space"
    problems.append(Problem(None, f"several subjects: {named}", done, guess=not stated))
    return list(groups.items())


def _stated(groups: dict[str, list[int]], parameters: Parameters) -> bool:
    """Whether the file says that it holds several subjects, told apart by their prefixes."""
    if (parameters.count("SUBJECTS", "USED") or 0) < 2:
        return False
    names = {name.strip() for name in parameters.texts("SUBJECTS", "NAMES")}
    return bool(parameters.count("SUBJECTS", "USES_PREFIXES")) or len(names & set(groups)) > 1


def _alike(groups: dict[str, list[int]], markers: dict[int, str]) -> bool:
    """Whether two prefixes share most of their names, as two performers of one marker set do."""
    sets = [
        {
            name
            for name in (markers[i].rpartition(":")[2] for i in own)
            if not _NUMBERED.fullmatch(name)
        }
        for prefix, own in groups.items()
        if prefix
    ]
    pairs = ((one, other) for i, one in enumerate(sets) for other in sets[:i])
    return any(2 * len(one & other) > max(len(one), len(other)) for one, other in pairs)
