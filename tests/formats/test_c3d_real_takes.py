"""Real C3D files: what their folders' notes say of them, and what ezc3d reads in them."""

from __future__ import annotations

from pathlib import Path

import ezc3d
import numpy as np
import pytest

from mocapstudio.formats import ReadOptions, read_any, write
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.markers import MarkerTake

# File, frames, rate, markers, unit, first frame, share of samples missing in per cent.
TAKES = [
    ("cmu_martial_arts_c3d/135_02.c3d", 5202, 120, 41, 0.001, 1, 0.0),
    ("cmu_same_take_3_formats/02_01.c3d", 343, 120, 41, 0.001, 50, 0.0),
    ("cmu_same_take_3_formats/05_13.c3d", 1095, 120, 41, 0.001, 20, 0.0),
    ("gaps_c3d_btk_BSD/ADemo1_rewrite_c3d_pc_float.c3d", 512, 200, 24, 0.001, 1, 0.7),
    ("gaps_c3d_btk_BSD/PiG_Motion3_FF_N18.c3d", 293, 100, 16, 0.001, 725, 0.0),
    ("gaps_c3d_kineticstoolkit_Apache2/sprintbasket.c3d", 3678, 120, 26, 1.0, 0, 38.8),
    ("gaps_c3d_kineticstoolkit_Apache2/walkingOptiTrack.c3d", 3361, 160, 12, 0.001, 0, 7.4),
    ("gaps_c3d_pycgm_MIT/Movement_trial.c3d", 323, 120, 39, 0.001, 695, 0.0),
]
HEIGHT = 1.7


@pytest.fixture(scope="module", params=TAKES, ids=lambda row: Path(row[0]).stem)
def real(request: pytest.FixtureRequest, data: Path) -> tuple[Path, tuple, MarkerTake]:
    path = data / request.param[0]
    (take,), _ = read_any(path)
    assert isinstance(take, MarkerTake)
    return path, request.param, take


def test_frames_rate_unit_and_markers(real: tuple[Path, tuple, MarkerTake]) -> None:
    _, (_, frames, rate, markers, unit, first, missing), take = real
    assert (take.frames, take.rate, len(take.labels)) == (frames, rate, markers)
    assert take.source is not None
    assert (take.source.unit, take.first_frame) == (unit, first)
    assert 100 * take.missing.mean() == pytest.approx(missing, abs=0.06)


def test_y_is_up(real: tuple[Path, tuple, MarkerTake]) -> None:
    # In each of these recordings whoever moves keeps upright, feet near a level floor.
    _, _, take = real
    seen = take.positions[~take.missing.all(axis=1)]
    extents = np.median(np.nanmax(seen, 1) - np.nanmin(seen, 1), axis=0)
    assert np.argmax(extents) == 1
    assert take.source is not None
    # All files of the folder are Z up.
    np.testing.assert_allclose(
        rot.rotate(take.source.to_inside, np.array([0, 0, 1.0])), [0, 1, 0], atol=1e-12
    )


def test_another_library_reads_the_same_places(real: tuple[Path, tuple, MarkerTake]) -> None:
    path, _, take = real
    assert take.source is not None
    theirs = ezc3d.c3d(str(path))
    point = theirs["parameters"]["POINT"]
    labels = list(point["LABELS"]["value"])
    labels += point["LABELS2"]["value"] if "LABELS2" in point else []
    which = [labels.index(label) for label in take.labels]
    xyz = theirs["data"]["points"][:3, which].transpose(2, 1, 0) * take.source.unit
    places = rot.rotate(take.source.to_inside, xyz)
    np.testing.assert_array_equal(np.isnan(places).any(axis=2), take.missing)
    assert np.nanmax(np.abs(places - take.positions)) < 1e-4 * HEIGHT


def test_unedited_is_written_back_byte_for_byte(
    real: tuple[Path, tuple, MarkerTake], tmp_path: Path
) -> None:
    path, _, take = real
    write(take, tmp_path / "out.c3d")
    assert (tmp_path / "out.c3d").read_bytes() == path.read_bytes()


def test_a_malformed_file_is_refused_and_can_be_insisted_on(data: Path) -> None:
    path = data / "gaps_c3d_btk_BSD" / "mocap36.c3d"
    with pytest.raises(FileError, match="LABELS has no length of its description") as caught:
        read_any(path)
    assert (caught.value.offset, caught.value.line) == (1535, None)
    assert "byte 1535" in str(caught.value)
    (take,), report = read_any(path, ReadOptions(lenient=True))
    assert isinstance(take, MarkerTake)
    assert (len(take.labels), take.frames, take.rate) == (36, 1380, 100)
    assert any("byte 1535" in problem.what for problem in report.problems)


def test_events_of_a_gait_trial(data: Path) -> None:
    (take,), _ = read_any(data / "gaps_c3d_btk_BSD" / "PiG_Motion3_FF_N18.c3d")
    assert isinstance(take, MarkerTake)
    assert len(take.events) == 12
    names = {event.name for event in take.events}
    assert names == {
        f"{side} Foot {what}" for side in ("Left", "Right") for what in ("Strike", "Off")
    }
    # Times that were off by the first frame would find the heel anywhere.
    for event in take.events:
        frame = round(event.time * float(take.rate))
        assert 0 <= frame < take.frames
        if event.name.endswith("Strike"):
            heel = take.positions[:, take.index[f"{event.name[0]}HEE"], 1]
            assert heel[frame] < np.quantile(heel, 0.35)
