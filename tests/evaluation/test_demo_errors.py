"""The demo's known errors are where the truth says, and nowhere else."""

from __future__ import annotations

import json
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from mocapstudio import formats
from mocapstudio.cleaning.model import Kind
from mocapstudio.evaluation.demo import demo_context, demo_take, demo_with_errors, write_demo
from mocapstudio.evaluation.truth import Truth
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION, ROOT_ROWS


def test_every_kind_occurs_once_and_no_two_meet() -> None:
    _, truths = demo_with_errors()
    assert sorted(t.kind for t in truths) == sorted(Kind)
    for one, following in pairwise(truths):
        assert one.end + 30 < following.start


def test_the_take_differs_from_the_clean_one_in_the_truths_alone() -> None:
    spoilt, truths = demo_with_errors()
    clean = demo_take()
    index = clean.skeleton.index
    changed = (spoilt.rotations != clean.rotations).any(axis=-1)
    moved = (spoilt.translations != clean.translations).any(axis=(1, 2))
    allowed = np.zeros_like(changed)
    allowed_moves = np.zeros_like(moved)
    for truth in truths:
        span = slice(truth.start, truth.end)
        joints = [index[row] for row in truth.joints if row not in ROOT_ROWS]
        joints += [0] if ROOT_HEADING in truth.joints else []
        allowed[span, joints] = True
        allowed_moves[span] |= ROOT_POSITION in truth.joints
        assert (changed[span][:, joints] if joints else moved[span]).any()
    assert not (changed & ~allowed).any()
    assert not (moved & ~allowed_moves).any()


def test_the_context_is_clean_and_different() -> None:
    first, second = demo_context(2)
    assert first.skeleton.names == demo_take().skeleton.names
    assert not np.allclose(first.rotations, second.rotations, atol=1e-3)
    assert len({first.name, second.name, demo_take().name}) == 3


def test_the_files_hold_the_take_and_the_truth(tmp_path: Path) -> None:
    files = write_demo(tmp_path / "new" / "folder")
    (take,), report = formats.read(files.take)
    spoilt, truths = demo_with_errors()
    np.testing.assert_allclose(take.translations, spoilt.translations, atol=1e-6)
    assert take.rate == spoilt.rate
    assert not [p for p in report.problems if not p.guess]
    read = [Truth.from_json(one) for one in json.loads(files.truth.read_text())]
    assert tuple(read) == truths
    assert sorted(formats.find_takes([files.take.parent / "context"])) == sorted(files.context)


def test_a_folder_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("a file")
    with pytest.raises(FileError, match="taken"):
        write_demo(tmp_path / "taken")
