from __future__ import annotations

import numpy as np
import pytest
from bvh_text import bvh, walk

from mocapstudio import formats
from mocapstudio.formats.changes import changes, covered, undeclared
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION
from mocapstudio.motion.take import Take


@pytest.fixture
def take(tmp_path) -> Take:
    (tmp_path / "a.bvh").write_text(bvh(walk()))
    return formats.read(tmp_path / "a.bvh")[0][0]


def test_what_each_row_covers(take: Take) -> None:
    names = take.skeleton.names
    rows = [Declared("LeftLeg", 3, 5), Declared(ROOT_POSITION, 7, 9), Declared(ROOT_HEADING, 1, 2)]
    allowed = covered(take, rows)
    assert {(f, names[j]) for f, j in zip(*np.nonzero(allowed.rotations), strict=True)} == {
        *((3, "LeftLeg"), (4, "LeftLeg"), (1, "Hips"))
    }
    assert np.flatnonzero(allowed.translations[:, 0]).tolist() == [7, 8]


def test_spans_beyond_the_take_cover_what_there_is(take: Take) -> None:
    allowed = covered(take, [Declared("Spine", -5, 3), Declared("Head", 28, 99)])
    assert allowed.rotations.sum() == 3 + 2


def test_bandais_root_rows_are_those_of_its_hips(data) -> None:
    path = data / "bandai_1_styles_bvh_CCBYNC4" / "dataset-1_bow_active_001.bvh"
    (take,), _ = formats.read(path)
    allowed = covered(take, [Declared(ROOT_POSITION, 0, 1), Declared(ROOT_HEADING, 0, 1)])
    assert np.flatnonzero(allowed.translations[0]).tolist() == [1]
    turned = {take.skeleton.names[j] for j in np.flatnonzero(allowed.rotations[0])}
    assert turned == {"joint_Root", "Hips"}


def test_a_sample_that_is_no_number_counts_as_changed(take: Take) -> None:
    rotations = take.rotations.copy()
    rotations[4, 2, 1] = np.nan
    found = changes(take.with_motion(rotations=rotations), take)
    assert np.argwhere(found.rotations).tolist() == [[4, 2]]
    assert "LeftLeg at frame 4" in undeclared(take, found, [])


def test_takes_that_do_not_correspond(take: Take) -> None:
    shorter = Take("short", take.skeleton, take.rotations[:5], take.translations[:5], take.rate)
    with pytest.raises(MocapError, match="anew"):
        changes(shorter, take)
