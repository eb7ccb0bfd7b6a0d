"""The turntable: what is projected where, and what stays put under the mouse."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from vtkmodules.vtkRenderingCore import vtkCamera

from mocapstudio.gui.viewport import picking
from mocapstudio.gui.viewport.camera import PRESETS, VIEW_ANGLE, Turntable

SIZE = (900, 560)

cameras = st.builds(
    Turntable,
    focal=hnp.arrays(float, 3, elements=st.floats(-5, 5)),
    azimuth=st.floats(-math.pi, math.pi),
    elevation=st.floats(math.radians(-25), math.radians(90)),
    distance=st.floats(0.5, 20),
)
pixels = st.tuples(st.floats(0, SIZE[0]), st.floats(0, SIZE[1]))


def through_vtk(camera: Turntable, point: np.ndarray) -> tuple[float, float]:
    """Where VTK itself draws a point, from the top left."""
    view = vtkCamera()
    view.SetViewAngle(math.degrees(VIEW_ANGLE))
    view.SetPosition(*camera.position())
    view.SetFocalPoint(*camera.focal)
    view.SetViewUp(*camera.basis()[1])
    view.SetClippingRange(0.01, 1000)
    matrix = view.GetCompositeProjectionTransformMatrix(SIZE[0] / SIZE[1], -1, 1)
    x, y, _, w = matrix.MultiplyPoint((*point, 1.0))
    return (x / w + 1) / 2 * SIZE[0], (1 - y / w) / 2 * SIZE[1]


@given(cameras, hnp.arrays(float, 3, elements=st.floats(-1, 1)))
def test_a_point_is_projected_to_where_vtk_draws_it(camera, offset):
    point = camera.focal + 0.3 * camera.distance * offset
    (found,), (depth,) = camera.project(point[None], SIZE)
    assert depth > 0
    assert found == pytest.approx(through_vtk(camera, point), abs=1e-3)


@given(cameras)
def test_the_axes_are_right_handed_and_the_horizon_level(camera):
    axes = camera.basis()
    assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.cross(axes[0], axes[1]) == pytest.approx(axes[2], abs=1e-12)
    assert axes[0][1] == 0.0
    assert axes[1][1] >= -1e-12


@given(cameras, st.lists(st.tuples(st.floats(-2, 2), st.floats(-2, 2)), max_size=8))
def test_orbiting_keeps_focus_distance_and_bounds(camera, drags):
    focal, distance = camera.focal.copy(), camera.distance
    for right, up in drags:
        camera.orbit(right, up)
        assert math.radians(-25.001) <= camera.elevation <= math.radians(90.001)
    assert np.linalg.norm(camera.position() - focal) == pytest.approx(distance)


def test_dragging_to_the_right_turns_the_near_side_to_the_right():
    camera = Turntable(np.zeros(3), 0.0, 0.0, 5.0)
    near = np.array([[0.0, 0.0, 1.0]])
    camera.orbit(0.2, 0.0)
    assert camera.project(near, SIZE)[0][0, 0] > SIZE[0] / 2


@given(cameras, pixels, st.floats(0.3, 3))
def test_zooming_keeps_what_is_under_the_mouse(camera, mouse, factor):
    metres = camera.metres_per_pixel(SIZE[1])
    right, up, _ = camera.basis()
    x, y = (mouse[0] - SIZE[0] / 2) * metres, (SIZE[1] / 2 - mouse[1]) * metres
    point = camera.focal + x * right + y * up
    camera.zoom(factor, mouse, SIZE)
    assert camera.project(point[None], SIZE)[0][0] == pytest.approx(mouse, abs=1e-3)


@given(cameras, st.floats(-300, 300), st.floats(-300, 300))
def test_panning_takes_the_focus_along_by_as_many_pixels(camera, right, up):
    before = camera.focal.copy()
    camera.pan(right, up, SIZE[1])
    (found,), _ = camera.project(before[None], SIZE)
    assert found == pytest.approx((SIZE[0] / 2 + right, SIZE[1] / 2 - up), abs=1e-3)


@given(
    cameras,
    hnp.arrays(float, (12, 3), elements=st.floats(-2, 2), unique=True),
    st.floats(0.3, 3),
)
def test_framing_brings_every_point_into_the_picture(camera, points, aspect):
    size = (round(600 * aspect), 600)
    camera.frame(points, size[0] / size[1])
    found, depth = camera.project(points, size)
    assert (depth > 0).all()
    assert (found >= -1).all()
    assert (found <= np.array(size) + 1).all()


@pytest.mark.parametrize("heading", [0.0, 1.2, -2.9])
def test_presets_stand_round_the_performer(heading):
    ahead = np.array([math.sin(heading), 0.0, math.cos(heading)])
    left = np.array([math.cos(heading), 0.0, -math.sin(heading)])
    stands = {}
    for view in PRESETS:
        camera = Turntable(np.zeros(3), distance=4.0)
        camera.look(view, heading)
        stands[view] = camera.position() / 4.0
    assert stands["front"] @ ahead > 0.99
    assert stands["side"] @ left > 0.99
    assert stands["top"] @ np.array([0, 1.0, 0]) == pytest.approx(1)
    assert stands["three-quarter"] @ ahead > 0.5
    assert stands["three-quarter"] @ left > 0.3


def test_an_unknown_preset_is_refused():
    with pytest.raises(KeyError):
        Turntable().look("from behind the sofa", 0.0)


@given(cameras, hnp.arrays(float, (9, 3), elements=st.floats(-1, 1)), pixels)
def test_the_nearest_joint_within_reach_is_picked(camera, offsets, mouse):
    joints = camera.focal + 0.3 * camera.distance * offsets
    apart = [math.dist(through_vtk(camera, joint), mouse) for joint in joints]
    found = picking.joint_at(camera, joints, mouse, SIZE)
    if min(apart) > picking.REACH + 0.01:
        assert found is None
    elif min(apart) < picking.REACH - 0.01:
        assert found is not None
        assert apart[found] == pytest.approx(min(apart), abs=0.01)


def test_of_joints_at_one_place_the_first_is_picked():
    camera = Turntable(np.zeros(3))
    joints = np.array([[1.0, 1.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    assert picking.joint_at(camera, joints, (450.0, 280.0), SIZE) == 1


def test_a_joint_behind_the_camera_is_never_picked():
    camera = Turntable(np.zeros(3), 0.0, 0.0, 2.0)
    behind = np.array([[0.0, 0.0, 3.0]])
    assert picking.joint_at(camera, behind, (450.0, 280.0), SIZE) is None
