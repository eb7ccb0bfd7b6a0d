"""C3D is read in all its number formats, and what is odd in a file is said."""

from __future__ import annotations

import tracemalloc
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from c3d_bytes import DEC, INTEL, MIPS, Made, vax_float
from hypothesis import given, settings
from hypothesis import strategies as st

from mocapstudio.formats import ImportReport, ReadOptions, read_any
from mocapstudio.formats.c3d_numbers import Numbers
from mocapstudio.formats.c3d_read import read_c3d
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.markers import Event, MarkerTake

Y_UP = {"POINT": {"X_SCREEN": "+X", "Y_SCREEN": "+Y"}}


def millimetres(frames: int = 6, points: int = 3, seed: int = 0) -> np.ndarray:
    """A body's markers, none of them at zero."""
    generator = np.random.default_rng(seed)
    body = generator.uniform(-800, 800, (points, 3))
    return body + generator.normal(scale=20, size=(frames, points, 3)) + (0, 900, 0)


def read(made: Made | bytes, **options: object) -> tuple[list[MarkerTake], ImportReport]:
    data = made.data() if isinstance(made, Made) else made
    return read_c3d(Path("take.c3d"), data, ReadOptions(**options))  # type: ignore[arg-type]


def found(report: ImportReport) -> str:
    return "\n".join(f"{p.what}; {p.done}" for p in report.problems)


@pytest.mark.parametrize("processor", [INTEL, DEC, MIPS])
@pytest.mark.parametrize("scale", [-1.0, 0.1])
@pytest.mark.parametrize("analog", [0, 5])
def test_every_number_format(processor: int, scale: float, analog: int) -> None:
    xyz = millimetres()
    (take,), report = read(Made(xyz, processor=processor, scale=scale, analog=analog, more=Y_UP))
    np.testing.assert_allclose(take.positions, xyz / 1000, atol=6e-5 if scale > 0 else 1e-6)
    assert take.labels == ("M0", "M1", "M2")
    assert take.rate == 100
    assert report.problems == ()


@settings(max_examples=60)
@given(st.floats(-(2.0**100), 2.0**100, width=32).filter(lambda v: v == 0 or abs(v) > 1e-30))
def test_vax_floats_there_and_back(value: float) -> None:
    numbers = Numbers(DEC)
    assert float(numbers.floats(vax_float(value))[0]) == value
    assert numbers.floats_bytes(np.array([value], dtype=np.float32)) == vax_float(value)


def test_missing_samples_of_every_kind_are_named() -> None:
    xyz = millimetres(frames=9)
    fourth = np.zeros(xyz.shape[:2])
    fourth[1, 0] = -1
    xyz[2, 1] = np.nan
    xyz[3, 1, 2] = np.inf
    xyz[4:6, 2] = 0
    (take,), report = read(Made(xyz, fourth, more=Y_UP))
    expected = np.zeros((9, 3), dtype=bool)
    expected[[1, 2, 3, 4, 5], [0, 1, 1, 2, 2]] = True
    np.testing.assert_array_equal(take.missing, expected)
    assert "1 samples of 1 markers marked as invalid; taken as missing" in found(report)
    assert "2 samples of 1 markers whose coordinates are no numbers" in found(report)
    assert "2 samples of 1 markers at exactly (0, 0, 0)" in found(report)


def test_integers_may_be_missing_too() -> None:
    xyz = millimetres()
    fourth = np.zeros(xyz.shape[:2])
    fourth[2, 1] = -1
    (take,), _ = read(Made(xyz, fourth, scale=0.1, more=Y_UP))
    assert np.argwhere(take.missing).tolist() == [[2, 1]]


def test_samples_no_camera_saw_count_as_filled() -> None:
    xyz = millimetres()
    fourth = np.full(xyz.shape[:2], 3 << 8 | 5)
    fourth[4, 2] = 0
    (take,), _ = read(Made(xyz, fourth, more=Y_UP))
    assert take.filled is not None
    assert np.argwhere(take.filled).tolist() == [[4, 2]]
    assert read(Made(xyz, more=Y_UP))[0][0].filled is None


