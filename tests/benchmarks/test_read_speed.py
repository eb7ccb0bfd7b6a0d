"""How fast 10 MB of BVH become arrays, and how much memory that takes. Run with
`pytest tests/benchmarks --benchmark-enable`."""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import numpy as np
import pytest

from mocapstudio import formats

JOINTS = 43
MEGABYTES = 10


@pytest.fixture(scope="module")
def big(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A chain of 43 joints, 132 columns, six decimals, 10 MB."""
    header = ["HIERARCHY"]
    for joint in range(JOINTS):
        header += [f"{'JOINT' if joint else 'ROOT'} joint{joint}", "{", "OFFSET 0 3.5 0"]
        position = "6 Xposition Yposition Zposition" if joint == 0 else "3"
        header.append(f"CHANNELS {position} Zrotation Xrotation Yrotation")
    header += ["End Site", "{", "OFFSET 0 3.5 0", "}", "}" * JOINTS]
    frames = 8_000
    steps = np.random.default_rng(0).normal(scale=0.5, size=(frames, 3 + 3 * JOINTS))
    rows = np.cumsum(steps, axis=0)
    text = [*header, "MOTION", f"Frames: {frames}", "Frame Time: 0.0083333"]
    text += [" ".join(f"{value:.6f}" for value in row) for row in rows]
    path = tmp_path_factory.mktemp("big") / "big.bvh"
    path.write_text("\n".join(text) + "\n")
    assert path.stat().st_size > MEGABYTES * 1e6
    return path


def test_read(benchmark, big: Path) -> None:
    (take,), _ = benchmark(formats.read, big)
    assert take.frames == 8_000


def test_memory_stays_within_five_times_the_file(big: Path) -> None:
    formats.read(big)
    tracemalloc.start()
    takes, _ = formats.read(big)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert takes[0].frames == 8_000
    assert peak < 5 * big.stat().st_size


def test_write_back(benchmark, big: Path, tmp_path: Path) -> None:
    (take,), _ = formats.read(big)
    benchmark(formats.write, take, tmp_path / "out.bvh")
    assert (tmp_path / "out.bvh").stat().st_size == big.stat().st_size
