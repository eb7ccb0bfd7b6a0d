"""Dragging an end effector: a preview of the current frame, and an edit on release.

The frame that was dragged looks after the release exactly as it did before: what it departs by
fades out in time around it, and points that were pinned stay where they were at every frame.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.contacts.anatomy import leg_length
from mocapstudio.cleaning.contacts.model import ContactPoint
from mocapstudio.cleaning.ik.apply import Departure, declared_changes, with_departures
from mocapstudio.cleaning.ik.easing import falloff
from mocapstudio.cleaning.ik.freedom import Freedom, chain, freedom
from mocapstudio.cleaning.ik.objectives.key_pose import KeyPose
from mocapstudio.cleaning.ik.objectives.orientation import Orientation
from mocapstudio.cleaning.ik.objectives.over_time import KeepPose
from mocapstudio.cleaning.ik.objectives.position import PointAtTarget
from mocapstudio.cleaning.ik.objectives.rows import Objective
from mocapstudio.cleaning.ik.posed import Posed, Window, window
from mocapstudio.cleaning.ik.ranges import JointRanges, joint_ranges
from mocapstudio.cleaning.ik.solve import Problem, solve
from mocapstudio.cleaning.ik.windows import range_limit, smooth
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

Array = NDArray[np.float64]

_PULL = 1e3
"""Per metre, of the point that is dragged."""
_PIN = 5e3
_FARTHEST = 0.25
"""Metres: from farther away the point is pulled as hard as from here, so that what is out of reach
turns the limb there instead of tearing at it."""
_LIMIT = 10.0
_TURN = 2.0
_KEY = 1e5
_TRUNK_DRAGGED, _LIMB_DRAGGED = np.full(3, 3.0), np.full(3, 20.0)
"""Stiffness of the body's place, per metre: the trunk comes along before it bends, a limb is
stretched before the body follows."""
_MOST_STEPS = 10
_TOLERANCE = 1e-5
_RELEASE_STEPS = 15


@dataclass(frozen=True, eq=False)
class DragPose:
    """What the body looks like while something is dragged.

    Attributes
    ----------
    take
        A take of the one frame.
    point
        (3,) metres: where the dragged point got to.
    gap
        Metres that it stays short of where it was dragged; 0 within reach.
    """

    take: Take
    point: Array
    gap: float


@dataclass(frozen=True, eq=False)
class DragResult:
    """The edit that a drag became.

    Attributes
    ----------
    take
        The take with the edit.
    declared
        Joints × spans that changed.
    """

    take: Take
    declared: tuple[Declared, ...]


@dataclass(frozen=True, eq=False)
class KeptFrame:
    """A frame as it was dragged.

    Attributes
    ----------
    frame
        Of the take.
    departure
        (n,) what it departs by from the take, see `Freedom`.
    """

    frame: int
    departure: Array


class Drag:
    """One drag, from press to release.

    Parameters
    ----------
    take
        F frames.
    frame
        The frame that is shown.
    point
        What is dragged.
    along
        Points that are to go with it, such as the ball with the heel of a foot.
    pins
        Points that stay where they are, such as the feet while the hips are dragged.
    whole_body
        Whether the trunk may follow a hand or foot. Dragging the trunk itself always moves the
        body.
    ranges
        How far joints turn; by default learnt from the take.

    Raises
    ------
    MocapError
        If the frame lies outside the take or a joint is unknown.
    """

    def __init__(
        self,
        take: Take,
        frame: int,
        point: ContactPoint,
        *,
        along: Sequence[ContactPoint] = (),
        pins: Sequence[ContactPoint] = (),
        whole_body: bool = False,
        ranges: JointRanges | None = None,
    ) -> None:
        if not 0 <= frame < take.frames:
            raise MocapError(f"{take.name} has no frame {frame}")
        self._take, self._frame, self._point = take, frame, point
        self._ranges = ranges or joint_ranges([take])
        self._joint = _index(take, point)
        self._along = [(one, _index(take, one)) for one in along]
        self._pins = [(pin, _index(take, pin)) for pin in pins if pin.key != point.key]
        self._free = self._freedom(whole_body)
        self._view, self._wishes = self._laid(frame, frame + 1)
        self._unknowns = np.zeros((1, self._free.size))

    @property
    def kept(self) -> KeptFrame:
        """The frame as it looks now."""
        return KeptFrame(self._frame, self._unknowns[0].copy())

    def to(self, target: Array, along: Sequence[Array | None] = ()) -> DragPose:
        """Pose the frame with the dragged point at `target` (3,) metres, or as near as it gets.

        Parameters
        ----------
        along
            (3,) metres for each of the points that go along, or None where it goes as it likes.
        """
        goal = np.asarray(target, dtype=float)
        pulls = [self._pull(self._point, self._joint, goal)]
        for (point, joint), place in zip(self._along, along, strict=bool(along)):
            if place is not None:
                pulls.append(self._pull(point, joint, place))
        keep = KeepPose(1, self._free.stiffness)
        problem = Problem(self._view, self._free, [*pulls, *self._wishes], [keep])
        solution = solve(problem, self._unknowns, _MOST_STEPS, _TOLERANCE)
        self._unknowns = solution.unknowns
        posed = problem.posed(self._unknowns)
        point = posed.point(self._joint, self._point.offset)[0]
        one = _frame_of(self._take, self._frame)
        shown = with_departures(one, [Departure((0, 1), problem, self._unknowns)])
        gap = float(np.linalg.norm(point - goal))
        return DragPose(shown, point, gap if gap > 1e-3 else 0.0)

    def _pull(self, point: ContactPoint, joint: int, goal: Array) -> PointAtTarget:
        now = Posed(self._view, self._free, self._unknowns).point(joint, point.offset)
        share = _FARTHEST / max(float(np.linalg.norm(goal - now[0])), _FARTHEST)
        near = now + share * (goal - now)
        return PointAtTarget(joint, point.offset, np.array([0]), near, _PULL, np.eye(3))

    def release(self, seconds: float) -> DragResult:
        """Spread what was dragged over `seconds` before and after the frame."""
        reach = max(1, round(seconds * float(self._take.rate)))
        start = max(0, self._frame - reach)
        end = min(self._take.frames, self._frame + reach + 1)
        at = self._frame - start
        wanted = falloff(end - start, at, reach)[:, None] * self._unknowns
        view, wishes = self._laid(start, end)
        keep = KeepPose(end - start, self._free.stiffness, wanted)
        problem = Problem(view, self._free, wishes, [keep])
        unknowns = wanted
        if self._pins:
            key = KeyPose(at, self._unknowns[0], _KEY)
            _, ease = smooth(self._take, self._free, (start, end), seconds)
            problem = Problem(view, self._free, [key, *wishes], [keep, ease])
            unknowns = solve(problem, wanted, _RELEASE_STEPS).unknowns
            unknowns[at] = self._unknowns[0]
        departure = Departure((start, end), problem, unknowns)
        return DragResult(
            with_departures(self._take, [departure]), declared_changes(self._take, [departure])
        )

    def _freedom(self, whole_body: bool) -> Freedom:
        skeleton = self._take.skeleton
        parts = topology(skeleton)
        dragged = {self._joint, *(joint for _, joint in self._along)}
        joints = {j for one in dragged for j in chain(skeleton, one, self._ranges)}
        trunk = next(limb.joints for limb in parts.limbs if limb.name == "spine")
        moves = whole_body or self._joint in trunk
        if moves:
            joints.update(j for j in trunk if not self._ranges.rigid[j])
        if moves or joints & set(trunk):
            joints.update(j for _, pin in self._pins for j in chain(skeleton, pin, self._ranges))
        if self._joint == parts.hips:
            joints.difference_update(trunk)
        reach = leg_length(skeleton) if moves else 0.0
        place = _TRUNK_DRAGGED if self._joint in trunk else _LIMB_DRAGGED
        return freedom(joints - parts.above_hips, self._ranges, reach=reach, place_stiffness=place)

    def _laid(self, start: int, end: int) -> tuple[Window, list[Objective]]:
        """Cut the frames [start, end); state what holds in them whatever is dragged."""
        ends = [self._joint, *(joint for _, joint in (*self._along, *self._pins))]
        view = window(self._take, start, end, [*ends, *self._free.joints])
        asis = Posed(view, self._free, np.zeros((end - start, self._free.size)))
        frames = np.arange(end - start)
        wishes: list[Objective] = [
            PointAtTarget(joint, pin.offset, frames, asis.point(joint, pin.offset), _PIN, np.eye(3))
            for pin, joint in self._pins
        ]
        wishes += [
            Orientation(
                joint, frames, asis.rotations[:, asis.at(joint)].copy(), np.full(len(frames), _TURN)
            )
            for joint in sorted(set(ends))
        ]
        span = (start, end)
        wishes += [
            range_limit(self._take, j, span, self._ranges, _LIMIT) for j in self._free.joints
        ]
        return view, wishes


def _index(take: Take, point: ContactPoint) -> int:
    if point.joint not in take.skeleton.index:
        raise MocapError(f"{take.name} has no joint {point.joint}")
    return take.skeleton.index[point.joint]


def _frame_of(take: Take, frame: int) -> Take:
    return replace(
        take,
        rotations=take.rotations[frame : frame + 1],
        translations=take.translations[frame : frame + 1],
        trim=None,
        first_frame=take.first_frame + frame,
    )
