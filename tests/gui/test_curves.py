"""The curves in a real window, worked with the mouse."""

from __future__ import annotations

import mouse
import numpy as np
import plot_scene
import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from mocapstudio import formats
from mocapstudio.formats.euler_order import euler_order
from mocapstudio.gui import theme as themes
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.curve_set import Role
from mocapstudio.gui.plots.quantities import JOINT_QUANTITIES, Quantity, quantities_of
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.gui.views.curves import CurvesView
from mocapstudio.gui.views.digression_map import DigressionMapView
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.review.document import Document


@pytest.fixture
def document():
    return plot_scene.sitting()


@pytest.fixture
def view(qtbot, document):
    themes.apply(QApplication.instance(), themes.DARK)
    return shown(qtbot, document)


def shown(qtbot, document):
    view = CurvesView(DocumentBridge(document))
    qtbot.addWidget(view)
    view.resize(1440, 200)
    view.show()
    qtbot.waitExposed(view)
    QApplication.processEvents()
    return view


def surface(view):
    return view.plot.viewport()


def at(view, frame, share=0.5):
    area = view.plot.area
    return QPointF(view.plot.x_of(frame), area.top() + share * area.height())


def flag_of(document, row):
    return next(item.flag for item in document.state.queue if item.flag.joint == row)


def test_without_a_selection_it_says_what_to_do(qtbot, document):
    view = shown(qtbot, document)
    assert view.empty.isVisible()
    document.select(joints=["Head"])
    assert not view.empty.isVisible()
    assert view.row == "Head"
    document.clear_selection()
    assert view.empty.isVisible()


def test_the_flag_decides_which_of_several_selected_joints_is_shown(view, document):
    document.select(joints=["Head", "LeftArm", "Hips"])
    assert view.row == "Hips"
    assert view.panel.name.toolTip() == "Hips +2"
    document.select_flag(flag_of(document, "RightLeg").id)
    assert view.row == "RightLeg"


@pytest.mark.parametrize("quantity", JOINT_QUANTITIES)
def test_every_quantity_can_be_chosen_and_is_drawn(view, document, quantity):
    document.select(joints=["LeftForeArm"])
    number = view.panel.chooser.findData(quantity)
    view.panel.chooser.setCurrentIndex(number)
    view.panel.chooser.activated.emit(number)
    QApplication.processEvents()
    assert view.quantity is quantity
    drawn = view.curve_set.curves(Role.ORIGINAL)
    picture = view.plot.grab().toImage()
    area = view.plot.area
    low, high = view.plot.plotItem.vb.viewRange()[1]
    for number, name in enumerate(drawn.names):
        wanted = colours.component(themes.DARK, name)
        for frame in range(50, 1150, 50):
            value = drawn.values[frame, number]
            y = round(area.bottom() - (value - low) / (high - low) * area.height())
            x = round(view.plot.x_of(frame))
            near = [QColor(picture.pixel(x, y + dy)) for dy in range(-3, 4)]
            assert any(_tinted(colour, wanted) for colour in near), (name, frame)


def _tinted(colour, wanted):
    """Whether a smooth line of the wanted colour touches a pixel of the plot's dark ground."""
    ground = QColor(themes.DARK.field)
    parts = [
        (getattr(colour, part)() - getattr(ground, part)())
        - 0.3 * (getattr(wanted, part)() - getattr(ground, part)())
        for part in ("red", "green", "blue")
    ]
    return min(parts) > -12


def choose(view, quantity: Quantity) -> None:
    chooser = view.panel.chooser
    at = chooser.findData(quantity)
    chooser.setCurrentIndex(at)
    chooser.activated.emit(at)


def test_the_position_curve_holds_metres_of_the_world(view, document):
    document.select(joints=["LeftHand"])
    choose(view, Quantity.POSITION)
    take = document.state.take
    positions, _ = take_pose(take)
    drawn = view.curve_set.curves(Role.ORIGINAL)
    np.testing.assert_allclose(
        drawn.values, positions[:, take.skeleton.index["LeftHand"]], atol=1e-9
    )
    document.set_frame(321)
    texts = dict(view.values.lines)
    assert texts["y"] == f"{drawn.values[321, 1]:.3f} m"


def test_root_rows_have_quantities_of_their_own_and_choices_are_remembered(view, document):
    document.select(joints=["Head"])
    choose(view, Quantity.SPEED)
    document.select(joints=["root heading"])
    assert view.quantity is Quantity.HEADING
    offered = [view.panel.chooser.itemData(i) for i in range(view.panel.chooser.count())]
    assert offered == list(quantities_of("root heading"))
    document.select(joints=["root position"])
    assert view.quantity is Quantity.POSITION
    document.select(joints=["LeftArm"])
    assert view.quantity is Quantity.SPEED


