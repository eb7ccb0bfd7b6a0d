from __future__ import annotations

import json

import numpy as np
import pytest

from mocapstudio import formats
from mocapstudio.cleaning.model import Kind
from mocapstudio.evaluation.cases import Case
from mocapstudio.evaluation.labels import departure_map, events_of, labelled_cases, read_labels
from mocapstudio.evaluation.truth import Truth, erroneous
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import FileError, MocapError


def test_labels_are_read_in_both_forms(tmp_path) -> None:
    own = tmp_path / "own.json"
    own.write_text(
        json.dumps(
            {
                "labels": [
                    {"take": "a", "joint": "Chest", "start": 3, "end": 9, "kind": "flip"},
                    {"take": "a.bvh", "joints": ["Neck", "Head"], "start": 20, "end": 30},
                ],
                "clean": ["b"],
            }
        )
    )
    assert read_labels(own) == {
        "a": (Truth(Kind.FLIP, ("Chest",), 3, 9), Truth(Kind.OFFSET, ("Neck", "Head"), 20, 30)),
        "b": (),
    }
    corrected = tmp_path / "detected.json"
    flag = {"joint": "Chest", "joints": ["Chest", "Neck"], "start": 3, "end": 9, "kind": "flip"}
    corrected.write_text(json.dumps({"takes": [{"path": "x/a.bvh", "flags": [flag]}]}))
    assert read_labels(corrected) == {"a": (Truth(Kind.FLIP, ("Chest",), 3, 9),)}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('{"labels":\n[,]}', ": 2: is not JSON"),
        ('{"labels": [{"take": "a", "joint": "b", "start": 5, "end": 5}]}', "span"),
        ('{"labels": [{"take": "a", "start": 5, "end": 8}]}', "joint"),
        ('{"labels": [{"take": "a", "joint": "b", "start": 1, "end": 8, "kind": "?"}]}', "'?'"),
        ("{}", "labels"),
        ("[1]", "labels"),
    ],
)
def test_what_is_no_label_is_refused_with_its_file(tmp_path, text, message) -> None:
    path = tmp_path / "labels.json"
    path.write_text(text)
    with pytest.raises(FileError, match=r"labels\.json") as caught:
        read_labels(path)
    assert message in str(caught.value)


def test_a_missing_file_is_told(tmp_path) -> None:
    with pytest.raises(FileError, match="cannot be read"):
        read_labels(tmp_path / "none.json")


def test_runs_of_the_mask_become_events(take) -> None:
    mask = np.zeros((40, 2), dtype=bool)
    mask[0:3, 0], mask[35:40, 0], mask[10:12, 1] = True, True, True
    found = [(t.joints, t.start, t.end) for t in events_of(mask, ("a", "b"))]
    assert found == [(("a",), 0, 3), (("b",), 10, 12), (("a",), 35, 40)]


def test_the_departure_map_passes_one_half_at_the_limit(take) -> None:
    rotations = take.rotations.copy()
    for frame, degrees in ((10, 5.0), (20, 10.0), (30, 40.0)):
        turn = rot.about_axis(0, np.radians(degrees))
        rotations[frame, 3] = rot.multiply(rotations[frame, 3], turn)
    case = Case(take.with_motion(rotations), take, (), ())
    column = case.rows.index(take.skeleton.names[3])
    values = departure_map(case)[:, column]
    assert values[10] < 0.5
    assert values[20] == pytest.approx(0.5)
    assert values[30] > 0.99
    assert np.flatnonzero(erroneous(case.clean, case.dirty)[:, column]).tolist() == [30]


def test_labelled_takes_are_scored_against_their_labels(data) -> None:
    folder = data / "cmu_salsa_pairs_bvh"
    labels = {"60_10_scaled": (Truth(Kind.SPIKE, ("lHand",), 100, 130),), "61_10_scaled": ()}
    made = labelled_cases([folder], labels, "small")
    assert [case.dirty.name for case in made] == ["60_10_scaled", "61_10_scaled"]
    assert len(made[0].context) == 8
    assert made[0].mask().sum() == 30
    # Labels count the file's frames, of which the take leaves the rest pose out.
    file = formats.read(folder / "60_10_scaled.bvh")[0][0]
    dropped = file.frames - made[0].dirty.frames
    assert dropped == 1
    assert made[0].mask()[100 - dropped : 130 - dropped, made[0].rows.index("lHand")].all()
    assert not made[1].mask().any()
    with pytest.raises(MocapError, match="no_such_take"):
        labelled_cases([folder], {"no_such_take": ()})
    with pytest.raises(MocapError, match="'nose'"):
        labelled_cases([folder], {"60_10_scaled": (Truth(Kind.SPIKE, ("nose",), 1, 3),)})
