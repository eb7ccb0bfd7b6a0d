"""Which markers of a C3D file belong to which performer."""

from __future__ import annotations

from mocapstudio.formats.c3d_parameters import Parameters
from mocapstudio.formats.report import Problem

_FEWEST_OF_A_BODY = 10


def subjects(
    markers: dict[int, str], parameters: Parameters, problems: list[Problem]
) -> list[tuple[str, list[int]]]:
    """Name and points of each performer; the name is empty where there is one.

    A label's prefix before a colon names its subject. Prefixes also name the rigid bodies of one
    performer; they count as performers where the file says that it holds several subjects, or
    where two of them at least have a body's number of markers.

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
    stated = (parameters.count("SUBJECTS", "USED") or 0) > 1 and bool(
        parameters.count("SUBJECTS", "USES_PREFIXES")
    )
    bodies = [name for name, own in groups.items() if name and len(own) >= _FEWEST_OF_A_BODY]
    named = ", ".join(name for name in groups if name)
    if not stated and len(bodies) < 2:
        if len([name for name in groups if name]) > 1:
            what = f"labels of several bodies: {named}"
            problems.append(Problem(None, what, "guessed to be parts of one take", guess=True))
        return everything
    done = f"{len(groups)} takes in one space"
    problems.append(Problem(None, f"several subjects: {named}", done, guess=not stated))
    return list(groups.items())
