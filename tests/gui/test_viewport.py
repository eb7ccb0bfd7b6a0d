"""The 3-D view in real windows, with real mouse and keys."""

from __future__ import annotations

import gc
import os
import subprocess
import sys
import weakref
from dataclasses import replace
from pathlib import Path

import mouse
import numpy as np
import pytest
from plot_scene import offer, sitting, walking
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication, QMainWindow, QToolTip

from mocapstudio.gui import theme
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.views.viewport import Viewport
from mocapstudio.motion.errors import FileError

SHIFT = Qt.KeyboardModifier.ShiftModifier


@pytest.fixture
def desk(qtbot):
    theme.apply(QApplication.instance(), theme.DARK)
    document = sitting()
    bridge = DocumentBridge(document)
    window = QMainWindow()
    qtbot.addWidget(window)
    view = Viewport(bridge, window)
    window.setCentralWidget(view)
    window.resize(900, 560)
    with qtbot.waitExposed(window):
        window.show()
    window.activateWindow()
    settle(qtbot)
    yield document, view
    window.close()


def settle(qtbot):
    qtbot.wait(350)


def picture(view) -> np.ndarray:
    image = view.grab().toImage().convertToFormat(QImage.Format.Format_RGB888)
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), -1)
    return rows[:, : 3 * image.width()].reshape(image.height(), image.width(), 3).astype(int)


def middle(view) -> np.ndarray:
    """The picture without what lies over it."""
    return picture(view)[60:-60]


def differing(before: np.ndarray, after: np.ndarray) -> int:
    return int((np.abs(after - before).max(axis=2) > 12).sum())


def canvas_of(view):
    return view._canvas


def place(view, name: str) -> QPointF:
    """Where a joint is seen, by the camera that tests of its own compare with VTK's."""
    motion = view.director.roles[0].motion
    joint = motion.take.skeleton.index[name]
    points = motion.points(view._bridge.state.frame)[[joint]]
    canvas = canvas_of(view)
    (found,), _ = view.camera.project(points, (canvas.width(), canvas.height()))
    return QPointF(*found)


