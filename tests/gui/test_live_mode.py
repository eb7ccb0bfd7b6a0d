"""Live mode in a real window: a take played as if it arrived now, a pipe, joint weights."""

from __future__ import annotations

import json
import os
import threading
from dataclasses import replace

import numpy as np
import pytest
from hands import CTRL, SHIFT
from made_takes import reaching
from mouse import click
from PySide6.QtCore import QPointF, Qt
from PySide6.QtWidgets import QApplication, QLabel
from test_desk_layout import cut_texts

from mocapstudio import formats
from mocapstudio.comparison.model import Segment
from mocapstudio.comparison.weights import JointWeights, write_weights
from mocapstudio.gui.compare.live_bridge import Phase
from mocapstudio.gui.compare.live_intake import PATH_FRAMES
from mocapstudio.gui.compare.live_opening import LiveRequest, open_live
from mocapstudio.gui.dialogs.trouble import TroubleDialog
from mocapstudio.gui.jobs import Lines
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.review.matrix_model import Picture

RATE = 30
STILL = 20
# The pupil stands still, reaches more slowly than the teacher, and stands again.
TEACHER = replace(reaching(6, 60, 10), name="teacher")
PUPIL = replace(reaching(STILL, 72, 24), name="pupil")
PARTS = (Segment("up", 6, 36), Segment("down", 36, 66))


@pytest.fixture
def hands(compare_hands):
    return compare_hands


@pytest.fixture
def workspace(hands):
    """The workspace with teacher and pupil, and the teacher's segments."""
    found = hands.window.switching.front
    found.working.take_in([TEACHER, PUPIL])
    found.bridge.sitting.set_segments(PARTS, "Parts")
    hands.see(lambda: found.bridge.state.linked is not None, 60)
    return found


def watched(workspace) -> list:
    """Every state that live mode shows from now on."""
    seen: list = []
    workspace.live.changed.connect(lambda _old, new: seen.append(new))
    return seen


def pixels(widget) -> set[int]:
    picture = widget.grab().toImage()
    return {
        picture.pixel(x, y)
        for x in range(0, picture.width(), 3)
        for y in range(0, picture.height(), 3)
    }


def test_a_pupil_is_followed_as_if_she_performed_now(hands, workspace):
    live, bridge = workspace.live, workspace.bridge
    seen = watched(workspace)
    hands.click("button-compare-live")
    hands.see(lambda: hands.shows("live-view"))
    assert not hands.shows("compare-pictures")
    hands.see(lambda: live.shown.phase is Phase.ENDED, 60)
    # She is waited for while she stands, and found to begin where she does.
    waiting = [one for one in seen if one.now is not None and one.step is None]
    assert waiting
    began = next(one.now.began for one in seen if one.now and one.now.began is not None)
    assert abs(began - (STILL - 6)) <= 6
    # The slower she is, the later she gets; the label of the teacher comes for free.
    top = next(one for one in seen if one.seconds and one.seconds >= (STILL + 36) / RATE)
    assert abs(top.step.reference_frame - 36) <= 4
    assert top.step.misalignment < -0.1
    assert live.shown.frames == PUPIL.frames
    told = workspace.desk.live.readout.told
    assert told[0] == "At the end"
    assert told[1].startswith("−")
    assert told[2] == "late"
    # Both play heads stand where the last frame put them.
    assert bridge.state.source_frame == PUPIL.frames - 1
    assert bridge.state.frame == live.shown.step.reference_frame
    assert workspace.desk.live.timeline.heads[0] < workspace.desk.live.timeline.heads[1]


def test_it_is_paused_restarted_and_left_by_keys(hands, workspace):
    live = workspace.live
    hands.press("B")
    assert not live.shown.wait
    hands.press("L", SHIFT)
    hands.see(lambda: live.shown.frames > 20, 60)
    hands.key(Qt.Key.Key_Space)
    assert live.shown.phase is Phase.PAUSED
    frames = live.shown.frames
    hands.qtbot.wait(200)
    assert live.shown.frames == frames
    hands.key(Qt.Key.Key_Space)
    hands.see(lambda: live.shown.frames > frames + 3)
    hands.press("[")
    assert workspace.bridge.ui.speed == 0.5
    hands.key(Qt.Key.Key_Backspace)
    hands.see(lambda: live.shown.now is not None and live.shown.frames < 20)
    assert live.shown.phase is Phase.RUNNING
    assert live.shown.history.frames == live.shown.frames
    # Without waiting her first frame is the action's first.
    assert live.shown.now.began == live.shown.now.frame - live.shown.frames + 1
    hands.press("L", SHIFT)
    assert live.shown.phase is Phase.OFF
    hands.see(lambda: hands.shows("compare-pictures"))


