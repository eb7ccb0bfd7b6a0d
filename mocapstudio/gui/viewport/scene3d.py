"""The scene in VTK: figures, marks, floor, light; put into place once for every frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from vtkmodules.vtkRenderingCore import vtkLight

from mocapstudio.gui.viewport import floor, marks
from mocapstudio.gui.viewport.bodies import Bodies
from mocapstudio.gui.viewport.camera import VIEW_ANGLE, Turntable
from mocapstudio.gui.viewport.cast import ONION, Part, Role
from mocapstudio.gui.viewport.look import Look
from mocapstudio.gui.viewport.palette import Palette, mix, tint
from mocapstudio.gui.viewport.shaping import stature
from mocapstudio.gui.viewport.solids import Floats
from mocapstudio.gui.viewport.world import Points, WorldMotion
from mocapstudio.motion.kinematics import end_positions, take_pose
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.topology import topology

# Where light comes from, seen from the camera (right, up, back), and how strong it is.
_LIGHTS = (((-0.7, 0.9, 0.8), 0.85), ((0.9, 0.1, 0.5), 0.25), ((0.2, 0.7, -1.0), 0.4))

_TRAIL = 0.5
_TRAIL_STEPS = 24
_APART = 0.003
_SAMPLES = 48
# How stout a ghost is beside the performer: it must not hide what it is compared with.
_GIRTH = {Part.ORIGINAL: 0.6, Part.PROPOSAL: 0.8, Part.NEIGHBOUR: 0.45,
          Part.BEFORE: 0.5, Part.AFTER: 0.5}  # fmt: skip


def set_up(renderer: Any) -> None:
    """Make a renderer of VTK fast and light its scene from the camera."""
    # Order-independent translucency is a pass over the whole picture; thin lines need none.
    renderer.SetUseOIT(False)
    # Three actors: finding out what is out of sight costs more than drawing it.
    renderer.GetCullers().RemoveAllItems()
    renderer.RemoveAllLights()
    for place, strength in _LIGHTS:
        light = vtkLight()
        light.SetLightTypeToCameraLight()
        light.SetPosition(*place)
        light.SetIntensity(strength)
        renderer.AddLight(light)


def aim(renderer: Any, camera: Turntable, radius: float) -> None:
    """Show a renderer's scene, which reaches `radius` metres, from where the camera is."""
    view = renderer.GetActiveCamera()
    view.SetViewAngle(np.degrees(VIEW_ANGLE))
    view.SetPosition(*camera.position())
    view.SetFocalPoint(*camera.focal)
    view.SetViewUp(*camera.basis()[1])
    view.SetClippingRange(*camera.clipping(radius))


def colour_ground(renderer: Any, palette: Palette) -> None:
    """Fill the background from the palette's bottom to its top."""
    renderer.SetBackground(*(c / 255 for c in palette.bottom))
    renderer.SetBackground2(*(c / 255 for c in palette.top))
    renderer.GradientBackgroundOn()


