from __future__ import annotations

import numpy as np
import pytest

from mocapstudio.cleaning.model import Kind
from mocapstudio.evaluation.alternatives import (
    _squared,
    chai_hodgins,
    geodesic,
    tuned_alternatives,
)
from mocapstudio.evaluation.cases import Case
from mocapstudio.evaluation.injection import inject
from mocapstudio.motion import rotations as rot
from mocapstudio.similarity.texture import comparable_joints, motion_texture
from mocapstudio.similarity.words import Corpus, WordShape


def corpus_of(takes):
    joints = comparable_joints(takes[0], takes[1:])
    return Corpus.of([motion_texture(one, joints) for one in takes])


@pytest.mark.parametrize("search", [geodesic, chai_hodgins])
def test_the_same_motion_elsewhere_is_the_nearest(make_take, search) -> None:
    take, other = make_take(4.0, seed=0), make_take(4.0, seed=1)
    turned = take.rotations.copy()
    turned[:, 0] = rot.multiply(rot.about_axis(1, 1.0), turned[:, 0])
    again = take.with_motion(turned, take.translations + 3.0)
    corpus = corpus_of([take, other, again])
    found = search(take, (other, again), corpus, WordShape())
    assert len(found.words) > 10
    for starts, distances in zip(found.found, found.distances, strict=True):
        which, _ = corpus.locate(int(starts[0]))
        # The swing repeats, so the take itself is as near as its copy.
        assert which in (0, 2)
        assert distances[0] < 1e-3


def test_squared_distances_agree_with_scipy() -> None:
    from scipy.spatial.distance import cdist

    rng = np.random.default_rng(0)
    a, b = (rng.standard_normal((n, 12)).astype(np.float32) for n in (7, 30))
    assert np.allclose(_squared(a, b), cdist(a, b, "sqeuclidean"), atol=1e-4)


def test_both_distances_find_a_large_error(make_take) -> None:
    context = [make_take(6.0, seed=0), make_take(5.0, seed=0)]
    take = make_take(8.0, seed=0)
    dirty, truth = inject(
        take, Kind.OFFSET, np.random.default_rng(1), joints=["Chest"], magnitude=70
    )
    case = Case(dirty, take, (truth,), tuple(context))
    detectors = tuned_alternatives([case])
    assert set(detectors) == {"paper 1, fixed scale", "Chai-Hodgins"}
    for detector in detectors.values():
        flags = detector(dirty, context).flags
        assert any(f.joint == "Chest" and f.overlaps(truth.start, truth.end) for f in flags)