def test_curves_and_path_grow_with_the_frames(hands, workspace):
    live, view = workspace.live, workspace.desk.live
    hands.press("L", SHIFT)
    hands.see(lambda: live.shown.history is not None and live.shown.history.frames > 15, 60)
    hands.key(Qt.Key.Key_Space)
    before = view.matrix.path()
    hands.see(lambda: len(pixels(view.matrix)) > 20)
    hands.key(Qt.Key.Key_Space)
    hands.see(lambda: live.shown.phase is Phase.ENDED, 30)
    path = view.matrix.path()
    assert len(path) > len(before)
    assert path[-1].x() > before[-1].x()
    steps = np.diff([(one.x(), -one.y()) for one in path], axis=0)
    assert (steps >= -1e-6).all()
    assert live.shown.alignment.aligner.path()[0].tolist() == [0, 0]
    assert live.shown.history.frames < PATH_FRAMES
    for plot in (view.timing, view.cost, view.timeline, view.readout):
        assert len(pixels(plot)) > 4


def test_a_click_looks_back_while_nothing_runs(hands, workspace):
    live, bridge, timing = workspace.live, workspace.bridge, workspace.desk.live.timing
    hands.press("B")
    hands.press("L", SHIFT)
    hands.see(lambda: live.shown.phase is Phase.ENDED, 60)
    # The pupil is at the top half way through her reach, the teacher half way through his.
    top = STILL + 36
    click(timing, QPointF(timing.x_of(top / RATE), timing.area.center().y()))
    assert bridge.state.source_frame == top
    assert abs(bridge.state.frame - 36) <= 4
    assert live.shown.looked == pytest.approx(top / RATE)
    hands.key(Qt.Key.Key_Space)
    hands.see(lambda: live.shown.phase is Phase.RUNNING and live.shown.looked is None)


def test_it_follows_another_source_and_ends_with_the_last(hands, workspace):
    live = workspace.live
    workspace.bridge.sitting.add_sources([replace(TEACHER, name="other")])
    hands.press("L", SHIFT)
    hands.see(lambda: live.shown.frames > 3, 60)
    workspace.bridge.sitting.choose("other")
    hands.see(lambda: live.shown.name == "other" and live.shown.frames > 3, 60)
    assert live.shown.phase in (Phase.RUNNING, Phase.ENDED)
    workspace.bridge.sitting.remove("other")
    workspace.bridge.sitting.remove("pupil")
    hands.see(lambda: live.shown.phase is Phase.OFF)
    hands.see(lambda: hands.shows("compare-empty"))


def test_a_take_that_cannot_be_compared_is_told(hands, workspace):
    markers = MarkerTake("markers", ("a", "b"), np.zeros((9, 2, 3)), TEACHER.rate)
    workspace.bridge.sitting.add_sources([markers])
    workspace.bridge.sitting.choose("markers")
    hands.press("L", SHIFT)
    hands.see(lambda: isinstance(QApplication.activeModalWidget(), TroubleDialog), 60)
    QApplication.activeModalWidget().close()
    hands.come_back()
    assert workspace.live.shown.phase is Phase.OFF


# -- standard input


def line(frame: int, time: float) -> bytes:
    names = PUPIL.skeleton.names
    content = {
        "time": time,
        "joints": dict(zip(names, PUPIL.rotations[frame].tolist(), strict=True)),
        "root": PUPIL.translations[frame, 0].tolist(),
    }
    return json.dumps(content).encode() + b"\n"


class Pipe:
    """A pipe with a sender at its other end, who is told line by line what to send."""

    def __init__(self) -> None:
        self.out, self._into = os.pipe()
        self._open = True

    def send(self, *lines: bytes) -> None:
        os.write(self._into, b"".join(lines))

    def close(self) -> None:
        if self._open:
            self._open = False
            os.close(self._into)


@pytest.fixture
def pipe():
    made = Pipe()
    yield made
    made.close()
    os.close(made.out)


@pytest.fixture
def listening(hands, pipe, tmp_path):
    """The workspace with the teacher as reference, and nobody but the pipe to perform."""
    path = tmp_path / "teacher.bvh"
    formats.write(TEACHER, path)
    open_live(hands.window, LiveRequest(path, wait=False, descriptor=pipe.out))
    workspace = hands.window.switching.front
    hands.see(lambda: workspace.live.shown.streams, 60)
    return workspace


