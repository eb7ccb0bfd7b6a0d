from __future__ import annotations

from pathlib import Path

import pytest

from mocapstudio.evaluation.corpora import read_take
from mocapstudio.evaluation.labels import read_labels
from mocapstudio.evaluation.truth import analysed_rows, labelled

LABELS = Path(__file__).resolve().parents[1] / "salsa" / "labels.json"


@pytest.fixture(scope="module")
def salsa(data) -> Path:
    """The folder of the dancers' takes."""
    folder: Path = data / "cmu_salsa_pairs_bvh"
    if not folder.is_dir():
        pytest.skip(f"no salsa takes: {folder} does not exist")
    return folder


def test_every_take_is_labelled_or_said_to_be_clean(salsa) -> None:
    assert set(read_labels(LABELS)) == {path.stem for path in salsa.glob("*.bvh")}


def test_labels_name_joints_and_frames_of_their_takes(salsa) -> None:
    for stem, truths in read_labels(LABELS).items():
        if not truths:
            continue
        take = read_take(salsa / f"{stem}.bvh")
        rows = analysed_rows(take.skeleton)
        mask = labelled(take.frames, rows, truths)
        named = {joint for truth in truths for joint in truth.joints}
        assert {row for row, wrong in zip(rows, mask.any(axis=0), strict=True) if wrong} == named
