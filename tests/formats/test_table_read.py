"""Tables of markers and joints in the conventions of the field, and what is refused of them."""

from __future__ import annotations

import csv
import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from marker_text import places

from mocapstudio import formats
from mocapstudio.formats import ReadOptions
from mocapstudio.motion.errors import FileError, NoRateError
from mocapstudio.motion.markers import MarkerTake

LABELS = ("Head", "Hips", "LeftToe")
PLACES = places(frames=10, markers=3, seed=3)
AXES = "XYZ"


def read(path: Path, text: str | bytes, **options) -> tuple[MarkerTake, list[str]]:
    """Read a text, check that it is written back as it was, and return its problems as lines."""
    data = text if isinstance(text, bytes) else text.encode()
    path.write_bytes(data)
    [take], report = formats.read_any(path, ReadOptions(**options))
    assert isinstance(take, MarkerTake)
    assert take.source is not None
    if take.source.record is not None:
        copy = path.with_stem("copy")
        formats.write(take, copy)
        assert copy.read_bytes() == data
    return take, [f"{p.line}: {p.what}; {p.done}" for p in report.problems]


def table(names: list[str], delimiter: str = ",", rate: float = 50.0, decimals: int = 3) -> str:
    """A table with a time column and one row of names."""
    rows = [
        delimiter.join([f"{i / rate:.6f}", *(f"{v:.{decimals}f}" for v in row.ravel())])
        for i, row in enumerate(PLACES)
    ]
    return "\n".join([delimiter.join(["Time", *names]), *rows]) + "\n"


CONVENTIONS = {
    "{label} {axis}": "Qualisys",
    "{label}_{axis}": "underscore",
    "{label}.{axis}": "dot",
    "{label}:{axis}": "colon",
    "{label}{axis}": "camel case",
    "{label}.D{axis}": "R and MATLAB",
    "{label}_pos_{axis}": "kind in the name",
    "{label}_t{axis}": "Maya",
    "{label}Position{axis}": "kind in camel case",
    "{axis}_{label}": "axis first",
    "{label} {axis} (mm)": "with units",
    '"{label} {axis}"': "quoted",
}


# In camel case a small axis letter only ends a word.
WRITTEN = [(one, lower) for one in CONVENTIONS for lower in (False, True)]
WRITTEN.remove(("{label}{axis}", True))


@pytest.mark.parametrize(("convention", "lower"), WRITTEN)
def test_conventions_of_names(tmp_path: Path, convention: str, lower: bool) -> None:
    axes = AXES.lower() if lower else AXES
    names = [convention.format(label=label, axis=axis) for label in LABELS for axis in axes]
    for suffix, delimiter in ((".csv", ","), (".csv", ";"), (".tsv", "\t"), (".txt", "\t")):
        path = tmp_path / f"take{suffix}"
        path.write_text(table(names, delimiter))
        [take], _ = formats.read_any(path)
        assert take.labels == LABELS
        assert (take.rate, take.source.unit) == (50, 0.001)
        np.testing.assert_allclose(take.positions, PLACES / 1000, atol=0.51e-6)


@pytest.mark.parametrize("label", ["L.Post.Fem.", "foot_", "a b-"])
@pytest.mark.parametrize("separator", [".", " ", "_", ": ", " - "])
def test_labels_may_end_like_a_separator(tmp_path: Path, label: str, separator: str) -> None:
    names = [f"{one}{separator}{axis}" for one in (label, *LABELS[1:]) for axis in AXES]
    path = tmp_path / "take.csv"
    path.write_text(table(names, ","))
    [take], _ = formats.read_any(path)
    assert take.labels == (label, *LABELS[1:])


def test_other_quantities_are_left_alone(tmp_path: Path) -> None:
    names = [f"{label}.{kind}{axis}" for label in LABELS for kind in "DRa" for axis in "xyz"]
    rows = np.random.default_rng(0).normal(size=(10, 3, 9))
    rows[:, :, :3] = PLACES
    lines = [",".join(f"{v:.3f}" for v in row.ravel()) for row in rows]
    take, problems = read(
        tmp_path / "a.csv", "\n".join([",".join(names), *lines]), fps=Fraction(100)
    )
    assert take.labels == LABELS
    np.testing.assert_allclose(take.positions, PLACES / 1000, atol=0.51e-6)
    assert problems[0] == "1: columns of accelerations and rotations; not read, kept in the file"