def test_frames_come_by_a_pipe(hands, listening, pipe):
    live, stage = listening.live, listening.desk.stage
    hands.see(lambda: hands.shows("live-view"))
    assert live.shown.phase is Phase.PREPARING
    assert listening.desk.live.readout.told[0] == "Waiting for frames"
    course = range(STILL - 6, PUPIL.frames)
    lines = [line(frame, 3.0 + i / RATE) for i, frame in enumerate(course)]
    # One frame twice, one late, three missing, and two lines that are no frames.
    pipe.send(*lines[:20], lines[19], lines[18], b'{"time": 1,\n', b"\n", b"[]\n")
    hands.see(lambda: live.shown.frames == 22, 60)
    assert live.shown.faults == 2
    assert live.shown.fault.startswith("line 25: ")
    assert "line 25" in listening.desk.live.readout.told[-1]
    notes = {note.value: count for note, count in live.shown.notes}
    assert notes == {"repeated": 1, "late": 1}
    pipe.send(*lines[23:40])
    hands.see(lambda: live.shown.frames == 39)
    assert dict(live.shown.notes)["bridged"] == 1
    # She is drawn as she came, on the skeleton of the reference.
    member = stage._members[stage.right][0]
    wanted = PUPIL.rotations[course[39], PUPIL.skeleton.index["LeftArm"]]
    guest = member.actor
    np.testing.assert_allclose(
        guest._rotations[0, TEACHER.skeleton.index["LeftArm"]], wanted, atol=1e-9
    )
    hands.see(lambda: len(pixels(stage.right)) > 100)
    # The top of the reach is frame 36 of the teacher's.
    assert abs(live.shown.step.reference_frame - 36) <= 5
    pipe.send(*lines[40:])
    pipe.close()
    hands.see(lambda: live.shown.phase is Phase.ENDED, 30)
    assert live.shown.step.reference_frame >= 60
    assert live.shown.step.misalignment < -0.1


def test_nothing_listens_after_it_has_hung_up(hands, listening, pipe):
    pipe.send(line(0, 0.0))
    hands.see(lambda: "lines" in {one.name for one in threading.enumerate()})
    listening.live_mode.hang_up()
    assert not listening.live.shown.on
    hands.see(lambda: "lines" not in {one.name for one in threading.enumerate()})


def test_another_skeleton_by_the_pipe_is_refused(hands, listening, pipe):
    strange = json.dumps({"time": 0.0, "joints": {"tail": [0, 0, 0, 1]}}).encode() + b"\n"
    pipe.send(*[strange] * 9)
    hands.see(lambda: isinstance(QApplication.activeModalWidget(), TroubleDialog), 60)
    QApplication.activeModalWidget().close()
    hands.come_back()
    assert listening.live.shown.phase is Phase.OFF


def test_lines_wait_in_bounds_and_nothing_blocks_on_closing(pipe):
    lines = Lines(pipe.out, most=4)
    sender = threading.Thread(target=pipe.send, args=(b"x" * 99 + b"\n",) * 30)
    sender.start()
    sender.join(10)
    while lines._waiting.qsize() < 4:
        pass
    assert [lines.take()[1] for _ in range(4)] == [b"x" * 99] * 4
    lines.close()
    lines._thread.join(5)
    assert not lines.running


def test_what_has_no_end_is_no_line(pipe):
    lines = Lines(pipe.out)
    pipe.send(b"one\ntwo")
    pipe.close()
    lines._thread.join(5)
    assert [lines.take()[1], lines.take()[1], lines.take()] == [b"one", b"two", None]
    assert lines.ended


# -- weights


@pytest.fixture
def weights_file(tmp_path):
    path = tmp_path / "arms.json"
    named = dict.fromkeys(TEACHER.skeleton.names, 0.1)
    named |= {"LeftArm": 3.0, "RightArm": 2.0, "LeftArm motion": 1.0}
    write_weights(JointWeights(named, reference="teacher"), path)
    return path


