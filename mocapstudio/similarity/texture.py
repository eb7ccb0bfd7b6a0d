"""The motion-texture: joints x frames of rotations, as paper 1 compares them (section 3.1)."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError, SkeletonMismatchError
from mocapstudio.motion.facing import hips_world, split_heading
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

F32 = NDArray[np.float32]

TEXTURE_RATE = 24
TRAVEL = ("forward", "sideways", "height", "clearance", "slide")


@dataclass(frozen=True, eq=False)
class MotionTexture:
    """A take at 24 fps without its place in the world.

    Parameters
    ----------
    joints
        Names of the m joints.
    quaternions
        (T, m, 4) float32 local rotations, sign-continuous; of the hips only the tilt, the facing
        direction removed.
    travel
        (T, 5) float32, see `TRAVEL`: forward and sideways speed of the hips (m/s, in the body's
        facing) and their height (m); height of the lowest foot (m) and speed of the slowest one
        (m/s), which hardly vary while a foot stands.
    turning
        (T,) float32: turning rate of the heading, rad/s.
    start
        First frame of the take that the texture covers.
    frames_each
        Frames of the take for one texture frame (rate / 24).
    """

    joints: tuple[str, ...]
    quaternions: F32
    travel: F32
    turning: F32
    start: int
    frames_each: float

    def __len__(self) -> int:
        return len(self.quaternions)

    @cached_property
    def planes(self) -> F32:
        """(m, 4, T) contiguous copy of the quaternions, time last: what the kernels search."""
        return np.ascontiguousarray(self.quaternions.transpose(1, 2, 0))

    @cached_property
    def digest(self) -> bytes:
        """SHA-256 of the joints' names and rotations."""
        names = "\n".join(self.joints).encode()
        return hashlib.sha256(names + b"\0" + self.quaternions.tobytes()).digest()

    def frame(self, position: float) -> float:
        """Frame of the take, fractional, at a texture position."""
        return self.start + position * self.frames_each


@dataclass(frozen=True, eq=False)
class BodyMotion:
    """The trimmed span of a take at its own rate: body apart from its place in the world.

    Parameters
    ----------
    joints
        Names of the m joints.
    rotations
        (F, m, 4) local rotations, sign-continuous; of the hips the rotation without heading.
    heading
        (F,) radians about +Y, unwrapped; 0 faces +Z.
    position
        (F, 3) metres: the hips in the world.
    rate
        Frames a second.
    start
        The take's frame that is the first here.
    chains
        For each foot its joints from the hips outward: column in `rotations` and offset (3,).
    """

    joints: tuple[str, ...]
    rotations: NDArray[np.float64]
    heading: NDArray[np.float64]
    position: NDArray[np.float64]
    rate: float
    start: int
    chains: tuple[tuple[tuple[int, NDArray[np.float64]], ...], ...] = ()

    def __len__(self) -> int:
        return len(self.rotations)

    @cached_property
    def feet(self) -> NDArray[np.float64]:
        """(F, n, 3) metres: the feet in the world; (F, 1, 3) the hips where there are none."""
        turn = rot.about_axis(1, self.heading)
        places = [self.position]
        for chain in self.chains:
            place, world = self.position, turn
            for column, offset in chain:
                place = place + rot.rotate(world, offset[None])
                world = rot.multiply(world, self.rotations[:, column])
            places.append(place)
        return np.stack(places[1:] or places, axis=1)

    @cached_property
    def slide(self) -> NDArray[np.float64]:
        """(F,) m/s: horizontal speed of the slowest foot."""
        steps = np.gradient(self.feet[..., [0, 2]], axis=0) * self.rate
        return np.asarray(np.linalg.norm(steps, axis=-1).min(axis=1))


def body_motion(take: Take, joints: Sequence[str]) -> BodyMotion:
    """Take the body's motion and its place apart; every joint must exist in the take."""
    first, last = take.span
    heading, tilt = split_heading(take, first, last)
    position, _ = hips_world(take, first, last)
    columns = [take.skeleton.index[name] for name in joints]
    local = take.rotations[first:last, columns]
    hips = topology(take.skeleton).hips
    if hips in columns:
        local = local.copy()
        local[:, columns.index(hips)] = rot.continuous(tilt)
    chains = _foot_chains(take.skeleton, tuple(joints))
    return BodyMotion(tuple(joints), local, heading, position, float(take.rate), first, chains)