def numbers(delimiter: str, *, start: int = 1, rate: float | None = 100.0) -> list[str]:
    return [
        delimiter.join(
            [
                str(i),
                *([] if rate is None else [f"{(i - start) / rate:.5f}"]),
                *(f"{v:.3f}" for v in row.ravel()),
            ]
        )
        for i, row in enumerate(PLACES, start)
    ]


QUALISYS = [
    "NO_OF_FRAMES\t10",
    "NO_OF_MARKERS\t3",
    "FREQUENCY\t100",
    "DATA_INCLUDED\t3D",
    "MARKER_NAMES\t" + "\t".join(LABELS),
]
XYZ = ",".join("X,Y,Z" for _ in LABELS)
LAYOUTS = {
    "Qualisys with names": [
        *QUALISYS,
        "Frame\tTime\t" + "\t".join(f"{label} {axis}" for label in LABELS for axis in AXES),
        *numbers("\t"),
    ],
    "Qualisys without names": [*QUALISYS, *numbers("\t", rate=None)],
    "Qualisys with types": [
        *QUALISYS,
        "Frame\tTime\t" + "\t".join(f"{b} X\t{b} Y\t{b} Z\t{b} Type" for b in LABELS),
        *(
            "\t".join([str(i), f"{i / 100:.5f}"]
                      + [w for p in row for w in (*(f"{v:.3f}" for v in p), "Measured")])
            for i, row in enumerate(PLACES, 1)
        ),
    ],
    "Nexus": [
        "Trajectories",
        "100",
        ",," + ",".join(f"Ann:{label},," for label in LABELS),
        f"Frame,Sub Frame,{XYZ}",
        ",," + ",".join(["mm"] * 9),
        *(line.replace(",", ",0,", 1) for line in numbers(",", rate=None)),
    ],
    "Motive": [
        "Format Version,1.23,Take Name,walk,Export Frame Rate,100.000000,Length Units,Millimeters",
        "",
        ",Type," + ",".join(["Marker"] * 9),
        ",Name," + ",".join(label for label in LABELS for _ in AXES),
        ",ID," + ",".join(f"A{i}" for i in range(3) for _ in AXES),
        ",," + ",".join(["Position"] * 9),
        f"Frame,Time (Seconds),{XYZ}",
        *numbers(","),
    ],
    "Nexus without units": [
        "Model Outputs",
        "100",
        ",," + ",".join(f"{label},," for label in LABELS),
        f"Frame,Sub Frame,{XYZ}",
        *(line.replace(",", ",0,", 1) for line in numbers(",", rate=None)),
        *("", "Devices", "1000", "Frame,Sub Frame,Fx,Fy,Fz", "1,0,3,4,5"),
    ],
    "Qualisys with timecode": [
        *QUALISYS,
        "Frame\tTime\tSMPTE\t" + "\t".join(f"{label} {axis}" for label in LABELS for axis in AXES),
        *(re.sub(r"^(\d+\t\S+)", rf"\1\t10:44:47:{i:02d}", line)
          for i, line in enumerate(numbers("\t"))),
    ],
    "rows of names": [
        "scorer" + ",net" * 9,
        "bodyparts,time," + ",".join(label for label in LABELS for _ in AXES),
        "frame,time," + ",".join(["x,y,z"] * 3),
        *numbers(","),
    ],
    "milliseconds that nobody names": [
        "frame,time," + ",".join(f"{label}_{axis}" for label in LABELS for axis in "xyz"),
        *(f"{i},{170000 + i * 10}," + ",".join(f"{v:.3f}" for v in row.ravel())
          for i, row in enumerate(PLACES, 1)),
    ],
    "comments above": [
        "# fps: 100",
        "# unit = mm",
        "frame,time_ms," + ",".join(f"{label}_{axis}" for label in LABELS for axis in "xyz"),
        *(f"{i},{(i - 1) * 10}," + ",".join(f"{v:.3f}" for v in row.ravel())
          for i, row in enumerate(PLACES, 1)),
    ],
    "semicolons and decimal commas": [
        line.replace(",", ";").replace(".", ",")
        for line in [
            "Frame,Time [s]," + ",".join(f"{b} {axis} [mm]" for b in LABELS for axis in AXES),
            *numbers(","),
        ]
    ],
}  # fmt: skip