def test_more_than_255_labels() -> None:
    labels = [f"marker{i}" for i in range(600)]
    (take,), report = read(Made(millimetres(2, 600), labels=labels, more=Y_UP))
    assert take.labels == tuple(labels)
    assert report.problems == ()


def test_fewer_labels_than_points() -> None:
    (take,), report = read(Made(millimetres(points=4), labels=["A", "B"], more=Y_UP))
    assert take.labels == ("A", "B", "point 3", "point 4")
    assert "2 labels for 4 points; the others named by number" in found(report)


def test_more_labels_than_points() -> None:
    (take,), report = read(Made(millimetres(points=2), labels=["A", "B", "C"], more=Y_UP))
    assert take.labels == ("A", "B")
    assert "3 labels for 2 points; the last labels ignored" in found(report)


def test_labels_that_repeat_are_numbered() -> None:
    labels = ["A", "A#2", "A", "A"]
    (take,), report = read(Made(millimetres(points=4), labels=labels, more=Y_UP))
    assert take.labels == ("A", "A#2", "A#3", "A#4")
    assert "labels repeat: A" in found(report)


def test_labels_keep_their_letters() -> None:
    (take,), _ = read(Made(millimetres(points=2), labels=["Knöchel", "踵"], more=Y_UP))
    assert take.labels == ("Knöchel", "踵")


def test_outputs_of_a_model_are_told_from_markers() -> None:
    labels = ["LHEE", "LHipAngles", "Strange", "LKneeMoment", "S:RAnklePower", "NormalisedGRF"]
    labels += ["PELO", "PELA", "PELL", "PELP", "*17", "CentreOfMass", "Odd", "Knee", "HEEL"]
    more = {
        "POINT": Y_UP["POINT"]
        | {
            "ANGLES": ["Strange", "Nobody"],
            "THINGS": ["Odd"],
            "TYPE_GROUPS": [["ANGLES", "ANGLE"], ["THINGS", "THING"]],
        }
    }
    (take,), report = read(Made(millimetres(points=len(labels)), labels=labels, more=more))
    assert take.labels == ("LHEE", "Knee", "HEEL")
    said = found(report)
    for named in (
        "2 angles: LHipAngles, Strange;",
        "1 moment: LKneeMoment;",
        "1 power: S:RAnklePower;",
        "1 force: NormalisedGRF;",
        "4 points of a segment: PELO, PELA, PELL, PELP;",
        "1 unlabelled point: *17;",
        "1 modelled marker: CentreOfMass;",
        "1 thing: Odd;",
    ):
        assert named in said
    assert said.count("left out of the markers, kept in the file") == 8


def test_a_list_of_markers_leaves_them_markers() -> None:
    groups = {"ALLMARKERS": ["A", "B"], "TYPE_GROUPS": [["ALLMARKERS", "MARKER"]]}
    made = Made(millimetres(), labels=["A", "B", "C"], more={"POINT": Y_UP["POINT"] | groups})
    (take,), report = read(made)
    assert (take.labels, report.problems) == (("A", "B", "C"), ())


def test_points_that_no_camera_saw_are_guessed_to_be_computed() -> None:
    xyz = millimetres(points=12)
    fourth = np.full(xyz.shape[:2], 1 << 8 | 5)
    fourth[:, 9:] = 0
    (take,), report = read(Made(xyz, fourth, more=Y_UP))
    assert len(take.labels) == 9
    (problem,) = report.problems
    assert problem.guess
    assert problem.what == "3 points that no camera saw: M9, M10, M11"
    # Where nothing was seen by any camera, nothing can be told.
    assert len(read(Made(xyz, more=Y_UP))[0][0].labels) == 12


def test_unlabelled_points_are_read_where_there_is_nothing_else() -> None:
    (take,), report = read(Made(millimetres(points=2), labels=["*0", "*1"], more=Y_UP))
    assert take.labels == ("*0", "*1")
    assert "no point has a label" in found(report)


def test_nothing_but_outputs_of_a_model() -> None:
    with pytest.raises(FileError, match="none of its 1 points is a marker"):
        read(Made(millimetres(points=1), labels=["LHipAngles"]))


