"""ASF and AMC written anew, for takes that have no ASF behind them.

A bone of an ASF begins where its parent's ends, so a joint whose children sit in several places,
as hips do, gets a bone without degrees of freedom to each of them, like the hip joints of CMU.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.asf_read import ROOT
from mocapstudio.formats.euler import nearest_euler
from mocapstudio.formats.options import UNITS, WriteOptions
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]

_ORDER = "ZYX"
"""Outermost first; an ASF lists its axes the other way round."""
_DECIMALS = 6
_CLOSE = 1e-7
"""Metres within which places are one."""
_UNFIT = re.compile(r"[\s#:]+")
_KEYWORDS = {ROOT, "begin", "end"}


@dataclass(frozen=True, eq=False)
class _Bone:
    """A bone to write; `joint` is -1 for one without degrees of freedom."""

    name: str
    parent: str
    vector: Array
    joint: int


def composed_amc(take: Take, options: WriteOptions) -> Iterator[bytes]:
    """Bytes of an AMC of the take, on the ASF of `composed_asf`.

    Angles in degrees, X before Y before Z; the rate as a keyword that this reader knows and others
    skip.

    Raises
    ------
    MocapError
        If another layout is asked for than a unit.
    """
    unit = _unit(take, options)
    names = _names(take.skeleton)
    start, end = take.span if options.trim else (0, take.frames)
    yield f":FULLY-SPECIFIED\n:DEGREES\n:SAMPLES-PER-SECOND {float(take.rate):.12g}\n".encode()
    turns = take.rotations[start:end]
    angles = np.degrees(nearest_euler(_ORDER, turns, np.zeros((turns.shape[1], 3))))[..., ::-1]
    moved = take.translations[start:end] - take.skeleton.offsets[list(take.translated)]
    if take.translated[0] == 0:
        moved[:, 0] = take.translations[start:end, 0]
    at = {joint: t for t, joint in enumerate(take.translated)}
    first = max(1, take.first_frame + start)
    for frame in range(end - start):
        lines = [str(first + frame)]
        for joint, name in enumerate(names):
            own = [*(moved[frame, at[joint]] / unit if joint in at else ()), *angles[frame, joint]]
            lines.append(f"{name} {' '.join(_number(value) for value in own)}")
        yield ("\n".join(lines) + "\n").encode()


def composed_asf(take: Take, options: WriteOptions) -> bytes:
    """Bytes of the ASF of a take: its joints at rest, all turning about the world's axes.

    Raises
    ------
    MocapError
        If another layout is asked for than a unit.
    """
    unit = _unit(take, options)
    bones = _bones(take.skeleton)
    moving = {j for j in take.translated if j}
    lines = [
        *(":version 1.10", f":name {_UNFIT.sub('_', take.name) or 'take'}", ":units"),
        *("  mass 1.0", f"  length {UNITS['in'] / unit:.12g}", "  angle deg"),
        *(":root", "  order TX TY TZ RX RY RZ", "  axis XYZ", "  position 0 0 0"),
        *("  orientation 0 0 0", ":bonedata"),
    ]
    for number, bone in enumerate(bones, 1):
        length = float(np.linalg.norm(bone.vector))
        along = bone.vector / length if length > 0 else np.array([0.0, 1.0, 0.0])
        dof = "" if bone.joint < 0 else "rx ry rz"
        if bone.joint in moving:
            dof = f"tx ty tz {dof}"
        lines += ["  begin", f"    id {number}", f"    name {bone.name}"]
        lines += [f"    direction {' '.join(f'{value:.12g}' for value in along)}"]
        lines += [f"    length {length / unit:.12g}", "    axis 0 0 0 XYZ"]
        lines += [f"    dof {dof}"] * bool(dof) + ["  end"]
    below: dict[str, list[str]] = {}
    for bone in bones:
        below.setdefault(bone.parent, []).append(bone.name)
    lines += [":hierarchy", "  begin"]
    lines += [f"    {parent} {' '.join(children)}" for parent, children in below.items()]
    return ("\n".join([*lines, "  end"]) + "\n").encode()


def _unit(take: Take, options: WriteOptions) -> float:
    if options.order or options.channels or options.up or options.table:
        raise MocapError(f"{take.name}: AMC is written Y up, with angles about X, Y and Z")
    return options.unit or UNITS["asf"]


def _number(value: float) -> str:
    # Adding zero turns -0.0 into 0.0.
    return f"{round(float(value), _DECIMALS) + 0.0:.{_DECIMALS}f}"


def _names(skeleton: Skeleton) -> list[str]:
    """Names that are one word, none of them a keyword or a number; the root is called root."""
    names, taken = [ROOT], set(_KEYWORDS)
    for name in skeleton.names[1:]:
        word = _UNFIT.sub("_", name)
        if not word[:1].isalpha():
            word = f"joint_{word}"
        unique, number = word, 1
        while unique.lower() in taken:
            number += 1
            unique = f"{word}_{number}"
        taken.add(unique.lower())
        names.append(unique)
    return names


def _bones(skeleton: Skeleton) -> list[_Bone]:
    names = _names(skeleton)
    taken = {name.lower() for name in names}
    vectors = [_vector(skeleton, joint) for joint in range(len(skeleton))]
    bones = []
    for joint in range(1, len(skeleton)):
        parent = int(skeleton.parents[joint])
        left, carrier = skeleton.offsets[joint] - vectors[parent], names[parent]
        if np.linalg.norm(left) > _CLOSE:
            carrier = f"{names[parent]}_to_{names[joint]}"
            while carrier.lower() in taken:
                carrier += "_"
            taken.add(carrier.lower())
            bones.append(_Bone(carrier, names[parent], left, -1))
        bones.append(_Bone(names[joint], carrier, vectors[joint], joint))
    return bones


def _vector(skeleton: Skeleton, joint: int) -> Array:
    """From a joint to the one place where all below it is, else zero."""
    if joint == 0:
        return np.zeros(3)
    below = skeleton.offsets[list(skeleton.children[joint])]
    if not len(below):
        below = skeleton.end_offsets[skeleton.end_parents == joint][:1]
    one = len(below) and np.abs(below - below[0]).max() <= _CLOSE
    return np.asarray(below[0] if one else np.zeros(3))