@pytest.mark.parametrize("name", LAYOUTS)
def test_layouts(tmp_path: Path, name: str) -> None:
    suffix = ".tsv" if name.startswith("Qualisys") else ".csv"
    take, problems = read(tmp_path / f"take{suffix}", "\n".join(LAYOUTS[name]) + "\n")
    labels = tuple(f"Ann:{label}" for label in LABELS) if name == "Nexus" else LABELS
    assert take.labels == labels
    assert (take.rate, take.first_frame) == (100, 1)
    np.testing.assert_allclose(take.positions, PLACES / 1000, atol=0.51e-6)
    unit_stated = name in ("Nexus", "Motive", "comments above", "semicolons and decimal commas")
    assert (take.timecode == "10:44:47:00") == (name == "Qualisys with timecode")
    assert any("guessed milliseconds" in p for p in problems) == name.startswith("milliseconds")
    assert any("guessed 1 unit = 0.001 m" in problem for problem in problems) != unit_stated


def test_motive_s_bones_are_told_from_their_rotations(tmp_path: Path) -> None:
    rows = np.random.default_rng(0).normal(size=(10, 3, 7))
    rows[:, :, 4:] = PLACES
    lines = [
        "Capture Frame Rate,100,Length Units,Millimeters",
        ",," + ",".join(label for label in LABELS for _ in range(7)),
        ",," + ",".join((["Rotation"] * 4 + ["Position"] * 3) * 3),
        "Frame,Time," + ",".join(["X", "Y", "Z", "W", "X", "Y", "Z"] * 3),
        *(f"{i},{i / 100}," + ",".join(f"{v:.3f}" for v in row.ravel())
          for i, row in enumerate(rows)),
    ]  # fmt: skip
    take, _ = read(tmp_path / "a.csv", "\n".join(lines))
    assert take.labels == LABELS
    np.testing.assert_allclose(take.positions, PLACES / 1000, atol=0.51e-6)


NAMES = [f"{label} {axis}" for label in LABELS for axis in AXES]


def with_times(times: list[float]) -> str:
    rows = [line.split(",", 1)[1] for line in table(NAMES).splitlines()[1:]]
    lines = [f"{t:.6f},{row}" for t, row in zip(times, rows, strict=True)]
    return "\n".join(["Time," + ",".join(NAMES), *lines]) + "\n"


@pytest.mark.parametrize("rate", ["30", "59.94", "120", "119.88", "23.976", "250", "48", "37"])
def test_times_tell_the_rate(tmp_path: Path, rate: str) -> None:
    exact = formats.options.parse_rate(rate)
    for decimals in (4, 9):
        text = with_times([round(i / float(exact), decimals) for i in range(10)])
        assert read(tmp_path / "a.csv", text)[0].rate == exact, decimals


def test_rows_are_put_where_uneven_times_say(tmp_path: Path) -> None:
    times = [0, 0.01, 0.02, 0.03, 0.04, 0.05, 0.0575, 0.07, 0.08, 0.15]
    take, problems = read(tmp_path / "a.csv", with_times(times))
    assert take.rate == 100
    assert take.frames == 16
    expected = np.array(
        [np.interp(np.arange(9) / 100, times, column) for column in PLACES.reshape(10, -1).T]
    )
    np.testing.assert_allclose(take.positions[:9].reshape(9, -1).T, expected / 1000, atol=1e-6)
    assert take.missing[9:15].all()
    assert not take.missing[15].any()
    assert any("times are not even" in p and "rows put where" in p for p in problems)
    take, problems = read(tmp_path / "a.csv", with_times(times), fps=Fraction(100))
    assert take.frames == 10
    assert not any("times" in problem for problem in problems)


def test_the_head_counts_where_times_disagree(tmp_path: Path) -> None:
    text = "\n".join(LAYOUTS["Qualisys with names"]).replace("FREQUENCY\t100", "FREQUENCY\t200")
    take, problems = read(tmp_path / "a.tsv", text)
    assert take.rate == 200
    assert any("times tell 100 frames a second, the head 200" in p for p in problems)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("a,b,c\n", "no rows of numbers"),
        ("", "no rows of numbers"),
        ("1,2,3\n4,5,6\n", "no columns of X, Y and Z"),
        ("name,age,size\nx,3,4\ny,5,6\n1,2,3\n4,5,6\n", "no columns of X, Y and Z"),
        (
            "DATA_INCLUDED,3D_ACCELERATION\nA X,A Y,A Z\n1,2,3\n4,5,6\n",
            "1: no positions: it holds 3D_ACCELERATION",
        ),
        ("Hip.Rx,Hip.Ry,Hip.Rz\n1,2,3\n4,5,6\n", "1: no positions: it holds rotations"),
        ("Hip_x,Hip_y,Hip_z,Hip_w\n1,0,0,0\n0,1,0,0\n", "1: no positions: it holds rotations"),
        ("Hip_accX,Hip_accY,Hip_accZ\n1,2,3\n4,5,6\n", "1: no positions: it holds accelerations"),
        ("t,A X,A Y,A Z\n0,1,2,3\n1,1,oops,3\n2,1,2,3\n", "3: 'oops' is not a number, in column 3"),
        (
            "frame,joint,x,y,z\n0,hip,1,2,3\n0,toe,1,0,3\n1,hip,1,2,3\n1,toe,1,0,3\n",
            "2: frame numbers repeat",
        ),
        ("t,A X,A Y,A Z\n0,1,2,3\n1,1,2,3\n2,1", "4: cut off: the last row has 2 of 4"),
    ],
)
def test_what_is_no_table_of_positions_is_refused(tmp_path: Path, text: str, says: str) -> None:
    with pytest.raises(FileError, match=says):
        read(tmp_path / "a.csv", text, fps=Fraction(10))


