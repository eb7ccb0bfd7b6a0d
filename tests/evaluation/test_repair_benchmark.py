"""Repairing cases by the engine, beside the paper's own way and the peers."""

from __future__ import annotations

import numpy as np
from made_takes import walking

from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.model import Kind
from mocapstudio.evaluation.cases import Case
from mocapstudio.evaluation.injection import inject_each
from mocapstudio.evaluation.repair_benchmark import (
    by_peer,
    medoid_given_truth,
    ours_given_truth,
    untouched,
)
from mocapstudio.evaluation.repair_metrics import changed_outside, event_errors
from mocapstudio.evaluation.repair_peers import slerp
from mocapstudio.motion.progress import run

KINDS = (Kind.OFFSET, Kind.SWAP, Kind.LIMB, Kind.SPIKE, Kind.HEADING_FLIP, Kind.DRIFT)


def test_the_engine_leaves_less_of_the_errors_than_interpolation_and_the_medoid() -> None:
    clean = walking(20.0, 30, seed=0)
    dirty, truths = inject_each(clean, KINDS, np.random.default_rng(5))
    case = Case(dirty, clean, truths, (walking(10.0, 30, seed=1), walking(10.0, 30, seed=2)))
    analysis = run(detect(dirty, case.context))
    left = {}
    for name, repairer in {
        "nothing": untouched,
        "slerp": by_peer(slerp),
        "medoid": medoid_given_truth,
        "ours": ours_given_truth,
    }.items():
        result = repairer(case, analysis)
        assert changed_outside(dirty, result.take, result.declared) == 0
        degrees = [event.degrees_mean for event in event_errors(case, result.take)]
        assert len(degrees) == len(truths) >= 5
        left[name] = float(np.mean(degrees))
    assert left["ours"] < 0.5 * min(left["slerp"], left["medoid"])
    assert max(left["slerp"], left["medoid"]) < left["nothing"]
