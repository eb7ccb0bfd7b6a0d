"""What is to be seen of a state, and from where; no Qt and no VTK in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.model import Proposal
from mocapstudio.gui.viewport import picking
from mocapstudio.gui.viewport.camera import Turntable
from mocapstudio.gui.viewport.cast import Part, Role, Stage
from mocapstudio.gui.viewport.look import Look
from mocapstudio.gui.viewport.mapped import JointValues
from mocapstudio.gui.viewport.palette import Colour, Palette
from mocapstudio.gui.viewport.shaping import stature
from mocapstudio.gui.viewport.world import Points, WorldMotion
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology
from mocapstudio.review.state import DocumentState

_MOST_TRAILS = 6
# How much of the body shows around a framed joint, as a share of the performer's height.
_CLOSE = 0.16
_ROOM = 1.35


class Director:
    """Holds the cast and the camera, and says what is drawn of them at a frame."""

    def __init__(self) -> None:
        self.camera = Turntable()
        self.roles: tuple[Role, ...] = ()
        self._stage = Stage()
        self._values: JointValues | None = None
        self._anchor: NDArray[np.float64] | None = None

    def cast(
        self,
        state: DocumentState,
        result: Take | None,
        *,
        ghosts: bool,
        neighbours: Sequence[Proposal] = (),
        onion: bool = False,
    ) -> None:
        """Choose the roles for a state; `result` is the active take with its edits, if any."""
        if result is None:
            self.roles, self._values, self._anchor = (), None, None
            return
        self.roles = self._stage.cast(
            state, result, ghosts=ghosts, neighbours=neighbours, onion=onion
        )
        mapped = None if state.analysis is None else state.analysis.map
        self._values = None if mapped is None else JointValues(mapped, result.skeleton)

    def stand_in(self, motion: WorldMotion) -> None:
        """Let the performer under review move otherwise for now."""
        if self.roles:
            self.roles = (replace(self.roles[0], motion=motion), *self.roles[1:])

    @property
    def skeleton(self) -> Skeleton:
        """Of the active performer; there must be one."""
        return self.roles[0].motion.take.skeleton

    def points(self, frame: int) -> Points:
        """(J + E, 3) metres: the active performer's joints and tips."""
        return self.roles[0].motion.points(frame)

    def value(self, joint: str, frame: int) -> float | None:
        """Digression of a joint at a frame: NaN where not analysed, None while there is no map."""
        if self._values is None:
            return None
        return float(self._values.at(frame)[self.skeleton.index[joint]])

    def selected(self, state: DocumentState) -> tuple[int, ...]:
        """Joints of the selected rows; a root row means the hips."""
        if not self.roles:
            return ()
        hips = topology(self.skeleton).hips
        names = state.selection.joints
        found = {hips if name in ROOT_ROWS else self.skeleton.index.get(name, -1) for name in names}
        return tuple(sorted(found - {-1}))

    def look(self, state: DocumentState, *, trails: bool, height: int) -> Look:
        """Say what is drawn now, in a picture `height` pixels tall."""
        selected = self.selected(state)
        return Look(
            frame=state.frame,
            values=None if self._values is None else self._values.at(state.frame),
            threshold=state.threshold,
            selected=selected,
            trails=trails and len(selected) <= _MOST_TRAILS,
            pixel=self.camera.metres_per_pixel(height),
        )

    def legend(self, palette: Palette) -> list[tuple[str, Colour]]:
        """Names and colours of everybody but the performer under review."""
        colours = {
            Part.ORIGINAL: palette.original,
            Part.PROPOSAL: palette.proposal,
            Part.NEIGHBOUR: palette.neighbour,
            Part.PARTNER: palette.partner,
            Part.BEFORE: palette.accent,
            Part.AFTER: palette.coming,
        }
        lines = {role.name: colours[role.part] for role in self.roles if role.part in colours}
        return list(lines.items())

    def joint_at(self, frame: int, mouse: tuple[float, float], size: tuple[int, int]) -> str | None:
        """Name the joint under the mouse, or None; pixels from the top left."""
        if not self.roles:
            return None
        joints = self.points(frame)[: len(self.skeleton)]
        found = picking.joint_at(self.camera, joints, mouse, size)
        return None if found is None else self.skeleton.names[found]

    def go_along(self, frame: int, follow: bool) -> None:
        """Take the camera along with the performer, from the frame before to this one."""
        anchor = self.roles[0].motion.followed[frame]
        if follow and self._anchor is not None:
            self.camera.focal = self.camera.focal + (anchor - self._anchor)
        self._anchor = anchor

    def face(self, frame: int) -> None:
        """Put the performer into the middle."""
        if self.roles:
            self.camera.focal = self.roles[0].motion.followed[frame].copy()

    def view(self, name: str, frame: int) -> None:
        """Look from a preset view, as the performer stands at a frame."""
        heading = self.roles[0].motion.heading(frame) if self.roles else 0.0
        self.camera.look(name, heading)

    def introduce(self, frame: int, aspect: float) -> None:
        """Look at a performer who has just come on stage."""
        self.view("three-quarter", frame)
        self.camera.frame(self.points(frame).astype(float), aspect, _ROOM)

    def close_in(self, joints: Sequence[int], frame: int, aspect: float) -> None:
        """Frame some joints with what is near them, or the body where there are none."""
        points = self.points(frame).astype(float)
        if joints:
            room = _CLOSE * stature(self.skeleton, points)
            near = points[list(joints)]
            points = np.concatenate([near - room, near + room])
        self.camera.frame(points, aspect)