@pytest.mark.parametrize(
    ("unit", "metres"), [("mm", 0.001), ("cm", 0.01), ("m", 1.0), ("M", 1.0), ("in", 0.0254)]
)
def test_stated_units(unit: str, metres: float) -> None:
    xyz = millimetres() * 0.001 / metres
    (take,), report = read(Made(xyz, units=[unit], more=Y_UP))
    np.testing.assert_allclose(take.positions, xyz * metres, rtol=1e-6)
    assert report.problems == ()


@pytest.mark.parametrize("units", [[], ["furlong"], ["mm"]])
@pytest.mark.parametrize("metres", [1.0, 0.01])
def test_units_not_stated_or_not_possible_are_guessed(units: list[str], metres: float) -> None:
    xyz = millimetres() * 0.001 / metres
    if units == ["mm"]:
        # A body that would be a millimetre high.
        xyz *= metres
        metres = 1.0
    (take,), report = read(Made(xyz, units=units, more=Y_UP))
    np.testing.assert_allclose(take.positions, xyz * metres, rtol=1e-6)
    (problem,) = report.problems
    assert (problem.guess, problem.override) == (True, "unit")


def test_the_user_decides_the_unit() -> None:
    xyz = millimetres()
    (take,), report = read(Made(xyz, more=Y_UP), unit=0.5)
    np.testing.assert_allclose(take.positions, xyz * 0.5, rtol=1e-6)
    assert report.problems == ()


def test_units_mixed_within_a_file() -> None:
    xyz = millimetres(points=4)
    mixed = xyz.copy()
    mixed[:, 2] /= 1000
    (stated,), told = read(Made(mixed, units=["mm", "mm", "m", "mm"], more=Y_UP))
    (guessed,), guess = read(Made(mixed, more=Y_UP))
    for take in (stated, guessed):
        np.testing.assert_allclose(take.positions, xyz / 1000, rtol=1e-5)
    assert "units are mixed: m, mm; each point read in its own" in found(told)
    assert not told.problems[0].guess
    assert "1 markers are about a thousand times smaller" in found(guess)
    assert guess.problems[0].guess


@pytest.mark.parametrize(
    ("screen", "turned"),
    [
        ("+Y", lambda p: p),
        ("+Z", lambda p: p[..., [0, 2, 1]] * (1, 1, -1)),
        ("Z", lambda p: p[..., [0, 2, 1]] * (1, 1, -1)),
        ("-Z", lambda p: p[..., [0, 2, 1]] * (1, -1, 1)),
        ("-Y", lambda p: p * (1, -1, -1)),
        ("+X", lambda p: p[..., [1, 0, 2]] * (-1, 1, 1)),
    ],
)
def test_stated_up_axis(screen: str, turned) -> None:
    xyz = millimetres()
    (take,), report = read(Made(xyz, more={"POINT": {"Y_SCREEN": screen}}))
    np.testing.assert_allclose(take.positions, turned(xyz) / 1000, atol=1e-6)
    assert report.problems == ()


def test_up_axis_that_is_not_stated_is_guessed_from_the_body() -> None:
    tall = millimetres(points=8)[..., [0, 2, 1]] * (0.3, 0.3, 1.0)
    (take,), report = read(Made(tall))
    np.testing.assert_allclose(take.positions[..., 1], tall[..., 2] / 1000, atol=1e-6)
    (problem,) = report.problems
    assert (problem.guess, problem.override) == (True, "up")
    (given,), _ = read(Made(tall), up="y")
    np.testing.assert_allclose(given.positions, tall / 1000, atol=1e-6)


def test_no_points_is_an_error() -> None:
    made = Made(np.zeros((5, 0, 3)), labels=["A"], analog=4)
    with pytest.raises(FileError, match=r"byte 2: holds no points"):
        read(made)


def test_events_count_from_the_first_frame() -> None:
    group = {
        "USED": 2,
        "CONTEXTS": ["Right", "Left"],
        "LABELS": ["Foot Strike", "Foot Off"],
        "TIMES": [[1.0, 12.5], [1.0, 12.25]],
    }
    made = Made(millimetres(200), first=7201, more=Y_UP | {"EVENT": group})
    (take,), _ = read(made)
    # Frame 7201 at 100 frames a second is at 72 s.
    assert [event.name for event in take.events] == ["Left Foot Off", "Right Foot Strike"]
    np.testing.assert_allclose([event.time for event in take.events], [0.25, 0.5], atol=1e-5)


