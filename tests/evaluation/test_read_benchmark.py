from __future__ import annotations

import numpy as np
import pytest

from mocapstudio.evaluation import read_benchmark
from mocapstudio.motion.take import Take


def test_the_large_file_has_its_size_and_is_gone_afterwards() -> None:
    with read_benchmark.large_bvh(0.5) as path:
        assert path.stat().st_size == pytest.approx(500_000, rel=0.15)
        ((take,), report) = read_benchmark.ours(path)  # type: ignore[misc]
        assert isinstance(take, Take)
        assert len(take.skeleton) == 43
        assert take.frames % 400 == 0
        assert all(problem.guess for problem in report.problems)
    assert not path.exists()


@pytest.mark.parametrize("name", read_benchmark.PEERS)
def test_peers_read_the_same_numbers(name: str) -> None:
    pytest.importorskip(name)
    with read_benchmark.large_bvh(0.5) as path:
        ((take,), _) = read_benchmark.ours(path)  # type: ignore[misc]
        theirs = read_benchmark.installed()[name](path)
        frames = {
            "bvh": lambda: len(theirs),  # type: ignore[arg-type]
            "bvhio": lambda: theirs.FrameCount,  # type: ignore[attr-defined]
            "pybvh": lambda: theirs.frame_count,  # type: ignore[attr-defined]
        }
        assert frames[name]() == take.frames
        if name == "bvh":
            place = np.asarray(theirs)[:, :3] * take.source.unit
            np.testing.assert_allclose(place, take.translations[:, 0], atol=1e-9)