class Scene3D:
    """Everything that is drawn; three actors, whatever is on stage.

    Parameters
    ----------
    renderer
        Of VTK.
    """

    def __init__(self, renderer: Any) -> None:
        self._renderer = renderer
        self._bodies, self._marks, self._floor = Bodies(), marks.Marks(), floor.Floor()
        for mesh in (self._floor.mesh, self._marks.mesh, self._bodies.mesh):
            renderer.AddActor(mesh.actor)
        self._floor.mesh.actor.ForceTranslucentOn()
        set_up(renderer)
        self._roles: tuple[Role, ...] = ()
        self._palette: Palette | None = None
        self.stature = 1.7
        self.level = 0.0
        self.step = 1.0
        self._radius = 10.0
        self._floored: tuple[list[WorldMotion], Palette] | None = None

    def cast(self, roles: Sequence[Role], palette: Palette) -> None:
        """Put other figures on stage, or colour them otherwise."""
        self._roles, self._palette = tuple(roles), palette
        self._plain = [_plain_colours(role, palette) for role in roles]
        self._bodies.cast([role.figure for role in roles])
        colour_ground(self._renderer, palette)
        if roles:
            self._lay_floor(palette)
        else:
            self._marks.show()
        self._floor.mesh.actor.SetVisibility(bool(roles))

    def stand_in(self, motion: WorldMotion) -> None:
        """Let the performer under review move otherwise for now; floor and colours stay."""
        if self._roles:
            self._roles = (replace(self._roles[0], motion=motion), *self._roles[1:])

    def _lay_floor(self, palette: Palette) -> None:
        shown = [r.motion for r in self._roles if r.part in (Part.RESULT, Part.PARTNER)]
        if self._floored == (shown, palette):
            return
        self._floored = (shown, palette)
        first = shown[0]
        self.stature = stature(first.take.skeleton, first.points(0))
        self.step = floor.spacing(self.stature)
        self.level = floor_level(first, self.stature)
        paths = np.concatenate([motion.hips_path for motion in shown])[:, [0, 2]]
        low, high, self._radius = floor.extent(paths, self.step)
        self._floor.lay(low, high, self.level, self.step, palette.floor)

    def place(self, look: Look, camera: Turntable) -> None:
        """Put everything where it is at a frame, as the camera sees it."""
        if not self._roles or self._palette is None:
            return
        result = self._roles[0]
        points = result.motion.points(look.frame)
        for number, role in enumerate(self._roles):
            own = role.frame(look.frame)
            if own is None:
                self._bodies.hide(number)
            elif role.part is Part.RESULT:
                self._bodies.pose(number, points, self._result_colours(look))
            elif role.part is Part.PARTNER:
                self._bodies.pose(number, role.motion.points(own), self._plain[number])
            elif role.part in ONION:
                swell = _limbs(role.motion.take.skeleton, look.selected)
                pose = role.motion.points(own)
                self._bodies.pose(number, pose, self._plain[number], _GIRTH[role.part], swell)
            else:
                self._pose_ghost(number, role, role.motion.points(own), points)
        self._bodies.changed()
        self._mark(look, camera, points)
        self._marks.show()

    def aim(self, camera: Turntable) -> None:
        """Show the scene from where the camera is."""
        aim(self._renderer, camera, self._radius)

    def _result_colours(self, look: Look) -> NDArray[np.uint8]:
        assert self._palette is not None
        if look.values is None:
            return self._plain[0]
        skeleton = self._roles[0].motion.take.skeleton
        joints = tint(self._palette, look.values, look.threshold)
        return np.concatenate([joints, joints[skeleton.end_parents]])

    def _pose_ghost(self, number: int, role: Role, pose: Points, result: Points) -> None:
        assert self._palette is not None
        apart = np.linalg.norm(pose - result, axis=1) > _APART * self.stature / 1.7
        if not apart.any():
            self._bodies.hide(number)
            return
        size = np.where(_moved_by(role), 1.0, 0.7)
        swell: Floats = np.where(apart, size, 0.0).astype(np.float32)
        self._bodies.pose(number, pose, self._plain[number], _GIRTH[role.part], swell)

    def _mark(self, look: Look, camera: Turntable, points: Points) -> None:
        assert self._palette is not None
        level = self.level - 0.004 * self.step
        for role in self._roles:
            own = role.frame(look.frame)
            if own is not None and role.part in (Part.RESULT, Part.PARTNER):
                pose = role.motion.points(own)
                self._marks.shadow(role.figure, pose, level, self._palette.shadow)
        motion = self._roles[0].motion
        hips = points[topology(motion.take.skeleton).hips]
        tone = mix(self._palette.floor, self._palette.body, 0.35)
        heading = motion.heading(look.frame)
        self._marks.arrow(hips, heading, self.stature, self.level, tone)
        axes = camera.basis()
        for joint in look.selected:
            if look.trails:
                self._trail(motion, joint, look.frame, camera.position())
            radius = max(0.0225 * self.stature, 7 * look.pixel)
            width = max(0.0028 * self.stature, 1.8 * look.pixel)
            self._marks.ring(points[joint], radius, width, axes, self._palette.accent)

    def _trail(self, motion: WorldMotion, joint: int, frame: int, eye: NDArray[np.float64]) -> None:
        assert self._palette is not None
        step = _TRAIL * float(motion.take.rate) / _TRAIL_STEPS
        steps = np.arange(-_TRAIL_STEPS, _TRAIL_STEPS + 1)
        frames = np.clip(np.round(frame + step * steps), 0, motion.take.frames - 1).astype(int)
        share = np.abs(steps) / _TRAIL_STEPS
        # What has been is the accent, what comes is grey; both fade into the background.
        past = marks.fading(self._palette.accent, self._palette.bottom, 0.25 + 0.7 * share)
        coming = marks.fading(self._palette.faint, self._palette.bottom, 0.7 * share)
        colours = np.where((steps <= 0)[:, None], past, coming)
        width = 0.006 * self.stature * (1 - 0.75 * share)
        self._marks.trail(motion.path(joint, frames), width, eye, colours)


def floor_level(motion: WorldMotion, height: float) -> float:
    """Metres: the floor's height, zero unless the feet say clearly otherwise."""
    take = motion.take
    every = max(1, take.frames // _SAMPLES)
    few = type(take)(
        take.name,
        take.skeleton,
        take.rotations[::every],
        take.translations[::every],
        take.rate,
        take.translated,
    )
    positions, world = take_pose(few)
    tips = end_positions(take.skeleton, positions, world)
    lowest = np.concatenate([positions, tips], axis=1)[..., 1].min(axis=1)
    level = float(np.percentile(lowest, 10))
    return 0.0 if abs(level) < 0.1 * height else level


def _plain_colours(role: Role, palette: Palette) -> NDArray[np.uint8]:
    """(J + E, 3): what a role is coloured with apart from the map; what only follows is duller."""
    colour = {
        Part.RESULT: palette.body,
        Part.PARTNER: palette.partner,
        Part.ORIGINAL: palette.original,
        Part.PROPOSAL: palette.proposal,
        Part.NEIGHBOUR: palette.neighbour,
        Part.BEFORE: palette.accent,
        Part.AFTER: palette.coming,
    }[role.part]
    colour = mix(colour, palette.bottom, role.fade)
    dull = mix(colour, palette.bottom, 0.45)
    return np.where(_moved_by(role)[:, None], colour, dull).astype(np.uint8)


def _limbs(skeleton: Skeleton, selected: Sequence[int]) -> Floats | None:
    """(J + E,): 1 for points of the selected joints' limbs, 0 for others; None for the body."""
    if not selected:
        return None
    parts = topology(skeleton)
    joints = {joint for one in selected for joint in (one, *parts.limb_of(one).joints)}
    inside = np.array([joint in joints for joint in range(len(skeleton))])
    return np.concatenate([inside, inside[skeleton.end_parents]]).astype(np.float32)


def _moved_by(role: Role) -> NDArray[np.bool_]:
    """(J + E,): far ends of the bones that the role's own joints turn; all, if all may turn."""
    skeleton = role.motion.take.skeleton
    if not role.turned:
        return np.ones(len(skeleton) + len(skeleton.end_parents), dtype=bool)
    turned = np.array([name in role.turned for name in skeleton.names])
    parents = np.concatenate([skeleton.parents, skeleton.end_parents])
    moved: NDArray[np.bool_] = (parents >= 0) & turned[parents]
    return moved
