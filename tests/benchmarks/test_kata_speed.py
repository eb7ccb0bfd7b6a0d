"""A kata aligned with path: 2,675 x 2,675 frames of 25 markers (bench: 60 ms)."""

from __future__ import annotations

import numpy as np
import pytest

from mocapstudio.evaluation.kata_benchmark import KATA_FRAMES, KATA_MARKERS
from mocapstudio.similarity.alignment.costs import PoseDistances
from mocapstudio.similarity.alignment.dtw import align


@pytest.fixture(scope="module")
def poses() -> tuple[np.ndarray, np.ndarray]:
    steps = np.random.default_rng(0).normal(0, 0.02, (2, KATA_FRAMES, 3 * KATA_MARKERS))
    one, other = np.cumsum(steps, axis=1).astype(np.float32)
    return one, other


def test_whole_matrix(benchmark, poses) -> None:
    found = benchmark(lambda: align(PoseDistances(*poses)))
    assert len(found.path) >= KATA_FRAMES
