"""Which takes go together: named sets, actions, splits, joined takes.

Nothing is read before it is needed, and nothing twice in a process.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import Literal

import numpy as np

from mocapstudio import formats
from mocapstudio.evaluation.truth import Mask
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.facing import carrier, hips_world, split_heading
from mocapstudio.motion.take import Take

Split = Literal["development", "test"]
OWN = "own"

NAMED: dict[str, tuple[str, str]] = {
    "locomotion": (r"bandai_2", r"_(run|walk)"),
    "varied": (r"bandai_1", r""),
    "salsa": (r"cmu_salsa", r""),
    "own rate": (r"cmu_(salsa|locomotion|dance)", r""),
}
"""Sets of takes by patterns of their folder and file name; any other folder is ``"own"``."""

_JOIN_IGNORED = 8.0
_SHORTEST_SECONDS = 15 / 24
_JUMP = np.radians(20.0)


@dataclass(frozen=True)
class Entry:
    """A take on disk that has not been read yet.

    Parameters
    ----------
    path
        The file.
    performer, action
        As far as the file's name tells, else empty.
    digest
        SHA-256 of the file's bytes.
    """

    path: Path
    performer: str
    action: str
    digest: str

    def read(self) -> Take:
        """Read the file's first performer; see `read_take`."""
        return read_take(self.path)


def entries(data: Path | Sequence[Path], corpus: str) -> tuple[Entry, ...]:
    """Takes of a named set below `data`, in order of their paths, each content once.

    Parameters
    ----------
    data
        Files or folders.
    corpus
        A key of `NAMED`, or ``"own"`` for every take there is.

    Raises
    ------
    MocapError
        If there is no such set, or no take of it.
    """
    if corpus != OWN and corpus not in NAMED:
        raise MocapError(f"no set of takes named {corpus!r}: {', '.join([*NAMED, OWN])}")
    folder, name = NAMED.get(corpus, ("", ""))
    places = (data,) if isinstance(data, Path) else tuple(data)
    chosen: dict[str, Entry] = {}
    for path in _listed(places):
        if re.search(folder, path.resolve().parent.name) and re.search(name, path.stem):
            digest = _digest(path)
            chosen.setdefault(digest, Entry(path, *_label(path.stem), digest))
    if not chosen:
        raise MocapError(f"no take of the set {corpus!r} below {', '.join(map(str, places))}")
    return tuple(chosen.values())


def available(data: Path | Sequence[Path]) -> tuple[str, ...]:
    """Names of the sets that `data` holds; ``("own",)`` where it holds none of the named."""
    found = []
    for corpus in NAMED:
        try:
            entries(data, corpus)
        except MocapError:
            continue
        found.append(corpus)
    return tuple(found) or (OWN,)


def split(all_entries: Sequence[Entry], part: Split, seed: int = 0) -> tuple[Entry, ...]:
    """Half of the entries: parameters are chosen on one half and measured on the other.

    Whole performers go to one half where four or more are known; else each action's takes are
    dealt out by a hash of seed and content, so that both halves hold every action.
    """
    performers = sorted({e.performer for e in all_entries})
    many = len(performers) >= 4 and "" not in performers

    def order(text: str) -> str:
        return hashlib.sha256(f"{seed}:{text}".encode()).hexdigest()

    if many:
        dealt = sorted(performers, key=order)
        mine = set(dealt[0::2] if part == "development" else dealt[1::2])
        return tuple(e for e in all_entries if e.performer in mine)
    chosen = []
    turn = 0
    for action in sorted({e.action for e in all_entries}):
        group = sorted(
            (e for e in all_entries if e.action == action), key=lambda e: order(e.digest)
        )
        for entry in group:
            if (turn % 2 == 0) == (part == "development"):
                chosen.append(entry)
            turn += 1
    return tuple(sorted(chosen, key=lambda e: e.path))


@lru_cache(maxsize=512)
def read_take(path: Path) -> Take:
    """Read the first performer of a file, without a synthetic pose in its first frame.

    Raises
    ------
    MocapError
        If the file cannot be read, holds no skeleton, or less than one motion-word.
    """
    takes, _ = formats.read(path)
    if not takes:
        raise MocapError(f"{path}: no skeletal motion in the file")
    take = _without_pose(takes[0])
    if take.duration < _SHORTEST_SECONDS:
        raise MocapError(f"{path}: shorter than a motion-word")
    return take