def test_the_performer_is_in_the_picture_where_the_camera_says(desk):
    _, view = desk
    seen = picture(view)
    body = np.array(theme_rgb(theme.DARK.body))
    for name in ("LeftHand", "RightFoot", "Hips", "LeftForeArm"):
        at = place(view, name)
        x, y = round(at.x()), round(at.y())
        patch = seen[y - 4 : y + 5, x - 4 : x + 5]
        lit = patch.max(axis=(0, 1))
        assert (lit > 0.4 * body).all(), name
    corner = seen[view.height() // 2, 5]
    assert corner.max() < 60


def theme_rgb(name: str) -> tuple[int, ...]:
    return tuple(int(name[i : i + 2], 16) for i in (1, 3, 5))


def test_a_click_selects_a_joint_and_shift_one_more(desk, qtbot):
    document, view = desk
    mouse.click(canvas_of(view), place(view, "LeftHand"))
    assert document.state.selection.joints == {"LeftHand"}
    mouse.click(canvas_of(view), place(view, "RightFoot"), modifiers=SHIFT)
    assert document.state.selection.joints == {"LeftHand", "RightFoot"}
    mouse.click(canvas_of(view), place(view, "LeftHand"), modifiers=SHIFT)
    assert document.state.selection.joints == {"RightFoot"}
    mouse.click(canvas_of(view), QPointF(30, 300))
    assert document.state.selection.joints == {"RightFoot"}


def test_a_click_keeps_the_selected_flag(desk):
    document, view = desk
    flag = document.state.queue[0].flag
    document.select_flag(flag.id)
    mouse.click(canvas_of(view), place(view, "RightFoot"))
    assert document.state.selection.flag == flag.id


def test_the_selected_joint_is_ringed_in_the_accent(desk, qtbot):
    document, view = desk
    before = middle(view)
    document.select(joints=["RightHand"])
    settle(qtbot)
    after = middle(view)
    accent = np.array(theme_rgb(theme.DARK.accent))
    ringed = (np.abs(after - accent).max(axis=2) < 25).sum()
    assert ringed > 40 > (np.abs(before - accent).max(axis=2) < 25).sum()


def test_hovering_names_the_joint(desk, qtbot):
    _, view = desk
    mouse.move(canvas_of(view), place(view, "LeftHand"))
    qtbot.waitUntil(QToolTip.isVisible, timeout=2000)
    assert QToolTip.text().startswith("LeftHand · 0.")
    mouse.move(canvas_of(view), QPointF(30, 300))
    qtbot.waitUntil(lambda: not QToolTip.isVisible(), timeout=2000)


def test_dragging_orbits_pans_and_selects_nothing(desk, qtbot):
    document, view = desk
    azimuth, focal = view.camera.azimuth, view.camera.focal.copy()
    begin = place(view, "Hips")
    mouse.drag(canvas_of(view), begin, begin + QPointF(80, 10))
    assert view.camera.azimuth != azimuth
    assert view.camera.focal == pytest.approx(focal)
    hips = place(view, "Hips")
    mouse.drag(canvas_of(view), begin, begin + QPointF(60, 40), Qt.MouseButton.MiddleButton)
    moved = place(view, "Hips") - hips
    assert (moved.x(), moved.y()) == pytest.approx((60, 40), abs=6)
    assert document.state.selection.joints == frozenset()


def test_the_wheel_zooms_towards_the_mouse(desk):
    _, view = desk
    distance = view.camera.distance
    hand = place(view, "LeftHand")
    mouse.wheel(canvas_of(view), hand, 3)
    assert view.camera.distance < 0.7 * distance
    moved = place(view, "LeftHand") - hand
    assert abs(moved.x()) + abs(moved.y()) < 60
    mouse.wheel(canvas_of(view), hand, -3)
    assert view.camera.distance == pytest.approx(distance)


def test_keys_choose_a_view_wherever_the_focus_is(desk, qtbot):
    document, view = desk
    heading = view.director.roles[0].motion.heading(document.state.frame)
    for key, away, high in ((Qt.Key.Key_6, 0, 6), (Qt.Key.Key_7, 90, 6), (Qt.Key.Key_8, 0, 90)):
        qtbot.keyClick(view.window(), key)
        turned = np.degrees(view.camera.azimuth - heading) - away
        assert np.remainder(turned + 180, 360) == pytest.approx(180, abs=0.1)
        assert np.degrees(view.camera.elevation) == pytest.approx(high)


def test_a_double_click_frames_the_joint_and_one_beside_it_the_body(desk):
    _, view = desk
    far = view.camera.distance
    mouse.double_click(canvas_of(view), place(view, "LeftHand"))
    assert view.camera.distance < 0.5 * far
    hand = view.director.points(view._bridge.state.frame)[
        view.director.roles[0].motion.take.skeleton.index["LeftHand"]
    ]
    assert np.linalg.norm(view.camera.focal - hand) < 0.02
    view._bridge.document.clear_selection()
    mouse.double_click(canvas_of(view), QPointF(20, 300))
    assert view.camera.distance > 0.6 * far


def test_stepping_keeps_the_camera_and_follows_the_performer(desk, qtbot):
    document, view = desk
    document.set_frame(100)
    stand = (view.camera.azimuth, view.camera.elevation, view.camera.distance)
    before, focal = place(view, "Hips"), view.camera.focal.copy()
    document.set_frame(1000)
    assert (view.camera.azimuth, view.camera.elevation, view.camera.distance) == stand
    moved = place(view, "Hips") - before
    assert abs(moved.x()) + abs(moved.y()) < 60
    document.set_frame(100)
    assert view.camera.focal == pytest.approx(focal)
    view.set_follow(False)
    document.set_frame(300)
    assert view.camera.focal == pytest.approx(focal)
    assert (place(view, "Hips") - before).manhattanLength() > 200
    view.set_follow(True)
    assert (place(view, "Hips") - before).manhattanLength() < 120


def test_ghosts_come_and_go(desk, qtbot):
    document, view = desk
    flag = next(i.flag for i in document.state.queue if i.flag.joint == "RightLeg")
    document.select_flag(flag.id)
    settle(qtbot)
    without = middle(view)
    offer(document, flag.id)
    settle(qtbot)
    shown = middle(view)
    blue = np.array(theme_rgb(theme.DARK.proposal))
    ratio = shown / np.maximum(shown.max(axis=2, keepdims=True), 1)
    like = np.abs(ratio - blue / blue.max()).max(axis=2) < 0.08
    assert differing(without, shown) > 150
    assert (like & (np.abs(shown - without).max(axis=2) > 12)).sum() > 60
    view.set_ghosts(False)
    settle(qtbot)
    assert differing(without, middle(view)) < 20
    assert not view._bridge.ui.ghosts


def test_the_caption_tells_take_frame_and_time_as_the_file_numbers_them(desk):
    document, view = desk
    document.set_frame(240)
    labels = [part.text() for part in view._caption.children() if hasattr(part, "text")]
    assert labels == ["walking", "frame 241 · 2.00 s"]


def test_a_long_name_makes_room_for_the_buttons(desk, qtbot):
    document, view = desk
    view.window().resize(420, 400)
    qtbot.wait(100)
    document.close_performer(document.state.active)
    document.open_take(replace(walking(), name="a name that is longer than the view is wide " * 2))
    caption = view._caption.geometry()
    assert not caption.intersects(view._bar.geometry().translated(view._bar.parent().pos()))
    assert caption.width() > 60


def test_the_picture_changes_with_the_frame_and_comes_back(desk, qtbot):
    document, view = desk
    document.set_frame(30)
    settle(qtbot)
    first = middle(view)
    document.set_frame(75)
    settle(qtbot)
    assert differing(first, middle(view)) > 500
    document.set_frame(30)
    settle(qtbot)
    assert differing(first, middle(view)) == 0


def test_hidden_and_shown_again_it_shows_the_present(desk, qtbot):
    document, view = desk
    document.set_frame(75)
    settle(qtbot)
    expected = middle(view)
    document.set_frame(30)
    settle(qtbot)
    view.window().hide()
    document.set_frame(75)
    view.window().show()
    settle(qtbot)
    assert differing(expected, middle(view)) == 0


def test_another_theme_recolours_the_scene(desk, qtbot):
    _, view = desk
    assert middle(view)[5, 5].max() < 80
    theme.apply(QApplication.instance(), theme.LIGHT)
    settle(qtbot)
    assert middle(view)[5, 5].min() > 180
    theme.apply(QApplication.instance(), theme.DARK)


def test_files_dropped_on_it_are_left_to_the_desk(desk):
    _, view = desk
    assert not canvas_of(view).acceptDrops()
    assert not view.acceptDrops()


def test_a_screenshot_is_written_or_refused(desk, tmp_path):
    _, view = desk
    view.screenshot(tmp_path / "view.png")
    image = QImage(str(tmp_path / "view.png"))
    assert (image.width(), image.height()) == (view.width(), view.height())
    with pytest.raises(FileError, match="picture"):
        view.screenshot(tmp_path / "missing" / "view.png")


def test_an_empty_scene_and_a_scene_of_no_analysis_are_shown(qtbot):
    document = sitting(analysed=False)
    bridge = DocumentBridge(document)
    view = Viewport(bridge)
    qtbot.addWidget(view)
    view.resize(500, 400)
    view.show()
    settle(qtbot)
    document.close_performer(document.state.active)
    settle(qtbot)
    view.frame_joint(None)
    view.set_view("top")
    view.set_neighbours_shown(True)
    assert np.ptp(middle(view), axis=(0, 1)).max() < 40


def test_opened_and_closed_ten_times_nothing_stays(qtbot):
    gone = []
    for _ in range(10):
        window = QMainWindow()
        bridge = DocumentBridge(sitting())
        view = Viewport(bridge, window)
        window.setCentralWidget(view)
        window.resize(500, 400)
        with qtbot.waitExposed(window):
            window.show()
        bridge.document.set_frame(50)
        qtbot.wait(30)
        window.close()
        window.deleteLater()
        gone.append((weakref.ref(view), weakref.ref(view._canvas), weakref.ref(view._scene)))
        del window, view, bridge
        qtbot.wait(10)
    gc.collect()
    qtbot.wait(20)
    left = [ref() for refs in gone for ref in refs if ref() is not None]
    assert left == []
    names = {type(widget).__name__ for widget in QApplication.allWidgets()}
    assert "Canvas" not in names


OPENED = """
import sys
sys.path.insert(0, {tests!r})
from PySide6.QtWidgets import QApplication, QLabel
from plot_scene import sitting
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.views.viewport import Viewport
app = QApplication([])
document = sitting()
view = Viewport(DocumentBridge(document))
view.resize(600, 400)
view.show()
for frame in range(20):
    document.set_frame(frame)
    app.processEvents()
view.frame_joint("LeftHand")
view.set_neighbours_shown(True)
view.set_view("top")
message = view.findChild(QLabel, "viewport-message")
print("told:", "" if message is None else message.text())
"""


def run(platform: str) -> subprocess.CompletedProcess[str]:
    code = OPENED.format(tests=str(Path(__file__).parent))
    environment = {**os.environ, "QT_QPA_PLATFORM": platform}
    return subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=120
    )


def test_without_opengl_a_message_says_what_to_do():
    done = run("offscreen")
    assert done.returncode == 0, done.stderr
    assert "told: OpenGL is not available: " in done.stdout
    assert "mocapstudio doctor" in done.stdout
    assert "Traceback" not in done.stderr


def test_a_program_that_ends_with_the_view_open_ends_well():
    done = run("xcb")
    assert done.returncode == 0, done.stderr
    assert done.stdout == "told: \n"
