"""`export` and `report` of sessions that hold markers."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from mocapstudio import formats
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.progress import run
from mocapstudio.review import session_file
from mocapstudio.review.document import Document
from mocapstudio.review.marker_fills import filling


@pytest.fixture
def session(tmp_path: Path) -> Path:
    """Three markers as TRC; one gap was filled, two labels exchanged."""
    t = np.arange(30) / 30
    places = np.stack([np.stack([t + k, np.sin(t + k), t * k], axis=1) for k in range(3)], axis=1)
    places[10:14, 1] = np.nan
    formats.write(MarkerTake("m", ("a", "b", "c"), places, Fraction(30)), tmp_path / "m.trc")
    (take,), _ = formats.read_any(tmp_path / "m.trc")
    assert isinstance(take, MarkerTake)
    document = Document("ana")
    name = document.open_markers(take)
    document.fill_gaps(name, run(filling(take, "spline")), "spline")
    document.exchange_markers(name, "a", "c", 20, 25)
    session_file.save(document, tmp_path / "s.mocapstudio")
    return tmp_path / "s.mocapstudio"


def test_export_writes_markers_with_their_edits(session: Path, mocapstudio) -> None:
    done = mocapstudio("export", session, "-o", "out.trc", "--json", "-")
    assert (done.returncode, done.stderr) == (0, "")
    (told,) = json.loads(done.stdout)["takes"]
    shared = {"donor": None}
    assert told["changes"] == [
        shared
        | {"joint": "b", "start": 10, "end": 14, "method": "spline", "kind": "fill", "with": None},
        *(
            shared
            | {"joint": one, "start": 20, "end": 25, "method": "labels exchanged",
               "kind": "exchange", "with": other}
            for one, other in ("ac", "ca")
        ),
    ]  # fmt: skip
    (before,), _ = formats.read_any(session.parent / "m.trc")
    (after,), _ = formats.read_any(session.parent / "out.trc")
    assert not after.missing.any()
    assert np.array_equal(after.positions[20:25, 0], before.positions[20:25, 2])
    rest = np.ones(before.missing.shape, dtype=bool)
    rest[10:14, 1] = rest[20:25, 0] = rest[20:25, 2] = False
    assert np.array_equal(after.positions[rest], before.positions[rest])
    provenance = json.loads((session.parent / "out.provenance.json").read_text())
    assert provenance["filled"] == [{"marker": "b", "start": 10, "end": 14}]


def test_export_keeps_the_ending_of_markers_in_a_folder(session: Path, mocapstudio) -> None:
    done = mocapstudio("export", session, "-o", "out", "--json", "-")
    assert done.returncode == 0
    assert {one.name for one in (session.parent / "out").iterdir()} == {
        "m.trc",
        "m.provenance.json",
    }


def test_a_report_tells_of_markers(session: Path, mocapstudio) -> None:
    done = mocapstudio("report", session, "-o", "r.html")
    assert (done.returncode, done.stderr) == (0, "")
    text = (session.parent / "r.html").read_text()
    assert "spline" in text
    assert "labels exchanged" in text
