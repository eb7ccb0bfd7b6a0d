"""C3D is written back byte for byte but for what was edited, and anew as others read it."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import ezc3d
import numpy as np
import pytest
from c3d_bytes import DEC, INTEL, MIPS, Made

from mocapstudio.formats import Declared, ReadOptions, WriteOptions, read_any, write
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.markers import Event, MarkerTake

FRAMES, MARKERS = 40, 6


def made(**more: object) -> Made:
    generator = np.random.default_rng(3)
    xyz = np.add(generator.uniform(-700, 700, (1, MARKERS, 3)), (0, 0, 900))
    xyz = xyz + generator.normal(scale=30, size=(FRAMES, MARKERS, 3))
    fourth = np.full((FRAMES, MARKERS), 3 << 8 | 5)
    fourth[5:8, 2] = -1
    labels = ["LHEE", "RHEE", "C7", "LHipAngles", "LTOE", "*9"]
    group = {"POINT": {"X_SCREEN": "+X", "Y_SCREEN": "+Z"}}
    group["TRIAL"] = {"ACTUAL_START_FIELD": [11, 0], "ACTUAL_END_FIELD": [50, 0]}  # type: ignore[dict-item]
    return Made(xyz, fourth, labels=labels, first=11, more=group, **more)  # type: ignore[arg-type]


@pytest.fixture(params=[(INTEL, -1.0), (INTEL, 0.1), (DEC, -1.0), (MIPS, 0.1)])
def path(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    processor, scale = request.param
    file = tmp_path / "take.c3d"
    file.write_bytes(made(processor=processor, scale=scale, analog=4).data())
    return file


def read_one(path: Path, **options: object) -> MarkerTake:
    (take,) = read_any(path, ReadOptions(**options))[0]  # type: ignore[arg-type]
    assert isinstance(take, MarkerTake)
    return take


def test_unedited_is_written_back_byte_for_byte(path: Path, tmp_path: Path) -> None:
    write(read_one(path), tmp_path / "out.c3d")
    assert (tmp_path / "out.c3d").read_bytes() == path.read_bytes()


def test_edits_touch_their_cells_alone(path: Path, tmp_path: Path) -> None:
    take = read_one(path)
    positions = take.positions.copy()
    heel, toe, neck = (take.index[label] for label in ("RHEE", "LTOE", "C7"))
    positions[10:14, heel] += (0.011, -0.02, 0.03)
    positions[20, toe] = np.nan
    positions[5:8, neck] = positions[4, neck]
    filled = np.zeros(positions.shape[:2], dtype=bool)
    filled[5:8, neck] = True
    declared = [Declared("RHEE", 10, 14), Declared("LTOE", 20, 21), Declared("C7", 4, 9)]
    out = tmp_path / "out.c3d"
    write(take.with_positions(positions, filled), out, declared=declared)
    again = read_one(out)
    # Integers of 0.1 mm round.
    np.testing.assert_allclose(again.positions, positions, atol=6e-5)
    assert np.isnan(again.positions[20, toe]).all()
    assert again.filled is not None
    assert again.filled[5:8, neck].all()
    before, after = (np.frombuffer(p.read_bytes(), dtype=np.uint8) for p in (path, out))
    assert before.shape == after.shape
    record = take.source.record  # type: ignore[union-attr]
    start, stride, cell = record.layout.start, record.layout.stride, 4 * record.layout.width
    changed = np.flatnonzero(before != after) - start
    assert (changed >= 0).all()
    cells = {(int(at // stride), int(at % stride // cell)) for at in changed}
    expected = {(f, 1) for f in range(10, 14)} | {(20, 4)} | {(f, 2) for f in (5, 6, 7)}
    assert cells == expected


def lying(tmp_path: Path) -> Path:
    """A body that lies still, most of its markers unseen most of the time; no up axis stated."""
    t = np.linspace(0, 1, 12)
    xyz = np.stack([1800 * t, 120 * np.sin(9 * t), 90 * np.cos(7 * t)], axis=1)
    xyz = np.repeat(xyz[None], 60, axis=0) + 5 * np.sin(np.arange(60))[:, None, None]
    fourth = np.zeros((60, 12))
    # Only those in the middle, set on end, are seen all the time.
    xyz[:, 4:8, 2] += np.array([0, 300, 600, 900])
    unseen = [0, 1, 2, 3, 8, 9, 10, 11]
    fourth[14:46, unseen] = -1
    path = tmp_path / "lying.c3d"
    path.write_bytes(Made(xyz, fourth).data())
    return path


def test_what_was_filled_changes_no_guess_and_stays_marked(tmp_path: Path) -> None:
    path = lying(tmp_path)
    take = read_one(path)
    assert take.filled is None
    gaps = take.missing
    # What is filled would say by itself that another axis points up.
    positions = np.where(gaps[..., None], take.positions[:1], take.positions)
    out = tmp_path / "out.c3d"
    declared = [Declared(label, 14, 46) for label in take.labels]
    write(take.with_positions(positions, gaps), out, declared=declared)
    again = read_one(out)
    np.testing.assert_allclose(again.positions, positions, atol=6e-5)
    np.testing.assert_array_equal(again.filled, gaps)
    # Coordinates that were there are the same to the bit.
    before, after = (read_one(one, up="y").positions for one in (path, out))
    assert np.array_equal(before[~gaps], after[~gaps])


def test_changes_that_nobody_declared_are_refused(path: Path, tmp_path: Path) -> None:
    take = read_one(path)
    positions = take.positions.copy()
    positions[10:12, 0] += 0.5
    edited = take.with_positions(positions)
    with pytest.raises(MocapError, match=r"marker LHEE at frame 11"):
        write(edited, tmp_path / "out.c3d", declared=[Declared("LHEE", 0, 11)])
    with pytest.raises(MocapError, match="declared row Nose is none of"):
        write(edited, tmp_path / "out.c3d", declared=[Declared("Nose", 0, 11)])
    with pytest.raises(MocapError, match="must be written anew"):
        write(replace(take, labels=("a", "b", "c", "d")), tmp_path / "out.c3d")
    assert not (tmp_path / "out.c3d").exists()


def test_places_beyond_the_files_integers_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "take.c3d"
    path.write_bytes(made(scale=0.05).data())
    take = read_one(path)
    positions = take.positions.copy()
    positions[3, 1] = 5.0
    with pytest.raises(MocapError, match="RHEE moves beyond the 1638"):
        write(
            take.with_positions(positions), tmp_path / "out.c3d", declared=[Declared("RHEE", 3, 4)]
        )


def test_another_rate_is_stated(path: Path, tmp_path: Path) -> None:
    write(read_one(path, fps=Fraction(50)), tmp_path / "out.c3d")
    (again,), report = read_any(tmp_path / "out.c3d")
    assert again.rate == 50
    assert not any(problem.override == "fps" for problem in report.problems)


def test_trim_cuts_whole_frames(path: Path, tmp_path: Path) -> None:
    take = replace(read_one(path), trim=(4, 21))
    write(take, tmp_path / "out.c3d", options=WriteOptions(trim=True))
    (again,), report = read_any(tmp_path / "out.c3d")
    np.testing.assert_array_equal(again.positions, take.positions[4:21])
    assert again.first_frame == 15
    assert not any("frames" in problem.what for problem in report.problems)
    if take.source.record.layout.numbers.processor != MIPS:  # type: ignore[union-attr]
        theirs = ezc3d.c3d(str(tmp_path / "out.c3d"))
        assert theirs["data"]["points"].shape == (4, MARKERS, 17)


def in_memory(frames: int = 30, markers: int = 5) -> MarkerTake:
    generator = np.random.default_rng(1)
    positions = np.add(generator.normal(scale=0.4, size=(frames, markers, 3)), (0, 1, 0))
    positions[3:5, 1] = np.nan
    filled = np.zeros((frames, markers), dtype=bool)
    filled[frames // 2, 0] = True
    return MarkerTake(
        "made",
        tuple(f"Ann:Märker{i}" for i in range(markers)),
        positions,
        Fraction(120000, 1001),
        first_frame=90000,
        filled=filled,
        events=(Event("Left Foot Strike", 0.1), Event("clap", 0.2)),
    )


@pytest.mark.parametrize("unit", [None, "mm", "cm", "m", "in"])
@pytest.mark.parametrize("up", [None, "x", "y", "z"])
def test_anew_and_back(tmp_path: Path, unit: str | None, up: str | None) -> None:
    from mocapstudio.formats.options import UNITS

    take = in_memory()
    options = WriteOptions(unit=UNITS[unit] if unit else None, up=up)  # type: ignore[arg-type]
    write(take, tmp_path / "out.c3d", options=options)
    (again,), report = read_any(tmp_path / "out.c3d")
    np.testing.assert_allclose(again.positions, take.positions, atol=1e-6)
    assert (again.labels, again.rate, again.first_frame) == (take.labels, take.rate, 90000)
    np.testing.assert_array_equal(again.filled, take.filled)
    assert [event.name for event in again.events] == ["Left Foot Strike", "clap"]
    np.testing.assert_allclose([e.time for e in again.events], [0.1, 0.2], atol=1e-4)
    assert [p.what for p in report.problems] == ["2 samples of 1 markers marked as invalid"]


def test_anew_as_another_library_reads_it(tmp_path: Path) -> None:
    take = in_memory(markers=300)
    write(take, tmp_path / "out.c3d", options=WriteOptions(unit=0.01, up="z"))
    theirs = ezc3d.c3d(str(tmp_path / "out.c3d"))
    points = theirs["data"]["points"][:3].transpose(2, 1, 0)
    # Y up to Z up, metres to centimetres.
    expected = take.positions[..., [0, 2, 1]] * (100, -100, 100)
    np.testing.assert_allclose(points, expected, atol=1e-4)
    point = theirs["parameters"]["POINT"]
    names = point["LABELS"]["value"] + point["LABELS2"]["value"]
    assert tuple(names) == take.labels
    assert point["UNITS"]["value"] == ["cm"]
    assert point["Y_SCREEN"]["value"] == ["+Z"]
    assert theirs["header"]["points"]["frame_rate"] == pytest.approx(119.88, abs=1e-3)
    np.testing.assert_allclose(theirs["parameters"]["EVENT"]["TIMES"]["value"][0], [12, 12])


def test_long_takes_as_another_library_reads_them(tmp_path: Path) -> None:
    take = replace(in_memory(70_000, 2), first_frame=1, filled=None)
    write(take, tmp_path / "out.c3d")
    assert ezc3d.c3d(str(tmp_path / "out.c3d"))["data"]["points"].shape == (4, 2, 70_000)
    (again,), report = read_any(tmp_path / "out.c3d")
    assert again.frames == 70_000
    assert [p.what for p in report.problems if not p.guess] == [
        "2 samples of 1 markers marked as invalid"
    ]


def test_units_without_a_name_are_refused(tmp_path: Path) -> None:
    with pytest.raises(MocapError, match=r"no name for a unit of 0\.3 m"):
        write(in_memory(), tmp_path / "out.c3d", options=WriteOptions(unit=0.3))


def test_more_than_the_format_holds_is_refused(tmp_path: Path) -> None:
    take = in_memory(8, 3000)
    take = replace(take, labels=tuple(f"{label}{'x' * 60}" for label in take.labels))
    with pytest.raises(MocapError, match="C3D cannot hold 3000 markers"):
        write(take, tmp_path / "out.c3d")
