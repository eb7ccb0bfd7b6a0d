from __future__ import annotations

import hashlib
import json
from pathlib import Path

import numpy as np
import pytest
from review_pieces import analyse, document_with, flag, read_bvh, small_take, write_bvh

from mocapstudio import formats
from mocapstudio.cleaning.detection import detect
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.facing import ROOT_POSITION
from mocapstudio.motion.progress import run
from mocapstudio.review import session_file
from mocapstudio.review.document import Document
from mocapstudio.review.export import export, provenance_path

A, B, C = flag("Spine", 10, 20, 0.9), flag(ROOT_POSITION, 40, 50, 0.7), flag("Hips", 80, 95, 0.5)


@pytest.fixture
def document(tmp_path: Path) -> Document:
    document = Document("ana")
    document.open_take(read_bvh(write_bvh(tmp_path / "walk.bvh", small_take())))
    analyse(document, (A, B, C))
    return document


def test_without_a_decision_the_export_is_the_source(document: Document, tmp_path: Path) -> None:
    document.accept(A.id)
    document.mute_edit(document.state.sitting.edits[0].id)
    export(document, "walk", tmp_path / "out.bvh")
    assert (tmp_path / "out.bvh").read_bytes() == (tmp_path / "walk.bvh").read_bytes()


def test_only_accepted_rows_and_spans_differ(document: Document, tmp_path: Path) -> None:
    document.accept([A.id, B.id])
    document.reject(C.id)
    export(document, "walk", tmp_path / "out.bvh")
    before, after = document.source("walk"), read_bvh(tmp_path / "out.bvh")
    turned = np.abs((before.rotations * after.rotations).sum(axis=2)) < 1 - 1e-12
    assert np.argwhere(turned.any(axis=0)).ravel().tolist() == [1]
    assert np.flatnonzero(turned[:, 1]).tolist() == list(range(10, 20))
    moved = (before.translations != after.translations).any(axis=(1, 2))
    assert np.flatnonzero(moved).tolist() == list(range(40, 50))
    expected = document.result("walk")
    np.testing.assert_allclose(after.translations, expected.translations, atol=1e-6)
    alike = np.abs((after.rotations * expected.rotations).sum(axis=2))
    np.testing.assert_allclose(alike, 1.0, atol=1e-9)


def test_provenance_says_what_was_done_by_whom(document: Document, tmp_path: Path) -> None:
    document.accept([A.id, B.id])
    document.reject(C.id)
    document.protect(["Hips"], 0, 5)
    document.set_context([tmp_path])
    export(document, "walk", tmp_path / "out.bvh")
    told = json.loads((tmp_path / "out.provenance.json").read_text(encoding="utf-8"))
    assert [(c["joint"], c["start"], c["end"]) for c in told["changes"]] == [
        ("Spine", 10, 20),
        (ROOT_POSITION, 40, 50),
    ]
    spine = told["changes"][0]
    assert spine["method"] == "neighbours"
    assert spine["donor"] == {"take": "other", "start": 3, "end": 13}
    assert spine["author"] == "ana"
    assert spine["time"].endswith("Z")
    assert told["verdicts"] == {"open": 0, "accepted": 2, "rejected": 1, "deferred": 0}
    assert {d["joint"]: d["verdict"] for d in told["decisions"]}["Hips"] == "rejected"
    assert told["protected"][0]["joints"] == ["Hips"]
    assert told["parameters"]["threshold"] == 0.5
    assert told["context"]["paths"] == [str(tmp_path)]
    for name, file in (("take", "walk.bvh"), ("output", "out.bvh")):
        digest = hashlib.sha256((tmp_path / file).read_bytes()).hexdigest()
        assert told[name]["sha256"] == digest


def test_no_input_is_ever_overwritten(document: Document, tmp_path: Path) -> None:
    partner = write_bvh(tmp_path / "partner.bvh", small_take("partner", seed=1))
    context = write_bvh(tmp_path / "context.bvh", small_take("context", seed=2))
    document.open_take(read_bvh(partner), partner=True)
    document.set_context([tmp_path], [read_bvh(context)])
    session_file.save(document, tmp_path / "one.mocapstudio")
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    for name in ("walk.bvh", "partner.bvh", "context.bvh"):
        with pytest.raises(FileError, match="is an input"):
            export(document, "walk", tmp_path / name)
    assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_an_unwritable_place_is_a_file_error(document: Document, tmp_path: Path) -> None:
    with pytest.raises(FileError, match="cannot be written"):
        export(document, "walk", tmp_path / "none" / "out.bvh")


def test_a_take_made_in_memory_can_be_exported(tmp_path: Path) -> None:
    document = document_with(A)
    document.accept(A.id)
    document.trim(5, 50)
    export(document, "walk", tmp_path / "out.bvh", trim=True)
    assert read_bvh(tmp_path / "out.bvh").frames == 45
    assert provenance_path(tmp_path / "out.bvh").exists()


def test_a_real_take_detected_decided_and_exported(data: Path, tmp_path: Path) -> None:
    folder = data / "cmu_salsa_pairs_bvh"
    take = formats.read(folder / "60_10_scaled.bvh")[0][0]
    document = Document("ana")
    performer = document.open_take(take)
    analysis = run(detect(take, (), document.state.parameters))
    assert document.finish_analysis(performer, document.begin_analysis(performer), analysis)
    document.accept([item.flag.id for item in document.state.queue[:6]])
    session_file.save(document, tmp_path / "one.mocapstudio")
    loaded = session_file.load(tmp_path / "one.mocapstudio")
    assert loaded.state.queue == document.state.queue
    export(loaded, performer, tmp_path / "out.bvh")
    before, after = _table(folder / "60_10_scaled.bvh"), _table(tmp_path / "out.bvh")
    assert before[0] == after[0], "the hierarchy is copied as text"
    touched = np.zeros(take.frames, dtype=bool)
    for one in loaded.declared(performer):
        touched[one.start : one.end] = True
    differing = np.array([a != b for a, b in zip(before[1], after[1], strict=True)])
    assert differing.any()
    assert not (differing & ~touched).any()


def _table(path: Path) -> tuple[str, list[str]]:
    head, _, motion = path.read_text().partition("Frame Time")
    return head, [line for line in motion.splitlines()[1:] if line.strip()]