def _foot_chains(
    skeleton: Skeleton, joints: tuple[str, ...]
) -> tuple[tuple[tuple[int, NDArray[np.float64]], ...], ...]:
    """Chains from the hips to the last two compared joints of every leg."""
    parts = topology(skeleton)
    column = {skeleton.index[name]: i for i, name in enumerate(joints)}
    chains = []
    for limb in parts.limbs:
        feet = [j for j in limb.joints if j in column][-2:] if limb.name.endswith("leg") else []
        for foot in feet:
            above = [j for j in reversed(skeleton.ancestors(foot)) if j in column]
            if parts.hips not in above:
                continue
            offsets = [np.zeros(3), *(skeleton.offsets[j] for j in (*above[1:], foot))]
            chains.append(tuple(zip([column[j] for j in (*above, foot)], offsets, strict=True)))
    return tuple(chains)


def texture_of(motion: BodyMotion) -> MotionTexture:
    """Sample a body's motion at 24 fps.

    Raises
    ------
    MocapError
        If it is shorter than two frames at 24 fps.
    """
    each = motion.rate / TEXTURE_RATE
    count = int((len(motion) - 1) / each + 1e-6) + 1
    if count < 2:
        raise MocapError(f"{len(motion)} frames are too short to analyse")
    at = np.arange(count, dtype=np.float64) * each
    quaternions = rot.continuous(_sample_rotations(motion.rotations, at))
    heading, position = _sample(motion.heading, at), _sample(motion.position, at)
    velocity = np.gradient(position, axis=0) * TEXTURE_RATE
    sine, cosine = np.sin(heading), np.cos(heading)
    forward = velocity[:, 0] * sine + velocity[:, 2] * cosine
    sideways = velocity[:, 0] * cosine - velocity[:, 2] * sine
    clearance = _sample(motion.feet[..., 1].min(axis=1), at)
    travel = [forward, sideways, position[:, 1], clearance, _sample(motion.slide, at)]
    return MotionTexture(
        motion.joints,
        np.ascontiguousarray(quaternions, dtype=np.float32),
        np.stack(travel, axis=-1).astype(np.float32),
        (np.gradient(heading) * TEXTURE_RATE).astype(np.float32),
        motion.start,
        each,
    )


@lru_cache(maxsize=256)
def motion_texture(take: Take, joints: tuple[str, ...]) -> MotionTexture:
    """Sample the trimmed span of a take at 24 fps and remove the facing direction of its hips.

    Raises
    ------
    MocapError
        If the trimmed span is shorter than two frames at 24 fps.
    """
    try:
        return texture_of(body_motion(take, joints))
    except MocapError as error:
        raise MocapError(f"{take.name}: {error}") from None


def comparable_joints(take: Take, context: Sequence[Take]) -> tuple[str, ...]:
    """Names of the take's body joints that every take of the context has too, in skeleton order.

    Raises
    ------
    SkeletonMismatchError
        If a take of the context lacks half of them or more.
    """
    names = [take.skeleton.names[j] for j in topology(take.skeleton).body_joints()]
    common = list(names)
    for other in context:
        missing = [name for name in names if name not in other.skeleton.index]
        if 2 * len(missing) >= len(names):
            raise SkeletonMismatchError(
                f"{other.source.path if other.source else other.name}: -: another skeleton:"
                f" {len(missing)} of {len(names)} joints of {take.name} have no namesake"
            )
        common = [name for name in common if name in other.skeleton.index]
    return tuple(common)


def _split(at: NDArray[np.float64], frames: int) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    low = np.minimum(at.astype(np.int64), max(frames - 2, 0))
    return low, at - low


def _sample(values: NDArray[np.float64], at: NDArray[np.float64]) -> NDArray[np.float64]:
    low, part = _split(at, len(values))
    part = part.reshape(-1, *[1] * (values.ndim - 1))
    return values[low] * (1.0 - part) + values[low + 1] * part


def _sample_rotations(q: NDArray[np.float64], at: NDArray[np.float64]) -> NDArray[np.float64]:
    """Interpolate on the chord: neighbouring frames are close, so this is slerp to 1e-4 rad."""
    low, part = _split(at, len(q))
    a, b = q[low], q[low + 1]
    b = np.where(np.sum(a * b, axis=-1, keepdims=True) < 0, -b, b)
    part = part[:, None, None]
    return rot.normalize(a * (1.0 - part) + b * part)
