"""FBX: from a file to takes, by way of Blender."""

from __future__ import annotations

import hashlib
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.fbx_blender import run_blender
from mocapstudio.formats.fbx_bones import Bones, trees
from mocapstudio.formats.guesses import guess_unit, turn_to_inside
from mocapstudio.formats.options import ReadOptions, parse_rate
from mocapstudio.formats.report import ImportReport, Problem
from mocapstudio.motion.errors import FileError, MocapError
from mocapstudio.motion.take import Source, Take

_BINARY = b"Kaydara FBX Binary"
_TEXT = b"FBXHeaderExtension"


def looks_like_fbx(head: bytes) -> bool:
    """Tell FBX by its first bytes."""
    return head.startswith(_BINARY) or (head.startswith(b";") and _TEXT in head)


def read_fbx(path: Path, data: bytes, options: ReadOptions) -> tuple[list[Take], ImportReport]:
    """Read every skeleton of an FBX as Blender has it, in its frames.

    The unit and the axes that the file states are Blender's concern: it hands over metres. What
    the options say counts on top of that, for files that state them wrongly.

    Raises
    ------
    FileError
        If it is no FBX, there is no Blender, Blender cannot read it, or it holds no skeleton.
    """
    if not looks_like_fbx(data[:4096]):
        raise FileError(path, "not FBX: neither its binary nor its text form", offset=0)
    with tempfile.TemporaryDirectory(prefix="mocapstudio-fbx-") as folder:
        source, target = Path(folder) / "take.fbx", Path(folder) / "take.npz"
        source.write_bytes(data)
        try:
            run_blender("read", source, target)
            with np.load(target, allow_pickle=False) as found:
                arrays = dict(found)
        except (MocapError, OSError, ValueError) as bad:
            raise FileError(path, str(bad)) from bad
    problems: list[Problem] = []
    takes = _takes(path, hashlib.sha256(data).hexdigest(), arrays, options, problems)
    if not takes:
        raise FileError(path, "holds no skeleton that Blender knows: no armature with bones")
    problems.sort(key=lambda problem: problem.guess)
    return takes, ImportReport(path, "fbx", tuple(problems))


def _takes(
    path: Path,
    digest: str,
    arrays: Mapping[str, NDArray[Any]],
    options: ReadOptions,
    problems: list[Problem],
) -> list[Take]:
    fps, base = arrays["fps"]
    rate = options.fps or parse_rate(f"{fps / base:.9g}")
    found: list[tuple[str, Bones]] = []
    number = 0
    while f"{number}/names" in arrays:
        one = {key: arrays[f"{number}/{key}"] for key in ("names", "parents", "rest", "world")}
        bones = Bones(tuple(map(str, one["names"])), one["parents"], one["rest"], one["world"])
        found += [(str(arrays[f"{number}/name"]), tree) for tree in trees(bones, problems)]
        number += 1
    actions = int(arrays["actions"])
    if actions > number:
        what = f"{actions} animations for {number} skeletons"
        problems.append(Problem(None, what, "read the one that Blender shows"))
    done = f"by Blender {arrays['blender']}, in metres"
    problems.append(Problem(None, "read at the frames of its scene", done))
    takes = []
    for performer, (name, bones) in enumerate(found):
        skeleton, rotations, translations, translated = bones.motion(
            _unit(bones, options, problems), turn_to_inside(options.up or "y", options.forward)
        )
        takes.append(
            Take(
                name=path.stem if len(found) == 1 else f"{path.stem} {name}",
                skeleton=skeleton,
                rotations=rotations,
                translations=translations,
                rate=rate,
                translated=translated,
                source=Source(path, "fbx", digest, performer=performer),
            )
        )
    return takes


def _unit(bones: Bones, options: ReadOptions, problems: list[Problem]) -> float:
    if options.unit is not None:
        return options.unit
    unit, why = guess_unit(bones.skeleton())
    # Within the usual sizes of bodies the stated unit is to be trusted.
    if 0.2 < unit < 5:
        return 1.0
    done = f"guessed {unit:.4g} m for each ({why})"
    problems.append(Problem(None, "the stated unit gives no body's size", done, "unit", guess=True))
    return unit
