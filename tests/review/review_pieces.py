"""Small takes, flags and analyses to review."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path

import numpy as np

from mocapstudio.cleaning.model import DigressionMap, Flag, Kind, Neighbour, Proposal
from mocapstudio.cleaning.parameters import DetectionParameters
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import ROOT_POSITION, ROOT_ROWS
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take
from mocapstudio.review.document import Document

NAMES = ("Hips", "Spine", "LeftUpLeg", "LeftLeg", "RightUpLeg", "RightLeg")
_PARENTS = (-1, 0, 0, 2, 0, 4)
_OFFSETS = ((0, 0.9, 0), (0, 0.3, 0), (0.1, 0, 0), (0, -0.4, 0), (-0.1, 0, 0), (0, -0.4, 0))
ROWS = (*NAMES, *ROOT_ROWS)


def small_take(name: str = "walk", frames: int = 120, seed: int = 0, rate: int = 30) -> Take:
    """Six joints that swing at random, sign-continuous."""
    random = np.random.default_rng(seed)
    skeleton = Skeleton(
        NAMES,
        np.array(_PARENTS),
        np.array(_OFFSETS, dtype=float),
        np.array([1, 3, 5]),
        np.array([[0, 0.2, 0], [0, 0, 0.1], [0, 0, 0.1]]),
    )
    angles = np.cumsum(random.normal(0, 0.05, (frames, len(NAMES), 3)), axis=0)
    rotations = rot.continuous(rot.from_rotation_vector(angles))
    places = np.cumsum(random.normal(0, 0.01, (frames, 1, 3)), axis=0)
    return Take(name, skeleton, rotations, places, Fraction(rate))


def flag(
    joint: str, start: int, end: int, score: float = 0.8, kind: Kind = Kind.SPIKE, peak: int = -1
) -> Flag:
    at = (start + end) // 2 if peak < 0 else peak
    return Flag(f"{joint}:{start}", joint, (joint,), start, end, score, at, score, kind)


def proposal(take: Take, one: Flag, seed: int = 0, pad: int = 0) -> Proposal:
    """Some other motion for a flag's row."""
    random = np.random.default_rng(seed)
    start, end = max(0, one.start - pad), min(take.frames, one.end + pad)
    joints = () if one.joint in ROOT_ROWS else (one.joint,)
    if one.joint == ROOT_ROWS[1]:
        joints = (NAMES[0],)
    rotations = rot.from_rotation_vector(random.normal(0, 1, (end - start, len(joints), 3)))
    moved = random.normal(0, 1, (end - start, 3)) if one.joint == ROOT_POSITION else None
    donor = Neighbour("other", 3, 3 + end - start, 12.5, 1)
    return Proposal(joints, start, end, rotations, moved, "neighbours", donor)


def random_map(take: Take, seed: int) -> DigressionMap:
    random = np.random.default_rng(seed)
    waves = np.cumsum(random.normal(0, 0.12, (take.frames, len(ROWS))), axis=0)
    values = (0.5 + 0.5 * np.sin(waves)).astype(np.float32)
    return DigressionMap(ROWS, values, values * 40)


@dataclass(frozen=True, eq=False)
class MapAnalysis:
    """As much of an analysis as the document asks for: runs above the threshold are flags."""

    take: Take
    map: DigressionMap
    parameters: DetectionParameters
    flags: tuple[Flag, ...]
    context: tuple[Take, ...] = ()

    def with_threshold(self, threshold: float) -> MapAnalysis:
        return analysed(self.take, self.map, threshold)


def analysed(take: Take, mapped: DigressionMap, threshold: float = 0.5) -> MapAnalysis:
    flags = []
    for column, row in enumerate(mapped.rows):
        above = np.concatenate([[False], mapped.values[:, column] > threshold, [False]])
        edges = np.flatnonzero(np.diff(above.astype(int)))
        for start, end in edges.reshape(-1, 2).tolist():
            values = mapped.values[start:end, column]
            score = float(values.mean())
            kind = Kind.SPIKE if end - start < 8 else Kind.DRIFT
            flags.append(flag(row, start, end, score, kind, start + int(values.argmax())))
    parameters = replace(DetectionParameters(), threshold=threshold)
    return MapAnalysis(take, mapped, parameters, tuple(flags))


@dataclass(frozen=True, eq=False)
class FixedAnalysis:
    """An analysis with given flags, whatever the threshold."""

    take: Take
    flags: tuple[Flag, ...]
    parameters: DetectionParameters = field(default_factory=DetectionParameters)
    context: tuple[Take, ...] = ()

    @property
    def map(self) -> DigressionMap:
        return random_map(self.take, 0)

    def with_threshold(self, threshold: float) -> FixedAnalysis:
        return replace(self, parameters=replace(self.parameters, threshold=threshold))


def analyse(document: Document, flags: tuple[Flag, ...], performer: str = "walk") -> None:
    """Hand the document an analysis that raised these flags, with a proposal for each."""
    take = document.source(performer)
    generation = document.begin_analysis(performer)
    assert document.finish_analysis(performer, generation, FixedAnalysis(take, flags))
    if performer == document.state.active:
        for n, one in enumerate(flags):
            document.set_proposal(one.id, None, proposal(take, one, n))


def document_with(*flags: Flag, frames: int = 120) -> Document:
    document = Document("ana")
    document.open_take(small_take(frames=frames))
    analyse(document, flags)
    return document


def write_bvh(path: Path, take: Take) -> Path:
    from mocapstudio import formats

    formats.write(take, path)
    return path


def read_bvh(path: Path) -> Take:
    from mocapstudio import formats

    return formats.read(path)[0][0]
