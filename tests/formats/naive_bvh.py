"""A second BVH reader, as simple as can be: the oracle of the tests. Matrices by SciPy."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation


@dataclass
class NaiveJoint:
    name: str
    parent: int
    offset: np.ndarray
    channels: list[tuple[str, int]]


@dataclass
class NaiveBvh:
    joints: list[NaiveJoint]
    rows: np.ndarray
    frame_time: str

    def positions(self) -> np.ndarray:
        """(F, J, 3) in units of the file: channels replace offsets, in listed order."""
        frames = len(self.rows)
        places, turns = [], []
        for joint in self.joints:
            local = np.tile(joint.offset, (frames, 1))
            turn = Rotation.from_quat(np.tile([0.0, 0.0, 0.0, 1.0], (frames, 1)))
            for channel, column in joint.channels:
                axis = "XYZ".index(channel[0].upper())
                if channel[1:].lower() == "position":
                    local[:, axis] = self.rows[:, column]
                else:
                    vector = np.zeros((frames, 3))
                    vector[:, axis] = np.radians(self.rows[:, column])
                    turn = turn * Rotation.from_rotvec(vector)
            if joint.parent < 0:
                places.append(local)
                turns.append(turn)
            else:
                places.append(places[joint.parent] + turns[joint.parent].apply(local))
                turns.append(turns[joint.parent] * turn)
        return np.stack(places, axis=1)


def read(path: Path, step: int = 1) -> NaiveBvh:
    """Read every `step`-th row of a well-formed file with one ROOT and a line a row."""
    header, _, motion = path.read_text().replace("\r", "").partition("MOTION\n")
    joints: list[NaiveJoint] = []
    stack: list[int | None] = []
    pending: int | None = None
    column = 0
    words = iter(header.split())
    for word in words:
        if word in ("ROOT", "JOINT"):
            parent = next((one for one in reversed(stack) if one is not None), -1)
            joints.append(NaiveJoint(next(words), parent, np.zeros(3), []))
            pending = len(joints) - 1
        elif word == "End":
            next(words)
            pending = None
        elif word == "{":
            stack.append(pending)
        elif word == "}":
            stack.pop()
        elif word == "OFFSET":
            offset = np.array([float(next(words)) for _ in range(3)])
            if stack[-1] is not None:
                joints[stack[-1]].offset = offset
        elif word == "CHANNELS":
            for _ in range(int(next(words))):
                joints[stack[-1]].channels.append((next(words), column))
                column += 1
    lines = [line for line in motion.split("\n") if line.strip()]
    rows = np.array([[float(cell) for cell in line.split()] for line in lines[2::step]])
    return NaiveBvh(joints, rows, lines[1].split(":")[1].strip())