def test_events_that_do_not_fit_absolute_times_are_relative() -> None:
    group = {"USED": 1, "LABELS": ["Clap"], "TIMES": [[0.0, 0.5]]}
    (take,), _ = read(Made(millimetres(200), first=7201, more=Y_UP | {"EVENT": group}))
    assert take.events == (Event("Clap", 0.5),)


def test_events_of_the_header() -> None:
    (take,), _ = read(
        Made(millimetres(200), header_events=[("RHS", 0.5), ("LTO", 0.25)], more=Y_UP)
    )
    assert take.events == (Event("LTO", 0.25), Event("RHS", 0.5))


def test_another_rate_keeps_events_at_their_frames() -> None:
    made = Made(millimetres(200), header_events=[("RHS", 0.5)], more=Y_UP)
    (take,), _ = read(made, fps=Fraction(50))
    assert take.rate == 50
    assert take.events == (Event("RHS", 1.0),)


@pytest.mark.parametrize("how", ["TRIAL", "LONG_FRAMES", "float FRAMES"])
def test_more_than_65535_frames(how: str) -> None:
    xyz = np.tile(millimetres(10, 1), (7000, 1, 1))
    more: dict[str, dict[str, object]] = {"POINT": dict(Y_UP["POINT"])}
    if how == "TRIAL":
        more["TRIAL"] = {
            "ACTUAL_START_FIELD": [1, 0],
            "ACTUAL_END_FIELD": [70000 & 0xFFFF, 70000 >> 16],
        }
    elif how == "LONG_FRAMES":
        more["POINT"]["LONG_FRAMES"] = 70000.0
    else:
        more["POINT"]["FRAMES"] = 70000.0
    (take,), report = read(Made(xyz, more=more))
    assert take.frames == 70000
    assert report.problems == ()
    np.testing.assert_allclose(take.positions[-10:], xyz[-10:] / 1000, atol=1e-6)


def test_the_first_frame_of_a_late_part() -> None:
    assert read(Made(millimetres(), first=725, more=Y_UP))[0][0].first_frame == 725
    late = {"ACTUAL_START_FIELD": [70000 & 0xFFFF, 1], "ACTUAL_END_FIELD": [70005 & 0xFFFF, 1]}
    assert read(Made(millimetres(), more=Y_UP | {"TRIAL": late}))[0][0].first_frame == 70000


def test_counts_of_frames_that_disagree() -> None:
    (take,), report = read(Made(millimetres(60, 3), last=30, more=Y_UP))
    assert take.frames == 60
    assert "frames are stated differently: the header 30, POINT:FRAMES 60" in found(report)


@pytest.mark.parametrize(
    ("stated", "rate"),
    [(119.88, Fraction(120000, 1001)), (100.0, 100), (59.94006, Fraction(60000, 1001))],
)
def test_rates(stated: float, rate: Fraction) -> None:
    assert read(Made(millimetres(), rate=stated, more=Y_UP))[0][0].rate == rate


@pytest.mark.parametrize("stated", [0.0, -3.0, np.nan, 1e30])
def test_a_rate_that_is_none_is_guessed(stated: float) -> None:
    (take,), report = read(Made(millimetres(), rate=stated, more=Y_UP))
    assert take.rate == 100
    (problem,) = report.problems
    assert (problem.guess, problem.override) == (True, "fps")


def two_people(more: dict[str, dict[str, object]], each: int = 4) -> Made:
    labels = [f"{who}:M{i}" for i in range(each) for who in ("Ann", "Bob")]
    return Made(millimetres(points=2 * each), labels=labels, more=Y_UP | more)


def test_several_subjects_are_a_take_each() -> None:
    more = {"SUBJECTS": {"USED": 2, "USES_PREFIXES": 1, "NAMES": ["Ann", "Bob"]}}
    made = two_people(more)
    takes, report = read(made)
    assert [take.name for take in takes] == ["take Ann", "take Bob"]
    assert [take.source.performer for take in takes if take.source] == [0, 1]
    for number, take in enumerate(takes):
        np.testing.assert_allclose(take.positions, made.xyz[:, number::2] / 1000, atol=1e-6)
    assert "several subjects: Ann, Bob; 2 takes in one space" in found(report)


