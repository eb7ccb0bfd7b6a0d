"""Repairs of two flags that change the same joint keep each other."""

from __future__ import annotations

import numpy as np

from mocapstudio.cleaning.detection import detect
from mocapstudio.evaluation.demo import demo_take
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import ROOT_HEADING, split_heading
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology
from mocapstudio.review.document import Document


def _spoilt() -> tuple[Take, Take, slice]:
    """A walk, and the same with its hips turned and tilted over a third of a second."""
    whole = demo_take(seed=3)
    frames = round(12 * float(whole.rate))
    clean = Take(
        "walk", whole.skeleton, whole.rotations[:frames], whole.translations[:frames], whole.rate
    )
    span = slice(frames // 2, frames // 2 + round(float(whole.rate) / 3))
    rotations = clean.rotations.copy()
    hips = topology(clean.skeleton).hips
    turned = rot.multiply(rot.about_axis(1, np.array(1.2)), rotations[span, hips])
    rotations[span, hips] = rot.multiply(turned, rot.about_axis(0, np.array(0.7)))
    return clean, clean.with_motion(rot.continuous(rotations)), span


def test_heading_and_tilt_of_the_hips_are_both_repaired() -> None:
    clean, spoilt, span = _spoilt()
    document = Document()
    performer = document.open_take(spoilt)
    analysis = run(detect(spoilt))
    document.finish_analysis(performer, document.begin_analysis(performer), analysis)
    hips = topology(clean.skeleton).hips
    name = clean.skeleton.names[hips]
    for row in (name, ROOT_HEADING):
        found = [f for f in analysis.flags if f.joint == row and f.overlaps(span.start, span.stop)]
        assert found, f"{row} was not flagged"
        document.accept(found[0].id)
    result = document.result(performer)
    away = rot.angle(result.rotations[span, hips], clean.rotations[span, hips])
    before = rot.angle(spoilt.rotations[span, hips], clean.rotations[span, hips])
    assert np.rad2deg(before.mean()) > 45.0
    assert np.rad2deg(away.mean()) < 20.0
    turned = np.abs(split_heading(result)[0] - split_heading(clean)[0])[span]
    assert np.rad2deg(turned.mean()) < 15.0