def test_weights_are_opened_shown_and_used(hands, workspace, weights_file):
    live, stage = workspace.live, workspace.desk.stage
    plain = pixels(stage.left)
    hands.press("W", CTRL | SHIFT)
    hands.answer_file_dialog(weights_file)
    hands.see(lambda: hands.shows("weight-bars"))
    bars = hands.find("weight-bars")
    assert [row.name for row in bars.rows[:2]] == ["LeftArm", "RightArm"]
    assert (bars.rows[0].pose, bars.rows[0].motion) == (3.0, 1.0)
    assert hands.text("weights-file") == "arms.json"
    hands.see(lambda: pixels(stage.left) != plain)
    click(bars, QPointF(30, 12))
    assert workspace.bridge.state.row == "LeftArm"
    hands.press("L", SHIFT)
    hands.see(lambda: live.shown.alignment is not None, 60)
    aligner = live.shown.alignment.aligner
    used = dict(zip(aligner.reference.names, aligner.weights.tolist(), strict=True))
    assert used["LeftArm"] == pytest.approx(3.0)
    assert used["RightArm motion"] == 0.0
    hands.menu("Live", "Without Weights")
    hands.see(lambda: live.shown.alignment not in (None, aligner), 60)
    assert live.shown.weights is None
    hands.press("X")
    hands.see(lambda: hands.shows("compare-matrix-view"))
    assert not live.shown.weights_shown


def test_weights_of_another_body_are_refused_when_they_are_opened(hands, workspace, tmp_path):
    other = tmp_path / "horse.json"
    write_weights(JointWeights({"Hoof": 3.0, "Tail": 2.0, "LeftArm": 1.0}), other)
    hands.press("W", CTRL | SHIFT)
    hands.answer_file_dialog(other)
    hands.see(lambda: isinstance(QApplication.activeModalWidget(), TroubleDialog))
    said = " ".join(one.text() for one in QApplication.activeModalWidget().findChildren(QLabel))
    assert "not for teacher" in said
    assert "Hoof, Tail do not" in said
    QApplication.activeModalWidget().close()
    hands.come_back()
    assert workspace.live.shown.weights is None


def test_weights_serve_the_online_matrix(hands, workspace, weights_file):
    matrix, picture = workspace.desk.matrix, Picture.DISTANCES
    hands.press("X")
    workspace.bridge.set_ui(matrix_online=True)
    hands.see(lambda: matrix.shown is not None, 60)
    plain = matrix.shown
    whole = [(-0.5, frames - 0.5) for frames in plain.frames]
    workspace.live_answering.open_weights(weights_file)
    hands.press("X")
    hands.see(lambda: matrix.shown not in (None, plain), 60)
    one, other = (m.pooled(picture, *whole, 200).values for m in (plain, matrix.shown))
    assert one.shape == other.shape
    assert not np.allclose(one / one.max(), other / other.max(), atol=0.02)
    # Without them it is as it was.
    hands.menu("Live", "Without Weights")
    hands.see(lambda: matrix.shown is not None and np.array_equal(
        matrix.shown.pooled(picture, *whole, 200).values, one), 60)  # fmt: skip


def test_a_file_without_weights_is_told(hands, workspace, tmp_path):
    bad = tmp_path / "bad.json"
    bad.write_text('{"weights": {"LeftArm": -1}}')
    hands.press("W", CTRL | SHIFT)
    hands.answer_file_dialog(bad)
    hands.see(lambda: isinstance(QApplication.activeModalWidget(), TroubleDialog))
    QApplication.activeModalWidget().close()
    hands.come_back()
    assert workspace.live.shown.weights is None


@pytest.mark.parametrize("size", [(1280, 720), (1440, 900)])
def test_nothing_of_live_mode_is_cut_off(hands, workspace, weights_file, size):
    hands.window.resize(*size)
    workspace.desk.share_out()
    workspace.live_answering.open_weights(weights_file)
    hands.press("L", SHIFT)
    hands.see(lambda: workspace.live.shown.frames > 20, 60)
    assert (hands.window.width(), hands.window.height()) == size
    hands.see(lambda: cut_texts(hands.window) == [])
    view = workspace.desk.live
    hands.see(lambda: view.geometry() == view.parentWidget().rect())


def test_the_page_of_keys_lists_those_of_this_workspace(hands, workspace):
    hands.key(Qt.Key.Key_F1)
    hands.see(lambda: hands.shows("shortcuts-dialog"))
    dialog = hands.find("shortcuts-dialog")
    said = [one.text() for one in dialog.findChildren(QLabel)]
    assert said[said.index("Live Mode") + 1] == "Shift+L"
    # What is done to flags has no place here.
    assert "Reject Like This" not in said
    assert dialog.height() <= 680
    dialog.close()
    hands.come_back()