def read_some(
    chosen: Iterable[Entry], most: int | None = None, like: Take | None = None
) -> list[Take]:
    """Read up to `most` takes of one skeleton and rate; what cannot be used is passed over.

    Skeleton and rate are those of `like`, else of the first usable take where `most` is given,
    else the commonest.
    """
    takes: list[Take] = []
    first = like
    for entry in chosen:
        if most is not None and len(takes) >= most:
            break
        try:
            take = entry.read()
        except MocapError:
            continue
        if most is not None and first is None:
            first = take
        if first is None or _form(first) == _form(take):
            takes.append(take)
    return takes if first is not None else same_kind(takes)


def long_takes(files: Iterable[Path], seconds: float) -> Iterator[Take]:
    """Read takes of joints that last at least so long; what cannot be read is passed over."""
    for file in files:
        try:
            found, _ = formats.read_any(file)
        except MocapError:
            continue
        yield from (one for one in found if isinstance(one, Take) and one.duration >= seconds)


def join(takes: Sequence[Take], name: str | None = None) -> tuple[Take, Mask]:
    """Put takes of one skeleton and rate behind one another.

    Each goes on where the one before ended, facing the same way.

    Returns
    -------
    The joined take, and (F,) the frames within 8 frames at 24 fps of a join, which are to be left
    out of scoring.
    """
    first = takes[0]
    placed = [first]
    for take in takes[1:]:
        placed.append(_follow(placed[-1], take))
    rotations = np.concatenate([t.rotations for t in placed])
    translations = np.concatenate([t.translations for t in placed])
    joined = replace(
        first,
        name=name or "+".join(t.name for t in takes),
        rotations=rot.continuous(rotations),
        translations=translations,
        trim=None,
        source=None,
    )
    near = round(_JOIN_IGNORED * float(first.rate) / 24.0)
    ignore = np.zeros(joined.frames, dtype=bool)
    for at in np.cumsum([t.frames for t in placed])[:-1]:
        ignore[max(0, at - near) : at + near] = True
    return joined, ignore


def same_kind(takes: Sequence[Take]) -> list[Take]:
    """Return the takes that share the commonest skeleton (joint names) and rate among them."""
    groups: dict[object, list[Take]] = {}
    for take in takes:
        groups.setdefault(_form(take), []).append(take)
    return max(groups.values(), key=len) if groups else []


def _form(take: Take) -> tuple[object, ...]:
    return take.skeleton.names, take.rate, take.translated


@lru_cache(maxsize=8)
def _listed(places: tuple[Path, ...]) -> tuple[Path, ...]:
    return tuple(sorted(formats.find_takes(places)))


@lru_cache(maxsize=4096)
def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _label(stem: str) -> tuple[str, str]:
    """Performer and action from names such as ``60_10_scaled`` or ``dataset-1_bow_old_001``."""
    cmu = re.match(r"(\d+)_\d+", stem)
    if cmu:
        return cmu.group(1), ""
    parts = [p for p in re.split(r"[_\s.]", stem) if not re.fullmatch(r"\d+|dataset-\d+", p)]
    return "", (parts[0] if parts else "")


def _without_pose(take: Take) -> Take:
    # Some conversions put a T-pose before the motion: a jump of many joints at once.
    if take.frames < 3:
        return take
    jumped = rot.angle(take.rotations[0], take.rotations[1]) > _JUMP
    if jumped.sum() < 3:
        return take
    return replace(
        take,
        rotations=take.rotations[1:],
        translations=take.translations[1:],
        first_frame=take.first_frame + 1,
        trim=None,
    )


def _follow(before: Take, take: Take) -> Take:
    """Turn and move a take so that its hips start where those of the other ended."""
    last, _ = hips_world(before, before.frames - 1)
    facing, _ = split_heading(before, before.frames - 1)
    start, _ = hips_world(take, 0, 1)
    first, _ = split_heading(take, 0, 1)
    turn = rot.about_axis(1, facing[-1] - first[0])
    # Only what stands above all else may be moved as a whole; a fixed root stays where it is.
    at = carrier(take)
    joint = take.translated[at]
    if take.skeleton.ancestors(joint) and not _root_is_still(take):
        at, joint = 0, 0
    rotations, translations = take.rotations.copy(), take.translations.copy()
    rotations[:, joint] = rot.multiply(turn, rotations[:, joint])
    ground = start[0] * np.array([1.0, 0.0, 1.0])
    moved = rot.rotate(turn, translations[:, at] - ground)
    translations[:, at] = moved + last[-1] * np.array([1.0, 0.0, 1.0])
    return take.with_motion(rotations, translations)


def _root_is_still(take: Take) -> bool:
    still = np.ptp(take.translations[:, 0], axis=0).max() < 1e-6
    return bool(still and np.abs(take.rotations[:, 0, 3]).min() > 1 - 1e-9)
