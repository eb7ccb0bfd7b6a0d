"""Takes whose contacts are known: marked by eye, or made with planted feet."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from mocapstudio import formats
from mocapstudio.evaluation.demo.body import Motion
from mocapstudio.evaluation.demo.skeleton import BALL, HEEL, SIDES, demo_skeleton
from mocapstudio.evaluation.demo.take import RATE, demo_motion
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Key = tuple[str, str | None]
Part = Literal["development", "test"]

MADE_SECONDS = 40.0
"""Of each made take."""
_PLANTED = 0.001
"""Metres above its own resting height within which a point of a made take is in contact."""


@dataclass(frozen=True, eq=False)
class ContactCase:
    """A take with its true contacts.

    Parameters
    ----------
    take
        F frames.
    part
        Which half it belongs to.
    truth
        (F,) in contact or not, by joint and point.
    sure
        (F,) frames in which that is known, by joint and point.
    """

    take: Take
    part: Part
    truth: Mapping[Key, Mask]
    sure: Mapping[Key, Mask]


def marked(data: Sequence[Path], labels: Path) -> list[ContactCase]:
    """Read contacts that were marked by eye; takes that are not below `data` are left out.

    Parameters
    ----------
    data
        Folders of takes.
    labels
        A file, or a folder of them: ``{"take", "part", "span", "contacts", "unsure"}``, see
        ``tests/contacts/README.md``.

    Raises
    ------
    FileError
        If a file holds no such labels.
    """
    files = sorted(labels.glob("*.json")) if labels.is_dir() else [labels]
    cases = []
    for file in files:
        record = parsed(file)
        if "held" in record:
            continue
        try:
            path = below(data, record["take"])
            if path is not None:
                cases.append(_marked(formats.read(path)[0][0], record))
        except (KeyError, TypeError, ValueError, AttributeError) as cause:
            raise FileError(file, f"does not hold marked contacts: {cause}") from cause
    return cases


def parsed(file: Path) -> dict[str, Any]:
    """Read a file of labels.

    Raises
    ------
    FileError
        If it cannot be read or is no JSON.
    """
    try:
        content: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    except OSError as cause:
        raise FileError(file, f"cannot be read: {cause.strerror}") from cause
    except json.JSONDecodeError as cause:
        raise FileError(file, f"is no JSON: {cause.msg}", line=cause.lineno) from cause
    except UnicodeDecodeError as cause:
        raise FileError(file, "is no UTF-8 text", offset=cause.start) from cause
    return content


def below(data: Sequence[Path], name: str) -> Path | None:
    """Look for a take below the data, or below what the data lies in."""
    for folder in data:
        for base in (folder, folder.parent):
            if (base / name).is_file():
                return base / name
    return None


def _marked(take: Take, record: Mapping[str, Any]) -> ContactCase:
    truth, sure = {}, {}
    low, high = record["span"]
    for name, spans in record["contacts"].items():
        joint, point = name.rsplit(" ", 1)
        key: Key = (joint, point)
        truth[key] = mask_of(take.frames, spans)
        sure[key] = mask_of(take.frames, [(low, high)])
        sure[key] &= ~mask_of(take.frames, record["unsure"].get(name, []))
    part: Part = "test" if record["part"] == "test" else "development"
    return ContactCase(take, part, truth, sure)


def mask_of(frames: int, spans: Sequence[Sequence[int]]) -> Mask:
    """(frames,) True inside half-open spans."""
    mask = np.zeros(frames, dtype=bool)
    for start, end in spans:
        mask[start:end] = True
    return mask


def made(part: Part, seed: int) -> list[ContactCase]:
    """Make takes with planted feet: at several rates, noisy, small, on a slope.

    Parameters
    ----------
    part, seed
        Choose the takes; the same pair gives the same ones.
    """
    base = 1000 + 100 * seed + (50 if part == "test" else 0)
    return [made_case(name, part, base + i) for i, name in enumerate(KINDS)]


def made_case(kind: str, part: Part, seed: int) -> ContactCase:
    """Make one take with planted feet, `kind` one of `KINDS`."""
    change = KINDS[kind]
    motion = _walk(seed)
    frames = int(MADE_SECONDS * RATE)
    take = Take(
        f"{kind} {seed}",
        demo_skeleton(),
        motion.rotations[:frames],
        motion.root[:frames, None],
        RATE,
    )
    truth = _planted(take, {side: mask[:frames] for side, mask in motion.stance.items()})
    changed = change(take, seed)
    at = np.minimum(
        np.round(np.arange(changed.frames) * float(RATE / changed.rate)).astype(int), frames - 1
    )
    truth = {key: mask[at] for key, mask in truth.items()}
    return ContactCase(changed, part, truth, {key: np.ones(len(at), bool) for key in truth})


@lru_cache(maxsize=1)
def _walk(seed: int) -> Motion:
    return demo_motion(seed)


def _planted(take: Take, stance: Mapping[str, Mask]) -> dict[Key, Mask]:
    """Tell from the exact geometry of the made foot which of its points rest."""
    positions, world = take_pose(take)
    skeleton = take.skeleton
    tips = dict(zip(skeleton.end_parents.tolist(), skeleton.end_offsets, strict=True))
    truth: dict[Key, Mask] = {}
    for side, _ in SIDES:
        foot, toe = (skeleton.index[side + part] for part in ("Foot", "Toe"))
        heel = positions[:, foot] + rot.rotate(world[:, foot], HEEL)
        tip = positions[:, toe] + rot.rotate(world[:, toe], tips[toe])
        resting = {"heel": 0.0, "ball": BALL[1] - HEEL[1], "toe": BALL[1] - HEEL[1] + tips[toe][1]}
        heights = {"heel": heel[:, 1], "ball": positions[:, toe, 1], "toe": tip[:, 1]}
        for point, height in heights.items():
            joint = f"{side}Foot" if point == "heel" else f"{side}Toe"
            truth[joint, point] = stance[side] & (height < resting[point] + _PLANTED)
    return truth


def _at_rate(rate: int) -> Callable[[Take, int], Take]:
    def change(take: Take, seed: int) -> Take:
        count = int(take.duration * rate)
        at = np.minimum(np.arange(count) * float(take.rate) / rate, take.frames - 1)
        low = np.minimum(at.astype(int), take.frames - 2)
        part = (at - low)[:, None]
        rotations = rot.slerp(take.rotations[low], take.rotations[low + 1], part)
        before, after = take.translations[low], take.translations[low + 1]
        return replace(
            take,
            rotations=rot.continuous(rotations),
            translations=before + part[..., None] * (after - before),
            rate=Fraction(rate),
        )

    return change


def _noisy(take: Take, seed: int) -> Take:
    rng = np.random.default_rng(seed)
    shape = (*take.rotations.shape[:2], 3)
    shake = rot.from_rotation_vector(rng.normal(0.0, np.deg2rad(0.15), shape))
    root = take.translations + rng.normal(0.0, 0.001, take.translations.shape)
    return take.with_motion(rot.multiply(take.rotations, shake), root)


def _small(take: Take, seed: int) -> Take:
    scale = 0.4
    skeleton = replace(
        take.skeleton,
        offsets=take.skeleton.offsets * scale,
        end_offsets=take.skeleton.end_offsets * scale,
    )
    return replace(take, skeleton=skeleton, translations=take.translations * scale)


def _sloping(take: Take, seed: int) -> Take:
    turn = rot.from_rotation_vector(np.deg2rad(np.array([4.0, 0.0, 2.0])))
    rotations = take.rotations.copy()
    rotations[:, 0] = rot.multiply(turn, rotations[:, 0])
    moved = rot.rotate(turn, take.translations) + np.array([0.3, 1.0, -0.2])
    return take.with_motion(rotations, moved)


KINDS: dict[str, Callable[[Take, int], Take]] = {
    "60 Hz": lambda take, seed: take,
    "24 Hz": _at_rate(24),
    "120 Hz": _at_rate(120),
    "240 Hz": _at_rate(240),
    "noise": lambda take, seed: _noisy(_at_rate(120)(take, seed), seed),
    "small": _small,
    "slope": _sloping,
}
"""What is done to made takes, by name."""