@pytest.mark.parametrize("times", [[0.0] * 10, [0, 1, 2, 1, 4, 5, 6, 7, 8, 9]])
def test_without_a_rate_it_is_asked_for(tmp_path: Path, times: list[float]) -> None:
    path = tmp_path / "a.csv"
    with pytest.raises(NoRateError, match=r"no frame rate.*--fps tells it"):
        read(path, with_times(times))
    assert read(path, with_times(times), fps=Fraction(25))[0].rate == 25


def test_in_a_folder_only_tables_of_motion_are_takes(tmp_path: Path) -> None:
    (tmp_path / "notes.csv").write_text("subject,age,height\nA,31,1.8\nB,28,1.7\n")
    (tmp_path / "take.csv").write_text(table(NAMES))
    (tmp_path / "wide.tsv").write_text(
        "\n".join(["\t".join(f"{'long name ' * 9}{i} {a}" for i in range(60) for a in AXES)]
                  + ["\t".join(map(str, range(180)))] * 3)
    )  # fmt: skip
    assert [path.name for path in formats.find_takes([tmp_path])] == ["take.csv", "wide.tsv"]


FOLDER = "sync_optical_kinect_imu_MIT"


@pytest.mark.parametrize(
    ("name", "frames", "first", "markers", "missing"),
    [("qualisys", 3583, 1, 41, 0.015), ("kinect", 3569, -180, 25, 0.095)],
)
def test_synchronous_takes(
    data: Path, tmp_path: Path, name: str, frames: int, first: int, markers: int, missing: float
) -> None:
    path = data / FOLDER / name / "trial17.tsv"
    take, problems = read(tmp_path / "a.tsv", path.read_bytes())
    assert (take.frames, take.rate, take.first_frame) == (frames, 100, first)
    assert len(take.labels) == markers
    assert take.missing.mean() == pytest.approx(missing, abs=5e-4)
    assert any("guessed Y up (the head" in problem for problem in problems)
    assert any("guessed 1 unit = 0.001 m" in problem for problem in problems)
    assert any("NO_OF_FRAMES 3389, but 3569 rows" in p for p in problems) == (name == "kinect")
    assert any("rows repeat" in problem for problem in problems) == (name == "kinect")


def test_accelerations_are_no_positions(data: Path) -> None:
    with pytest.raises(FileError, match=r"trial17.tsv: 8: no positions: it holds 3D_ACCEL"):
        formats.read_any(data / FOLDER / "imu" / "trial17.tsv")


@pytest.mark.parametrize(("number", "frames"), [(1, 205), (2, 156)])
def test_kicks_that_state_no_rate(data: Path, tmp_path: Path, number: int, frames: int) -> None:
    path = data / "karate_rmocap_GPL3" / f"mawashi.geri.left.{number}.csv"
    with pytest.raises(NoRateError, match="all times are alike"):
        formats.read_any(path)
    take, problems = read(tmp_path / "a.csv", path.read_bytes(), fps=Fraction(100))
    assert (take.frames, take.rate, len(take.labels)) == (frames, 100, 21)
    assert take.source is not None
    assert take.source.unit == 0.01
    assert any("columns of accelerations and rotations" in problem for problem in problems)
    with path.open() as file:
        rows = list(csv.DictReader(file))
    expected = [[float(row[f"LeftFoot.D{axis}"]) / 100 for axis in "xyz"] for row in rows]
    np.testing.assert_allclose(take.positions[:, take.index["LeftFoot"]], expected, atol=1e-12)
