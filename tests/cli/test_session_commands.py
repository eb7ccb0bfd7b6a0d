"""`export` and `report`, on a session saved beside its takes."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from mocapstudio import formats
from mocapstudio.cleaning.model import Proposal
from mocapstudio.review import session_file
from mocapstudio.review.document import Document


@pytest.fixture
def session(tmp_path: Path, figure) -> Path:
    """Two performers, of which one was edited, and a partner."""
    document = Document("ana")
    for seed, name in enumerate(("one", "two", "partner")):
        path = figure(seconds=2.0, seed=seed).write(tmp_path / f"{name}.bvh")
        document.open_take(formats.read(path)[0][0], partner=name == "partner")
    still = np.tile([0.0, 0.0, 0.0, 1.0], (10, 1, 1))
    document.add_edit(Proposal(("LeftArm",), 5, 15, still, None, "interpolation"))
    session_file.save(document, tmp_path / "s.mocapstudio")
    return tmp_path / "s.mocapstudio"


def test_export_writes_what_was_decided(session: Path, mocapstudio) -> None:
    done = mocapstudio("export", session, "-o", "out", "--json", "-")
    assert (done.returncode, done.stderr) == (0, "")
    told = json.loads(done.stdout)["takes"]
    folder = session.parent
    assert [(Path(t["path"]).name, Path(t["output"]).name) for t in told] == [
        ("one.bvh", "one.bvh"),
        ("two.bvh", "two.bvh"),
    ]
    assert told[0]["changes"] == [
        {"joint": "LeftArm", "start": 5, "end": 15, "method": "interpolation", "donor": None}
    ]
    assert told[1]["changes"] == []
    assert (folder / "out" / "two.bvh").read_bytes() == (folder / "two.bvh").read_bytes()
    before, after = (
        (place / "one.bvh").read_text().splitlines() for place in (folder, folder / "out")
    )
    first = before.index("MOTION") + 3
    assert [n for n, (a, b) in enumerate(zip(before, after, strict=True)) if a != b] == list(
        range(first + 5, first + 15)
    )
    assert sorted(p.name for p in (folder / "out").iterdir()) == [
        "one.bvh",
        "one.provenance.json",
        "two.bvh",
        "two.provenance.json",
    ]


def test_export_refuses_to_overwrite_the_takes(session: Path, mocapstudio) -> None:
    before = (session.parent / "one.bvh").read_bytes()
    done = mocapstudio("export", session, "-o", ".")
    assert done.returncode == 2
    assert done.stderr.startswith("error: ")
    assert "input" in done.stderr
    assert (session.parent / "one.bvh").read_bytes() == before


@pytest.mark.parametrize("command", ["export", "report"])
@pytest.mark.parametrize(
    ("damage", "cause"),
    [
        (lambda folder: (folder / "two.bvh").unlink(), "two.bvh is missing"),
        (lambda folder: (folder / "s.mocapstudio").write_text("x"), "no session"),
        (
            lambda folder: (folder / "two.bvh").write_bytes(
                (folder / "two.bvh").read_bytes() + b"\n"
            ),
            "has changed",
        ),
    ],
)
def test_a_session_that_is_not_whole_is_one_line(
    session: Path, mocapstudio, command: str, damage, cause: str
) -> None:
    damage(session.parent)
    done = mocapstudio(command, session, "-o", "out.html" if command == "report" else "out")
    assert done.returncode == 2
    assert cause in done.stderr
    assert done.stderr.startswith(f"error: {session}: -: ")
    assert done.stderr.count("\n") == 1
    assert not (session.parent / "out").exists()
    assert not (session.parent / "out.html").exists()


def test_report_writes_one_file(session: Path, mocapstudio) -> None:
    done = mocapstudio("report", session, "-o", "out.html")
    assert (done.returncode, done.stderr) == (0, "")
    text = (session.parent / "out.html").read_text(encoding="utf-8")
    assert "LeftArm" in text
    assert text.rstrip().endswith("</html>")
