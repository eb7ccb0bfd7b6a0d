"""A made-up sitting for the plots: a walking skeleton, a map with known errors, real document."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from fractions import Fraction

import numpy as np

from mocapstudio.cleaning.model import DigressionMap, Flag, Kind, Proposal
from mocapstudio.cleaning.parameters import DetectionParameters
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take
from mocapstudio.review.document import Document

NAMES = (
    "Hips",
    "Spine",
    "Spine1",
    "Chest",
    "Neck",
    "Head",
    "LeftShoulder",
    "LeftArm",
    "LeftForeArm",
    "LeftHand",
    "RightShoulder",
    "RightArm",
    "RightForeArm",
    "RightHand",
    "LeftUpLeg",
    "LeftLeg",
    "LeftFoot",
    "LeftToeBase",
    "RightUpLeg",
    "RightLeg",
    "RightFoot",
    "RightToeBase",
)
_PARENTS = (-1, 0, 1, 2, 3, 4, 3, 6, 7, 8, 3, 10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20)
_OFFSETS = {
    "Hips": (0, 0, 0),
    "Spine": (0, 0.1, 0),
    "Spine1": (0, 0.12, 0),
    "Chest": (0, 0.12, 0),
    "Neck": (0, 0.18, 0),
    "Head": (0, 0.1, 0),
    "Shoulder": (0.06, 0.14, 0),
    "Arm": (0.12, 0, 0),
    "ForeArm": (0.28, 0, 0),
    "Hand": (0.25, 0, 0),
    "UpLeg": (0.1, -0.05, 0),
    "Leg": (0, -0.42, 0),
    "Foot": (0, -0.4, 0),
    "ToeBase": (0, -0.05, 0.13),
}


def skeleton() -> Skeleton:
    """A humanoid of 22 joints that faces +Z."""
    offsets = []
    for name in NAMES:
        part = name.removeprefix("Left").removeprefix("Right")
        x, y, z = _OFFSETS[part]
        offsets.append((-x if name.startswith("Right") else x, y, z))
    ends = [NAMES.index(n) for n in ("Head", "LeftHand", "RightHand")]
    return Skeleton(
        names=tuple(NAMES),
        parents=np.array(_PARENTS, dtype=np.int64),
        offsets=np.array(offsets, dtype=float),
        end_parents=np.array(ends, dtype=np.int64),
        end_offsets=np.tile([0.0, 0.1, 0.0], (len(ends), 1)),
    )


def walking(frames: int = 1200, rate: int = 120, first_frame: int = 1) -> Take:
    """Something that swings its limbs and goes forward."""
    bones = skeleton()
    seconds = np.arange(frames) / rate
    vectors = np.zeros((frames, len(bones), 3))
    generator = np.random.default_rng(4)
    for joint, name in enumerate(NAMES):
        swing = 0.6 if "Leg" in name or "Arm" in name else 0.08
        phase = np.pi if name.startswith("Right") else 0.0
        vectors[:, joint, 0] = swing * np.sin(2 * np.pi * 0.9 * seconds + phase)
        vectors[:, joint, 1] = 0.1 * np.sin(2 * np.pi * 0.45 * seconds + generator.uniform(0, 6))
        vectors[:, joint, 2] = 0.2 * swing * np.cos(2 * np.pi * 0.7 * seconds)
    root = np.stack(
        [0.1 * np.sin(seconds), 0.95 + 0.03 * np.sin(11 * seconds), 1.2 * seconds], axis=-1
    )
    return Take(
        name="walking",
        skeleton=bones,
        rotations=rot.continuous(rot.from_rotation_vector(vectors)),
        translations=root[:, None],
        rate=Fraction(rate),
        first_frame=first_frame,
    )


ERRORS = (
    ("LeftForeArm", 0.20, 0.24, 0.92, Kind.OFFSET),
    ("LeftHand", 0.20, 0.24, 0.71, Kind.LIMB),
    ("RightLeg", 0.37, 0.40, 0.83, Kind.FREEZE),
    ("Head", 0.52, 0.55, 0.66, Kind.NOISE),
    ("Spine1", 0.61, 0.612, 0.97, Kind.POP),
    ("RightHand", 0.70, 0.78, 0.58, Kind.DRIFT),
    ("root position", 0.86, 0.865, 0.88, Kind.ROOT_POP),
)


@dataclass(frozen=True, eq=False)
class MapAnalysis:
    """The part of an analysis that views look at, with flags where the errors were put."""

    take: Take
    map: DigressionMap
    flags: tuple[Flag, ...]
    parameters: DetectionParameters = field(default_factory=DetectionParameters)
    unanalysed: tuple[str, ...] = ()

    def with_threshold(self, threshold: float) -> MapAnalysis:
        kept = tuple(flag for flag in self.all_flags() if flag.peak >= threshold)
        parameters = replace(self.parameters, threshold=threshold)
        return replace(self, flags=kept, parameters=parameters)

    def all_flags(self) -> tuple[Flag, ...]:
        return errors_of(self.take)


def errors_of(take: Take) -> tuple[Flag, ...]:
    flags = []
    known = (*take.skeleton.names, *ROOT_ROWS)
    for number, (name, a, b, peak, kind) in enumerate(ERRORS):
        row = name if name in known else take.skeleton.names[3 * number + 1]
        start = int(a * take.frames)
        end = max(start + 1, int(b * take.frames))
        flags.append(
            Flag(f"{row}@{start}", row, (row,), start, end, peak, (start + end) // 2, peak, kind)
        )
    return tuple(sorted(flags, key=lambda flag: -flag.score))


def analysis_of(take: Take) -> MapAnalysis:
    """A quiet, smooth map with one bump for each of ERRORS."""
    rows = (*take.skeleton.names, *ROOT_ROWS)
    generator = np.random.default_rng(7)
    width = max(take.frames // 60, 4)
    knots = generator.gamma(1.6, 0.06, (take.frames // width + 3, len(rows)))
    at = np.arange(take.frames) / width
    low = at.astype(int)
    blend = (0.5 - 0.5 * np.cos(np.pi * (at - low)))[:, None]
    values = knots[low] * (1 - blend) + knots[low + 1] * blend
    for flag in errors_of(take):
        inside = np.arange(flag.start, flag.end)
        shape = 0.75 + 0.25 * np.sin(np.pi * (inside - flag.start + 0.5) / len(inside))
        values[inside, rows.index(flag.joint)] = flag.peak * shape
    values = np.clip(values, 0, 1).astype(np.float32)
    mapped = DigressionMap(rows, values, (60 * values).astype(np.float32))
    return MapAnalysis(take, mapped, errors_of(take))


def sitting(take: Take | None = None, analysed: bool = True) -> Document:
    """A document with one take, analysed unless told otherwise."""
    document = Document(author="tester")
    performer = document.open_take(walking() if take is None else take)
    if analysed:
        analyse(document, performer)
    return document


def analyse(document: Document, performer: str) -> None:
    """Finish a made-up analysis of a performer."""
    generation = document.begin_analysis(performer)
    take = document.state.scene.performer(performer).take
    assert document.finish_analysis(performer, generation, analysis_of(take))


def offer(document: Document, flag_id: str, pad: int = 12) -> Proposal:
    """Keep a straight line through a flag's span as its proposal."""
    state = document.state
    item = state.item(flag_id)
    assert item is not None
    assert state.take is not None
    flag, take = item.flag, state.take
    start, end = max(flag.start - pad, 1), min(flag.end + pad, take.frames - 1)
    joint = take.skeleton.index.get(flag.joint, 0)
    share = np.linspace(0, 1, end - start)
    line = rot.slerp(take.rotations[start - 1, joint], take.rotations[end, joint], share)
    name = take.skeleton.names[joint]
    made = Proposal((name,), start, end, line[:, None], None, "interpolation")
    document.set_proposal(flag_id, None, made)
    return made