def test_euler_angles_come_in_the_order_of_the_file(qtbot, data):
    take = formats.read(data / "cmu_salsa_pairs_bvh" / "60_10_scaled.bvh")[0][0]
    document = Document(author="tester")
    document.open_take(take)
    view = shown(qtbot, document)
    for row in ("hip", "lForeArm"):
        document.select(joints=[row])
        choose(view, Quantity.EULER)
        order = euler_order(take, take.skeleton.index[row])
        assert view.curve_set.curves(Role.ORIGINAL).names == tuple(order.lower())
    assert euler_order(take, 0) == "ZYX"
    assert euler_order(take, take.skeleton.index["lForeArm"]) == "ZXY"
    assert euler_order(plot_scene.walking(10), 0) is None


def test_the_proposal_is_drawn_over_its_span_and_becomes_the_result(view, document):
    flag = flag_of(document, "RightLeg")
    document.select_flag(flag.id)
    assert view.curve_set.curves(Role.PROPOSAL) is None
    offered = plot_scene.offer(document, flag.id)
    drawn = view.curve_set.curves(Role.PROPOSAL)
    assert view.curve_set.start(Role.PROPOSAL) == offered.start - 1
    assert len(drawn.values) == offered.end - offered.start + 2
    assert view.panel.legend.roles == (Role.ORIGINAL, Role.PROPOSAL)
    document.accept([flag.id])
    document.select_flag(flag.id)
    assert view.curve_set.curves(Role.PROPOSAL) is None
    result = view.curve_set.curves(Role.RESULT).values
    np.testing.assert_allclose(result[offered.start : offered.end], drawn.values[1:-1], atol=1e-6)
    original = view.curve_set.curves(Role.ORIGINAL)
    start = view.curve_set.start(Role.ORIGINAL)
    assert start <= offered.start
    assert start + len(original.values) >= offered.end
    document.undo()
    assert view.curve_set.curves(Role.RESULT) is None


def test_an_edit_of_another_row_leaves_this_one_alone(view, document):
    flag = flag_of(document, "RightLeg")
    plot_scene.offer(document, flag.id)
    document.accept([flag.id])
    document.select(joints=["LeftArm"], flag="")
    assert view.curve_set.curves(Role.RESULT) is None
    assert len(view.curve_set.curves(Role.ORIGINAL).values) == document.state.take.frames


def test_a_drag_selects_a_span_and_keeps_the_joint(view, document):
    document.select_flag(flag_of(document, "RightLeg").id)
    document.set_frame(0)
    mouse.drag(surface(view), at(view, 200), at(view, 299, 0.6))
    selection = document.state.selection
    assert selection.span == (200, 300)
    assert selection.joints == {"RightLeg"}
    assert selection.flag is None
    assert document.state.frame == 0


def test_a_click_and_the_play_head_itself_move_the_frame(view, document):
    document.select(joints=["Head"])
    mouse.click(surface(view), at(view, 640))
    assert document.state.frame == 640
    mouse.drag(surface(view), at(view, 640), at(view, 900))
    assert document.state.frame == 900
    assert document.state.selection.span is None
    axis = QPointF(view.plot.x_of(100), view.plot.area.bottom() + 8)
    mouse.click(surface(view), axis)
    assert document.state.frame == 100


def test_the_values_fit_the_visible_frames(view, document):
    document.select(joints=["LeftHand"])
    choose(view, Quantity.POSITION)
    values = view.curve_set.curves(Role.ORIGINAL).values
    for start, end in ((0, 1199), (500, 560)):
        view.time_range.show(start, end)
        low, high = view.plot.plotItem.vb.viewRange()[1]
        part = values[start : end + 1]
        assert low < part.min() < part.max() < high
        assert high - low < 1.5 * max(np.ptp(part), 0.02)


def test_it_shares_its_time_with_the_map(qtbot, document):
    bridge, shared = DocumentBridge(document), TimeRange()
    upper, lower = DigressionMapView(bridge, shared), CurvesView(bridge, shared)
    for view in (upper, lower):
        qtbot.addWidget(view)
        view.resize(1440, 220)
        view.show()
        qtbot.waitExposed(view)
    flag = flag_of(document, "Head")
    document.select_flag(flag.id)
    QTest.keyClick(lower.plot, Qt.Key.Key_Z)
    assert lower.plot.plotItem.vb.viewRange()[0] == pytest.approx([shared.start, shared.end])
    for frame in (flag.start, flag.end, flag.peak_frame):
        assert upper.plot.x_of(frame) + upper.plot.x() == pytest.approx(
            lower.plot.x_of(frame) + lower.plot.x(), abs=1.0
        )


def test_moving_the_play_head_computes_nothing_anew(view, document, monkeypatch):
    document.select(joints=["LeftHand"])
    computed = []
    monkeypatch.setattr("mocapstudio.gui.views.curves.curves", lambda *a, **k: computed.append(1))
    for frame in range(10, 100, 10):
        document.set_frame(frame)
        QApplication.processEvents()
    document.set_threshold(0.7)
    document.select(span=(3, 9))
    assert not computed


def test_switching_to_another_performer_shows_its_motion(view, document):
    document.select(joints=["Head"])
    other = document.open_take(plot_scene.walking(300, rate=60, first_frame=500))
    document.set_active(other)
    assert view.empty.isVisible()
    document.select(joints=["Head"])
    assert len(view.curve_set.curves(Role.ORIGINAL).values) == 300
    assert view.time_range.frames == 300
