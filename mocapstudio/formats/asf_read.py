"""ASF: the skeleton of Acclaim files, from text to bones."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.asf_text import Section, Words, number, plain_lines, sections
from mocapstudio.formats.report import Problem
from mocapstudio.motion.errors import FileError

Array = NDArray[np.float64]
Angles = Literal["degrees", "radians"]

ROOT = "root"
_CHANNELS = ("tx", "ty", "tz", "rx", "ry", "rz", "l")
_SECTIONS = {"version", "name", "units", "documentation", "root", "bonedata", "hierarchy", "skin"}
_LEAST_SCALE, _MOST_SCALE = 1e-6, 1e6


@dataclass(frozen=True, eq=False)
class Bone:
    """One bone, or the root, which has no length.

    Attributes
    ----------
    name
        As in the file.
    line
        1-based line of its entry.
    vector
        (3,) from its start to its end at rest, in the file's unit and world axes.
    axis
        (3,) about x, y and z: how its own frame is turned at rest, in the file's angles.
    order
        Order in which rotations about its axes are applied, the first one first.
    dof
        Channels in the order of the motion's values.
    base
        (3,) where it is without motion; zero but for a root with a position.
    """

    name: str
    line: int
    vector: Array
    axis: Array
    order: str
    dof: tuple[str, ...]
    base: Array


@dataclass(frozen=True, eq=False)
class Asf:
    """A whole skeleton file.

    Attributes
    ----------
    path
        The file.
    bones
        The root first, parents before their children, as far as the hierarchy reaches.
    parents
        Index of each bone's parent, -1 for the root.
    loose
        Bones that no hierarchy reaches; the motion may still have values for them.
    scale
        The stated length scale, or None.
    angles
        The stated unit of angles, or None.
    data
        The whole file.
    """

    path: Path
    bones: tuple[Bone, ...]
    parents: tuple[int, ...]
    loose: tuple[Bone, ...]
    scale: float | None
    angles: Angles | None
    data: bytes


def read_asf(path: Path, problems: list[Problem]) -> Asf:
    """Read a skeleton.

    Raises
    ------
    FileError
        If the file cannot be opened, or is no whole skeleton.
    """
    try:
        data = path.read_bytes()
    except OSError as bad:
        raise FileError(path, (bad.strerror or str(bad)).lower()) from bad
    plain, encoding = plain_lines(data, path, problems)
    found = sections(plain.decode(encoding), path)
    for name in ("root", "bonedata", "hierarchy"):
        if name not in found:
            raise FileError(path, f"no section :{name}")
    for name in found.keys() - _SECTIONS:
        what = f"unknown section :{name} in {path.name}"
        problems.append(Problem(found[name].line, what, "ignored"))
    scale, angles = _units(found.get("units"), path)
    bones = {ROOT: _root(found["root"], path)}
    for bone in _bones(found["bonedata"], path):
        if bone.name in bones:
            raise FileError(path, f"bone {bone.name} repeats", line=bone.line)
        bones[bone.name] = bone
    below = _hierarchy(found["hierarchy"], set(bones), path)
    ordered, parents = _ordered(below)
    loose = tuple(bone for name, bone in bones.items() if name not in set(ordered))
    for bone in loose:
        what = f"bone {bone.name} is not in the hierarchy of {path.name}"
        problems.append(Problem(bone.line, what, "left out"))
    for name in ordered:
        if "l" in bones[name].dof:
            what = f"the length of bone {name} changes"
            problems.append(Problem(bones[name].line, what, "ignored: it keeps its length"))
    return Asf(path, tuple(bones[n] for n in ordered), tuple(parents), loose, scale, angles, data)


def _units(section: Section | None, path: Path) -> tuple[float | None, Angles | None]:
    scale: float | None = None
    angles: Angles | None = None
    for line, words in section.lines if section else ():
        key, value = words[0].lower(), words[1] if len(words) > 1 else ""
        if key == "length":
            scale = number(value, path, line)
            if not _LEAST_SCALE <= scale <= _MOST_SCALE:
                raise FileError(path, f"{value!r} is not a length scale", line=line)
        elif key == "angle":
            if not value.lower().startswith(("deg", "rad")):
                raise FileError(path, f"angle {value[:24]!r}: deg or rad needed", line=line)
            angles = "degrees" if value.lower().startswith("deg") else "radians"
    return scale, angles


def _root(section: Section, path: Path) -> Bone:
    entry = _Entry(path, section.line)
    for line, words in section.lines:
        entry.add(line, words)
    return Bone(
        ROOT,
        section.line,
        np.zeros(3),
        entry.numbers("orientation", 3, [0.0, 0.0, 0.0]),
        entry.order(entry.words("axis") or ["XYZ"]),
        entry.channels("order"),
        entry.numbers("position", 3, [0.0, 0.0, 0.0]),
    )


def _bones(section: Section, path: Path) -> list[Bone]:
    found: list[Bone] = []
    entry: _Entry | None = None
    for line, words in section.lines:
        word = words[0].lower()
        if word == "begin" and entry is None:
            entry = _Entry(path, line)
        elif word == "end" and entry is not None:
            found.append(_bone(entry))
            entry = None
        elif entry is None or word == "begin":
            where = "outside" if entry is None else "inside"
            raise FileError(path, f"{words[0][:24]!r} {where} a bone", line=line)
        else:
            entry.add(line, words)
    if entry is not None:
        raise FileError(path, "cut off: a bone has no end", line=entry.line)
    return found


def _bone(entry: _Entry) -> Bone:
    name = entry.words("name")
    if len(name) != 1:
        raise entry.error("name", "a bone needs one name")
    direction = entry.numbers("direction", 3)
    length = float(entry.numbers("length", 1)[0])
    if length < 0:
        raise entry.error("length", f"bone {name[0]} has a negative length")
    norm = float(np.linalg.norm(direction))
    axis = entry.words("axis") or ["0", "0", "0", "XYZ"]
    turned = np.array([number(w, entry.path, entry.line_of("axis")) for w in axis[:3]])
    if len(turned) != 3:
        raise entry.error("axis", "axis needs three angles and an order")
    return Bone(
        name[0],
        entry.line,
        direction * (length / norm if norm > 0 else 0.0),
        turned,
        entry.order(axis[3:] or ["XYZ"]),
        entry.channels("dof"),
        np.zeros(3),
    )


class _Entry:
    """Keys and values of a bone or of the root; values may run over several lines."""

    def __init__(self, path: Path, line: int) -> None:
        self.path, self.line = path, line
        self.values: dict[str, tuple[int, list[str]]] = {}
        self.key = ""

    def add(self, line: int, words: list[str]) -> None:
        first = words[0].lower()
        goes_on = {
            "dof": first in _CHANNELS,
            "order": first in _CHANNELS,
            "axis": sorted(first) == ["x", "y", "z"],
        }
        if first[0].isalpha() and not goes_on.get(self.key, False):
            if first in self.values:
                raise FileError(self.path, f"{words[0]} is given twice", line=line)
            self.key, words = first, words[1:]
            self.values[first] = (line, [])
        elif not self.key:
            raise FileError(self.path, f"{words[0][:24]!r} is not part of a bone", line=line)
        self.values[self.key][1].extend(words)

    def words(self, key: str) -> list[str]:
        return self.values.get(key, (self.line, []))[1]

    def line_of(self, key: str) -> int:
        return self.values.get(key, (self.line, []))[0]

    def error(self, key: str, cause: str) -> FileError:
        return FileError(self.path, cause, line=self.line_of(key))

    def numbers(self, key: str, count: int, default: list[float] | None = None) -> Array:
        if key not in self.values and default is not None:
            return np.array(default)
        words = self.words(key)
        if len(words) != count:
            raise self.error(key, f"{key} needs {count} values, has {len(words)}")
        return np.array([number(word, self.path, self.line_of(key)) for word in words])

    def order(self, words: list[str]) -> str:
        order = "".join(words).upper()
        if sorted(order) != ["X", "Y", "Z"]:
            raise self.error("axis", f"{order[:24]!r} is no order of the axes X, Y and Z")
        return order

    def channels(self, key: str) -> tuple[str, ...]:
        words = [word.lower() for word in self.words(key)]
        for word in words:
            if word not in _CHANNELS:
                raise self.error(key, f"{word[:24]!r} is no degree of freedom")
        if len(set(words)) != len(words):
            raise self.error(key, f"a degree of freedom repeats in '{' '.join(words)}'")
        return tuple(words)


def _hierarchy(section: Section, known: set[str], path: Path) -> dict[str, list[str]]:
    below: dict[str, list[str]] = {}
    placed: set[str] = {ROOT}
    for line, words in _inside(section, path):
        for name in words:
            if name not in known:
                raise FileError(path, f"the hierarchy names {name[:40]!r}, no bone", line=line)
        for name in words[1:]:
            if name in placed:
                raise FileError(path, f"bone {name} has two places in the hierarchy", line=line)
            placed.add(name)
            below.setdefault(words[0], []).append(name)
    return below


def _inside(section: Section, path: Path) -> list[Words]:
    """Lines between begin and end."""
    found: list[Words] = []
    inside = closed = False
    for line, words in section.lines:
        word = words[0].lower()
        if word == ("end" if inside else "begin"):
            inside, closed = not inside, inside
        elif inside:
            found.append((line, words))
        else:
            raise FileError(path, f"{words[0][:24]!r} outside begin and end", line=line)
    if not closed:
        raise FileError(path, "cut off: the hierarchy has no end", line=section.line)
    return found


def _ordered(below: dict[str, list[str]]) -> tuple[list[str], list[int]]:
    """Names from the root down, children in the order of the file, and each one's parent."""
    names: list[str] = []
    parents: list[int] = []
    stack: list[tuple[str, int]] = [(ROOT, -1)]
    while stack:
        name, parent = stack.pop()
        stack += [(child, len(names)) for child in reversed(below.get(name, []))]
        names.append(name)
        parents.append(parent)
    return names, parents