def test_bodies_by_prefix_alone() -> None:
    assert len(read(two_people({}, each=12))[0]) == 2
    # Four markers each are rigid bodies of one performer.
    takes, report = read(two_people({}))
    assert len(takes) == 1
    assert "labels of several bodies: Ann, Bob" in found(report)


def test_two_bodies_with_the_same_marker_set_are_two_performers() -> None:
    def named(*names: str) -> Made:
        labels = [f"{who}:{name}" for name in names for who in ("Ann", "Bob")]
        return Made(millimetres(points=2 * len(names)), labels=labels, more=Y_UP)

    assert len(read(named("LASI", "RASI", "C7"))[0]) == 2
    assert len(read(named("Marker1", "Marker2", "Marker3"))[0]) == 1


def test_subjects_named_in_the_file_are_told_apart_without_its_saying_how() -> None:
    takes, _ = read(two_people({"SUBJECTS": {"USED": 2, "NAMES": ["Ann", "Bob"]}}))
    assert len(takes) == 2


def test_one_subject_is_one_take_under_the_files_name() -> None:
    (take,), report = read(Made(millimetres(), labels=["A:1", "A:2", "A:3"], more=Y_UP))
    assert (take.name, take.labels) == ("take", ("A:1", "A:2", "A:3"))
    assert report.problems == ()


def test_what_is_cut_off_is_named_by_its_byte() -> None:
    data = Made(millimetres(100), more=Y_UP).data()
    short = data[:-1500]
    with pytest.raises(FileError, match="cut off: 100 frames of 48 bytes stated") as caught:
        read(short)
    assert (caught.value.offset, caught.value.line) == (len(short), None)
    (take,), report = read(short, lenient=True)
    assert 60 < take.frames < 100
    assert "read what is there" in found(report)


@pytest.mark.parametrize("size", [0, 1, 2, 100, 511, 512, 514, 600, 1024])
def test_files_cut_anywhere_are_refused(size: int) -> None:
    with pytest.raises(FileError) as caught:
        read(Made(millimetres(), more=Y_UP).data()[:size])
    assert caught.value.offset is not None


@pytest.mark.parametrize(
    ("at", "value", "byte", "cause"),
    [
        (1, 0x51, 1, "not C3D: its second byte is not 80"),
        (0, 0, 0, "no block of parameters"),
        (0, 200, None, "cut off before the parameters"),
        (512 + 3, 99, 515, "unknown processor type 99"),
        (16, 1, 16, "samples cannot begin at block 1"),
        (16, 250, None, "cut off: samples begin at byte"),
        (515 + 2 + 7, 0xFF, None, "past the end|more than fit|is cut off"),
    ],
)
def test_broken_bytes_are_refused_by_name(
    at: int, value: int, byte: int | None, cause: str
) -> None:
    data = bytearray(Made(millimetres(), more=Y_UP).data())
    data[at] = value
    with pytest.raises(FileError, match=cause) as caught:
        read(bytes(data))
    if byte is not None:
        assert caught.value.offset == byte


def test_c3d_is_told_by_its_content(tmp_path: Path) -> None:
    path = tmp_path / "take.dat"
    path.write_bytes(Made(millimetres(), more=Y_UP).data())
    assert read_any(path)[1].format == "c3d"


@pytest.mark.parametrize("scale", [-1.0, 0.1], ids=["real", "integer"])
def test_memory_stays_within_five_times_the_file(scale: float) -> None:
    xyz = np.random.default_rng(8).uniform(-900, 900, (4000, 20, 3))
    fourth = np.full((4000, 20), 3 << 8 | 4)
    data = Made(xyz, fourth, scale=scale, more=Y_UP).data()
    tracemalloc.start()
    try:
        takes, _ = read_c3d(Path("large.c3d"), data, ReadOptions())
        peak = len(data) + tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    assert peak < 5 * len(data)
    # Whatever was read at a time, each frame stands in its place.
    np.testing.assert_allclose(takes[0].positions, xyz / 1000, atol=1e-4)
