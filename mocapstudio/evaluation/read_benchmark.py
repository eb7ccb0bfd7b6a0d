"""How fast a large BVH becomes arrays, beside other libraries: the extra ``peers`` has them."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from mocapstudio import formats

MEGABYTES = 10.0
_JOINTS = 43


@contextmanager
def large_bvh(megabytes: float = MEGABYTES) -> Iterator[Path]:
    """Make a BVH of about so many megabytes: a chain of 43 joints in six decimals."""
    with tempfile.TemporaryDirectory(prefix="mocapstudio-large-") as folder:
        path = Path(folder) / "large.bvh"
        path.write_text(_text(megabytes), encoding="ascii")
        yield path


def _text(megabytes: float) -> str:
    header = ["HIERARCHY"]
    for joint in range(_JOINTS):
        header += [f"{'JOINT' if joint else 'ROOT'} joint{joint}", "{", "OFFSET 0 3.5 0"]
        position = "3" if joint else "6 Xposition Yposition Zposition"
        header.append(f"CHANNELS {position} Zrotation Xrotation Yrotation")
    header += ["End Site", "{", "OFFSET 0 3.5 0", "}"]
    header += ["}"] * _JOINTS
    columns = 3 + 3 * _JOINTS
    steps = np.random.default_rng(0).normal(scale=0.5, size=(200, columns))
    # A walk there and back goes on without a jump, however often it is repeated.
    walk = np.cumsum(np.concatenate([steps, -steps[::-1]]), axis=0)
    rows = [" ".join(f"{value:.6f}" for value in row) for row in walk]
    times = max(1, round(megabytes * 1e6 / (sum(map(len, rows)) + len(rows))))
    motion = ["MOTION", f"Frames: {times * len(rows)}", "Frame Time: 0.0083333"]
    return "\n".join([*header, *motion, *(rows * times)]) + "\n"


def ours(path: Path) -> object:
    """Read a file to the arrays of a take."""
    return formats.read(path)


def pybvh(path: Path) -> object:
    """Read a file by pybvh."""
    from pybvh import read_bvh_file

    return read_bvh_file(path)


def bvhio(path: Path) -> object:
    """Read a file by bvhio to its own poses."""
    from bvhio import readAsBvh

    return readAsBvh(str(path))


def bvh(path: Path) -> object:
    """Read a file by bvh, and its words as numbers."""
    from bvh import Bvh

    return np.array(Bvh(path.read_text(encoding="ascii")).frames, dtype=np.float64)


PEERS: dict[str, Callable[[Path], object]] = {"pybvh": pybvh, "bvhio": bvhio, "bvh": bvh}
"""Other readers by the name of their library."""


def installed() -> dict[str, Callable[[Path], object]]:
    """Return the peers that can be imported."""
    return {name: peer for name, peer in PEERS.items() if find_spec(name) is not None}
