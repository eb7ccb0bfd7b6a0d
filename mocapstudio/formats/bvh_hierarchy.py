"""The HIERARCHY section of BVH: joints, offsets, and which column holds which channel."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field, replace
from pathlib import Path

from mocapstudio.formats.bvh_rows import LARGEST
from mocapstudio.formats.report import Problem
from mocapstudio.motion.errors import FileError

Offset = tuple[float, float, float]

# Names may hold spaces, dots and the word End, so they run to the brace or the end of the line.
_STATEMENT = re.compile(
    r"(?P<open>\{)|(?P<close>\})"
    r"|(?P<hierarchy>HIERARCHY\b)"
    r"|(?P<joint>ROOT|JOINT)(?=[\s{])[ \t]*(?P<name>[^\r\n{]*)"
    r"|(?P<end>END)(?=[\s{])[^\r\n{]*"
    r"|(?P<offset>OFFSET)\b\s*(?P<values>\S+\s+\S+\s+[^\s{}]+)"
    r"|(?P<channels>CHANNELS)\b\s*(?P<count>\d+)(?P<words>(?:\s+[A-Z]+(?:position|rotation)\b)*)",
    re.IGNORECASE,
)
_SPACE = re.compile(r"\s*")
_CHANNEL = re.compile(r"([XYZ])(position|rotation)", re.IGNORECASE)
_MOST_CHANNELS = 1000


@dataclass(frozen=True)
class BvhJoint:
    """One joint as the file lays it out.

    Attributes
    ----------
    name
        As in the file; repeated names carry ``#2``, ``#3``.
    parent
        Index of the parent, -1 for a root.
    offset
        In units of the file.
    line
        1-based line of its ROOT or JOINT.
    positions
        Column of the X, Y and Z position channel; -1 where there is none.
    order
        Axis letters of the rotation channels as listed, outermost first.
    rotations
        Their columns.
    """

    name: str
    parent: int
    offset: Offset = (0.0, 0.0, 0.0)
    line: int = 0
    positions: tuple[int, int, int] = (-1, -1, -1)
    order: str = ""
    rotations: tuple[int, ...] = ()

    @property
    def moves(self) -> bool:
        """True where it has a position channel."""
        return max(self.positions) >= 0


@dataclass
class Hierarchy:
    """One ROOT with all below it, and its end sites (parent, offset)."""

    joints: list[BvhJoint] = field(default_factory=list)
    ends: list[tuple[int, Offset]] = field(default_factory=list)


def parse_hierarchy(
    text: str, path: Path, line: int, problems: list[Problem]
) -> tuple[list[Hierarchy], int]:
    """Read the text between HIERARCHY and MOTION.

    Parameters
    ----------
    text
        The section, its keyword included.
    path
        The file, for errors.
    line
        1-based line of the text's first character.
    problems
        Oddities are appended here.

    Returns
    -------
    roots
        One hierarchy a ROOT.
    columns
        Number of values in a row of the motion.

    Raises
    ------
    FileError
        At whatever is not a hierarchy.
    """
    return _Parser(text, path, line, problems).run()


class _Parser:
    def __init__(self, text: str, path: Path, line: int, problems: list[Problem]) -> None:
        self.text, self.path, self.problems = text, path, problems
        self.first_line = line
        self.roots: list[Hierarchy] = []
        self.columns = 0
        # Open braces: index of a joint, or "end" for an end site.
        self.stack: list[int | str] = []
        self.opening: int | str | None = None
        self.offsets_seen: set[int] = set()

    def run(self) -> tuple[list[Hierarchy], int]:
        at = 0
        self.newlines_to, self.newlines = 0, 0
        while True:
            space = _SPACE.match(self.text, at)
            at = space.end() if space else at
            if at >= len(self.text):
                break
            match = _STATEMENT.match(self.text, at)
            if match is None:
                word = self.text[at : at + 24].split("\n")[0].strip()
                raise self.error(at, f"{word!r} is not part of a hierarchy")
            self.statement(match, at)
            at = match.end()
        self.finish()
        return self.roots, self.columns

    def statement(self, match: re.Match[str], at: int) -> None:
        if match["joint"]:
            self.joint(match["joint"].upper(), match["name"].strip(), at)
        elif match["end"]:
            self.need_joint(at, "an end site")
            self.opening = "end"
            hierarchy, parent = self.roots[-1], self.stack[-1]
            hierarchy.ends.append((int(parent), (0.0, 0.0, 0.0)))
        elif match["open"]:
            if self.opening is None:
                raise self.error(at, "'{' without a joint before it")
            self.stack.append(self.opening)
            self.opening = None
        elif match["close"]:
            if not self.stack or self.opening is not None:
                raise self.error(at, "'}' closes nothing")
            self.close(self.stack.pop())
        elif match["offset"]:
            self.offset(match["values"], at)
        elif match["channels"]:
            self.channels(int(match["count"]), match["words"].split(), at)

    def close(self, one: int | str) -> None:
        if isinstance(one, int) and one not in self.offsets_seen:
            joint = self.roots[-1].joints[one]
            what = f"joint {joint.name} has no OFFSET"
            self.problems.append(Problem(joint.line, what, "read as zero"))

    def joint(self, keyword: str, name: str, at: int) -> None:
        if self.opening is not None:
            raise self.error(at, f"'{{' expected before {keyword} {name}")
        if keyword == "ROOT":
            if self.stack:
                raise self.error(at, f"ROOT {name} inside another joint")
            self.roots.append(Hierarchy())
            self.offsets_seen = set()
            parent = -1
        else:
            self.need_joint(at, f"JOINT {name}")
            parent = int(self.stack[-1])
        joints = self.roots[-1].joints
        joints.append(BvhJoint(self.unique(name, at), parent, line=self.line(at)))
        self.opening = len(joints) - 1

    def need_joint(self, at: int, what: str) -> None:
        if self.opening is not None or not self.stack or self.stack[-1] == "end":
            raise self.error(at, f"{what} is not inside a joint")

    def unique(self, name: str, at: int) -> str:
        taken = {joint.name for joint in self.roots[-1].joints}
        base = name or "unnamed"
        found, number = base, 2
        while found in taken:
            found, number = f"{base}#{number}", number + 1
        if found != name:
            what = f"joint name {name} repeats" if name else "a joint has no name"
            self.problems.append(Problem(self.line(at), what, f"named {found}"))
        return found

    def offset(self, values: str, at: int) -> None:
        if not self.stack or self.opening is not None:
            raise self.error(at, "OFFSET outside a joint")
        numbers = [_number(word) for word in values.split()]
        for word, value in zip(values.split(), numbers, strict=True):
            if not abs(value) <= LARGEST:
                raise self.error(at, f"{word!r} in an OFFSET is not a length")
        x, y, z = numbers
        hierarchy, top = self.roots[-1], self.stack[-1]
        if isinstance(top, str):
            hierarchy.ends[-1] = (hierarchy.ends[-1][0], (x, y, z))
        else:
            hierarchy.joints[top] = replace(hierarchy.joints[top], offset=(x, y, z))
            self.offsets_seen.add(top)

    def channels(self, count: int, words: list[str], at: int) -> None:
        if not self.stack or self.opening is not None:
            raise self.error(at, "CHANNELS outside a joint")
        if count != len(words) or count > _MOST_CHANNELS:
            raise self.error(at, f"CHANNELS states {count} but names {len(words)}")
        top = self.stack[-1]
        if isinstance(top, str):
            if count:
                self.problems.append(
                    Problem(self.line(at), "an end site has channels", "ignored, kept in the file")
                )
            self.columns += count
            return
        joint = self.roots[-1].joints[top]
        if joint.moves or joint.rotations:
            raise self.error(at, f"joint {joint.name} has CHANNELS twice")
        self.roots[-1].joints[top] = self.with_channels(joint, words, at)

    def with_channels(self, joint: BvhJoint, words: list[str], at: int) -> BvhJoint:
        positions, order, rotations = [-1, -1, -1], "", list[int]()
        for word in words:
            match = _CHANNEL.fullmatch(word)
            letter = match[1].upper() if match else ""
            if match and match[2].lower() == "position" and positions["XYZ".index(letter)] < 0:
                positions["XYZ".index(letter)] = self.columns
            elif match and match[2].lower() == "rotation" and len(order) < 3:
                order += letter
                rotations.append(self.columns)
            else:
                raise self.error(at, f"channel {word} of joint {joint.name} has no meaning here")
            self.columns += 1
        x, y, z = positions
        return replace(joint, positions=(x, y, z), order=order, rotations=tuple(rotations))

    def finish(self) -> None:
        end = len(self.text)
        if not self.roots:
            raise self.error(end, "no ROOT before MOTION")
        if self.stack or self.opening is not None:
            raise self.error(end, f"{max(len(self.stack), 1)} joints are not closed by '}}'")
        if not self.columns:
            raise self.error(end, "no joint has channels")

    def line(self, at: int) -> int:
        # Statements come in order, so newlines are counted once.
        if at < self.newlines_to:
            self.newlines_to, self.newlines = 0, 0
        self.newlines += len(_NEWLINE.findall(self.text, self.newlines_to, at))
        self.newlines_to = at
        return self.first_line + self.newlines

    def error(self, at: int, cause: str) -> FileError:
        return FileError(self.path, cause, line=self.line(min(at, len(self.text.rstrip()))))


_NEWLINE = re.compile(r"\r\n|\n|\r")


def _number(word: str) -> float:
    try:
        return float(word.replace(",", ".")) if "_" not in word else math.nan
    except ValueError:
        return math.nan
