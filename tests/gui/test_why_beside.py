"""Under the map: motion texture and the map of another context, at a real desk."""

from __future__ import annotations

import mouse
import numpy as np
import pytest
from made_takes import walking
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor

from mocapstudio.cleaning.detection import detect
from mocapstudio.gui import settings
from mocapstudio.gui.plots.texture_colours import TexturePicture, rgb, turned
from mocapstudio.gui.second_map import OtherContext
from mocapstudio.motion.progress import run
from mocapstudio.motion.recording import without_itself
from mocapstudio.similarity.texture import motion_texture

SHIFT, CONTROL = Qt.KeyboardModifier.ShiftModifier, Qt.KeyboardModifier.ControlModifier


def test_colours_of_turns() -> None:
    """No turn is grey; a turn about one axis moves its own colour only, both ways alike."""
    turns = np.array([[0, 0, 0], [40, 0, 0], [-40, 0, 0], [0, 0, 300]], np.float32)
    grey, plus, minus, far = rgb(turns)
    assert grey.tolist() == [0.5, 0.5, 0.5]
    assert plus[0] - 0.5 == pytest.approx(0.5 - minus[0]) == pytest.approx(0.5 * np.tanh(1.0))
    assert plus[1:].tolist() == [0.5, 0.5]
    assert 0.999 < far[2] <= 1.0


def test_turns_are_from_the_mean_of_each_joint() -> None:
    take = walking(3.0, 30)
    degrees = turned(motion_texture(take, take.skeleton.names))
    assert degrees.shape[1:] == (len(take.skeleton), 3)
    assert np.abs(degrees.mean(axis=0)).max() < 3.0
    assert np.abs(degrees).max() > 10.0


def test_blocks_are_means_and_whole_frames_exact() -> None:
    degrees = np.zeros((5, 1, 3), np.float32)
    degrees[4, 0, 0] = 1000.0
    picture = TexturePicture(degrees, np.zeros(1, np.int64))
    assert [hex(one) for one in picture.blocks(1)[0].tolist()] == ["0xff808080"] * 4 + [
        "0xffff8080"
    ]
    assert [hex(one) for one in picture.blocks(2)[0].tolist()] == ["0xff808080"] * 2 + [
        "0xffff8080"
    ]
    assert hex(picture.blocks(4)[0, 0]) == "0xff808080"


@pytest.fixture
def analysed(desk, hands, generated):
    """A desk with the generated take analysed against its context, learning off."""
    settings.set_flag("learning", False)
    desk.bridge.set_ui(learning=False)
    desk.open([generated.take], [generated.context[0].parent], [])
    bridge = desk.bridge
    hands.see(lambda: bridge.state.analysis is not None and not bridge.ui.analysing, 90)
    hands.see(lambda: len(bridge.state.analysis.context) == 1, 90)
    return desk


def middle(view, row: str, frame: int) -> QPointF:
    top = view.plot.area.top() + view._rows.tops[view._rows.index[row]]
    return QPointF(view.plot.x_of(frame), top + 0.5 * view._rows.row_height)


def test_texture_and_second_map_share_the_axes_of_the_map(analysed, hands) -> None:
    bridge, maps = analysed.bridge, analysed.workspace.maps
    hands.key(Qt.Key.Key_F8, SHIFT)
    hands.see(lambda: maps.beside is not None and maps.beside.isVisible())
    view, above = maps.beside, maps.map
    hands.see(lambda: view._texture is not None and view.plot.area.height() > 40)
    assert view.time_range is above.time_range
    assert view.plot.area.left() == above.plot.area.left()
    assert view.plot.area.width() == above.plot.area.width()
    texture = bridge.state.analysis.texture
    row = texture.joints[3]
    above.time_range.show(100, 160)
    hands.see(lambda: view.plot.x_of(100) == above.plot.x_of(100))
    at = middle(view, row, 130)
    place = round((130 - texture.start) / texture.frames_each)
    x, y, z = turned(texture)[place, 3]
    assert f"x {x:.0f}°, y {y:.0f}°, z {z:.0f}°" in view.read_out(at)
    seen = QColor(view.plot.grab().toImage().pixel(at.toPoint()))
    wanted = (255 * rgb(np.array([x, y, z]))).tolist()
    assert np.allclose(seen.getRgb()[:3], wanted, atol=4)
    mouse.click(view.plot.viewport(), at)
    assert bridge.state.frame == 130

    hands.key(Qt.Key.Key_F8, CONTROL)
    second = analysed.workspace._second
    hands.see(lambda: second.analysis is not None, 90)
    first = bridge.state.analysis
    assert bridge.ui.beside == "map" and view._texture is None
    expected = run(detect(first.take, (), first.parameters))
    np.testing.assert_allclose(second.analysis.map.values, expected.map.values, atol=1e-5)
    assert [f.id for f in second.analysis.flags] == [f.id for f in expected.flags]
    value = expected.map.values[130, expected.map.rows.index(row)]
    assert f"digression {value:.2f}" in view.read_out(middle(view, row, 130))
    assert hands.text("beside-note").startswith(f"{len(expected.flags)} flags")

    bridge.document.set_threshold(0.8)
    raised = expected.with_threshold(0.8).flags
    assert [f.id for f in second.analysis.flags] == [f.id for f in raised]

    hands.key(Qt.Key.Key_F8, CONTROL)
    assert not view.isVisible() and bridge.ui.beside == ""


def test_the_second_map_can_be_stopped_and_drawn_against_a_folder(
    analysed, hands, generated
) -> None:
    second, bridge = analysed.workspace._second, analysed.bridge
    bridge.set_ui(beside="map")
    assert second.running
    analysed.actions_["cancel"].trigger()
    hands.see(lambda: not second.running)
    assert second.analysis is None
    hands.see(lambda: "Stopped" in hands.text("beside-hint"))
    second.choose(OtherContext(folder=generated.context[0].parent))
    hands.see(lambda: second.analysis is not None, 90)
    assert [one.name for one in second.analysis.context] == ["clean"]
    first = bridge.state.analysis
    np.testing.assert_allclose(second.analysis.map.values, first.map.values, atol=1e-5)
    empty = generated.take.parent / "empty"
    empty.mkdir()
    second.choose(OtherContext(folder=empty))
    hands.see(lambda: second.trouble is not None)
    hands.see(lambda: str(empty) in hands.text("beside-hint"))


def test_nothing_is_computed_while_nobody_looks(analysed, hands) -> None:
    second = analysed.workspace._second
    assert analysed.workspace.maps.beside is None
    assert analysed.workspace.distances is None
    assert second.analysis is None and not second.running
    assert without_itself(analysed.bridge.document.context_takes, analysed.bridge.state.take)
