"""The installed command, and takes written by hand for it."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from mocapstudio.cli.kernel_cache import VARIABLE, place_kernel_cache

COMMAND = Path(sys.executable).with_name("mocapstudio")
RATE = 30

# Joint, children: a plain figure in centimetres, Y up; every joint rotates ZXY.
_TREE = (
    "Hips",
    (0, 95, 0),
    [
        (
            "Spine",
            (0, 25, 0),
            [
                ("Head", (0, 35, 0), []),
                ("LeftArm", (20, 20, 0), [("LeftForeArm", (28, 0, 0), [])]),
                ("RightArm", (-20, 20, 0), [("RightForeArm", (-28, 0, 0), [])]),
            ],
        ),
        ("LeftLeg", (10, 0, 0), [("LeftShin", (0, -45, 0), [])]),
        ("RightLeg", (-10, 0, 0), [("RightShin", (0, -45, 0), [])]),
    ],
)


def _joint(tree: tuple, depth: int, names: list[str], rename: Callable[[str], str]) -> list[str]:
    name, offset, children = tree
    names.append(name)
    pad = "\t" * depth
    position = "Xposition Yposition Zposition " if depth == 0 else ""
    lines = [
        f"{pad}{'JOINT' if depth else 'ROOT'} {rename(name)}",
        pad + "{",
        f"{pad}\tOFFSET {offset[0]:.2f} {offset[1]:.2f} {offset[2]:.2f}",
        f"{pad}\tCHANNELS {6 if depth == 0 else 3} {position}Zrotation Xrotation Yrotation",
    ]
    for child in children:
        lines += _joint(child, depth + 1, names, rename)
    if not children:
        lines += [f"{pad}\tEnd Site", pad + "\t{", f"{pad}\t\tOFFSET 0 -20 0", pad + "\t}"]
    return [*lines, pad + "}"]


class Figure:
    """A figure whose joints swing with a period of their own; a BVH text on demand.

    `values` is (frames, 3 + 3 * joints): the root's position in cm, then each joint's Z, X, Y
    angles in degrees.
    """

    def __init__(self, seconds: float = 16.0, seed: int = 0, prefix: str = "") -> None:
        self.names: list[str] = []
        self.head = _joint(_TREE, 0, self.names, lambda name: prefix + name)
        rng = np.random.default_rng(seed)
        frames = round(seconds * RATE)
        time = np.arange(frames)[:, None] / RATE
        size = rng.uniform(5, 25, 3 * len(self.names))
        phase = rng.uniform(0, 2 * np.pi, size.size)
        # All joints share one period, as in a gait: the figure repeats itself.
        angles = size * np.sin(2 * np.pi * time / 1.1 + phase)
        angles += 0.5 * rng.standard_normal(size.size) * np.sin(0.7 * time)
        angles[:, :3] *= 0.2
        root = np.column_stack([np.zeros(frames), np.full(frames, 95.0), 60 * time[:, 0]])
        self.values = np.hstack([root, angles])

    def columns(self, joint: str) -> slice:
        start = 3 + 3 * self.names.index(joint)
        return slice(start, start + 3)

    def raise_error(self, joint: str, start: int, end: int, degrees: float) -> Figure:
        self.values[start:end, self.columns(joint).start] += degrees
        return self

    def gesture(self, joint: str, start: int, end: int, degrees: float) -> Figure:
        """Bend a joint smoothly there and back, as a person might."""
        course = degrees * np.hanning(end - start)
        self.values[start:end, self.columns(joint).start] += course
        return self

    def lines(self) -> list[str]:
        return [
            "HIERARCHY",
            *self.head,
            "MOTION",
            f"Frames: {len(self.values)}",
            f"Frame Time: {1 / RATE:.7f}",
            *(" ".join(f"{value:.4f}" for value in row) for row in self.values),
        ]

    def write(self, path: Path) -> Path:
        path.write_text("\n".join(self.lines()) + "\n")
        return path


@pytest.fixture(scope="session")
def figure() -> type[Figure]:
    return Figure


Run = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture(scope="session")
def caches(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """What is learnt is kept apart from the user's; compiled kernels are shared with it."""
    kernels = str(place_kernel_cache())
    return {"XDG_CACHE_HOME": str(tmp_path_factory.mktemp("cache")), VARIABLE: kernels}


@pytest.fixture
def mocapstudio(tmp_path: Path, caches: dict[str, str]) -> Run:
    """Run the installed command in a folder of the test's own; its output is no terminal."""

    def run(*words: object, **environment: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [str(COMMAND), *map(str, words)],
            cwd=tmp_path,
            env={**os.environ, **caches, **environment},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=300,
        )

    return run


@pytest.fixture
def broken(tmp_path: Path, figure: type[Figure]) -> Path:
    """A take of 16 s in which the left forearm is off by 60° over frames 200 to 215."""
    return figure().raise_error("LeftForeArm", 200, 215, 60.0).write(tmp_path / "broken.bvh")
