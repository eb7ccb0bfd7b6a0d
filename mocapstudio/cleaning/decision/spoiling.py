"""Errors put into the context's own motion, so that the decision learns what errors look like.

Written apart from those of the benchmark: what is learnt must hold for errors nobody has drawn up.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.decision import shapes
from mocapstudio.motion import rotations as rot
from mocapstudio.similarity.texture import TEXTURE_RATE, BodyMotion

Array = NDArray[np.float64]
I64 = NDArray[np.int64]
Labels = NDArray[np.int8]

ERRONEOUS = np.deg2rad(10.0)
_DOUBTFUL = np.deg2rad(4.0)
_ERRONEOUS_METRES, _DOUBTFUL_METRES = 0.02, 0.008
_SECONDS_AN_ERROR = 2.5
_LEAST_JITTER_RATE = 26.0


@dataclass(frozen=True, eq=False)
class Anatomy:
    """Which joints belong together.

    Parameters
    ----------
    limb
        (m,) which limb each joint belongs to, joints of a limb in order from the trunk.
    mirror
        (m,) each joint's partner on the other side, or itself.
    """

    limb: I64
    mirror: I64


def spoil(
    motion: BodyMotion, anatomy: Anatomy, rng: np.random.Generator
) -> tuple[BodyMotion, Labels]:
    """Put several errors into a motion.

    Returns
    -------
    spoilt
        The motion with errors.
    label
        (F, m + 2) for joints, root position and root heading: 1 where it is erroneous (over 10
        degrees, over 2 cm, or inside a pop or jitter), 0 where it is as it was, -1 between.
    """
    work = _Work(motion, anatomy, rng)
    for _ in range(max(1, round(len(motion) / motion.rate / _SECONDS_AN_ERROR))):
        kind = list(_KINDS)[int(rng.choice(len(_KINDS), p=_SHARES))]
        if kind == "jitter" and motion.rate < _LEAST_JITTER_RATE:
            continue
        length = work.length(kind)
        if length + 4 < len(motion):
            work.start = int(rng.integers(1, len(motion) - length - 1))
            work.end = work.start + length
            _KINDS[kind](work, kind)
    return work.spoilt(), work.labels()


class _Work:
    """A motion being spoilt: its samples, and the span that the next error takes."""

    def __init__(self, motion: BodyMotion, anatomy: Anatomy, rng: np.random.Generator) -> None:
        self.motion, self.anatomy, self.rng = motion, anatomy, rng
        self.q = motion.rotations.copy()
        self.heading, self.position = motion.heading.copy(), motion.position.copy()
        self.certain = np.zeros((len(motion), len(anatomy.limb) + 2), dtype=bool)
        self.start = self.end = 0

    @property
    def span(self) -> slice:
        return slice(self.start, self.end)

    def own(self, frames24: float) -> float:
        return frames24 * self.motion.rate / TEXTURE_RATE

    def length(self, kind: str) -> int:
        if kind in ("pop", "root pop"):
            return int(self.rng.integers(1, 4))
        low, high = shapes.LENGTHS.get(kind, shapes.USUAL_LENGTHS)
        return max(1, round(self.own(self.rng.uniform(low, high))))

    def spoilt(self) -> BodyMotion:
        return replace(
            self.motion,
            rotations=rot.continuous(self.q),
            heading=self.heading,
            position=self.position,
        )

    def labels(self) -> Labels:
        clean = self.motion
        away = rot.angle(self.q, clean.rotations)
        turned = np.abs(self.heading - clean.heading)
        moved = np.linalg.norm(self.position - clean.position, axis=1)
        parts = [
            _label(away, ERRONEOUS, _DOUBTFUL),
            _label(moved[:, None], _ERRONEOUS_METRES, _DOUBTFUL_METRES),
            _label(turned[:, None], ERRONEOUS, _DOUBTFUL),
        ]
        return np.where(self.certain, 1, np.hstack(parts)).astype(np.int8)


def _label(away: Array, erroneous: float, doubtful: float) -> Labels:
    return np.where(away > erroneous, 1, np.where(away > doubtful, -1, 0)).astype(np.int8)


def _some_joints(work: _Work, kind: str) -> I64:
    limb, rng = work.anatomy.limb, work.rng
    joint = int(rng.integers(len(limb)))
    if kind == "limb" or (kind in ("freeze", "gap") and rng.random() < 0.35):
        members = np.flatnonzero(limb == limb[joint])
        first = int(rng.integers(max(len(members) - 1, 1)))
        return members[first : first + int(rng.integers(2, 5))]
    return np.array([joint])


def _turn(work: _Work, kind: str) -> None:
    n, rng = work.end - work.start, work.rng
    degrees = rng.uniform(80, 180) if kind == "flip" else 10.0 * np.exp(rng.uniform(0.05, 2.08))
    envelope = shapes.envelope(kind, n, work.own(1.0), rng)
    for joint in _some_joints(work, kind):
        if kind in ("noise", "jitter"):
            vector = shapes.noise(kind, n, work.motion.rate, rng) * envelope[:, None]
        else:
            vector = shapes.axis(n, rng) * envelope[:, None]
        turn = rot.from_rotation_vector(np.deg2rad(degrees) * vector)
        now = work.q[work.span, joint]
        first, second = (now, turn) if rng.random() < 0.5 else (turn, now)
        work.q[work.span, joint] = rot.multiply(first, second)
        if kind in ("pop", "jitter"):
            work.certain[work.span, joint] = True


def _hold(work: _Work, kind: str) -> None:
    """Freeze joints, or lead them straight across the span."""
    joints, n, rng = _some_joints(work, kind), work.end - work.start, work.rng
    now = work.q[work.span][:, joints]
    before = work.q[work.start - 1, joints]
    keep = np.ones(n)
    if kind == "gap":
        t = np.arange(1, n + 1, dtype=np.float64) / (n + 1.0)
        t = t * t * (3 - 2 * t) if rng.random() < 0.4 else t
        held = rot.slerp(before[None], work.q[work.end, joints][None], t[:, None])
    else:
        held = np.broadcast_to(before, now.shape)
        tail = min(n, max(1, round(work.own(rng.uniform(0.2, 6.0)))))
        keep[n - tail :] = np.linspace(1.0, 0.0, tail + 2)[1:-1]
    work.q[work.span, joints] = rot.slerp(now, held, keep[:, None])


def _swap(work: _Work, kind: str) -> None:
    """Exchange two sides: mirrored in a plane of the joints' frames, or as they are."""
    limb, mirror, rng = work.anatomy.limb, work.anatomy.mirror, work.rng
    sided = np.flatnonzero(mirror != np.arange(len(mirror)))
    if not len(sided):
        return
    members = np.flatnonzero(limb == limb[int(rng.choice(sided))])
    members = members[mirror[members] != members]
    joints = members[int(rng.integers(2)) :] if len(members) > 2 else members
    a, b = work.q[work.span][:, joints], work.q[work.span][:, mirror[joints]]
    if rng.random() < 0.7:
        flip = np.ones(4)
        flip[[[1, 2], [0, 2], [0, 1]][int(rng.integers(3))]] = -1.0
        a, b = a * flip, b * flip
    work.q[work.span, joints], work.q[work.span, mirror[joints]] = b, a


def _root(work: _Work, kind: str) -> None:
    n, rng = work.end - work.start, work.rng
    shape = {"height drift": "drift", "root pop": "pop", "heading flip": "flip"}[kind]
    envelope = shapes.envelope(shape, n, work.own(1.0), rng)
    sign = 1.0 if rng.random() < 0.5 else -1.0
    if kind == "heading flip":
        work.heading[work.span] += sign * np.deg2rad(rng.uniform(40, 180)) * envelope
        return
    metres = 0.025 * np.exp(rng.uniform(0.0, 2.5))
    direction = np.array([0.0, sign, 0.0])
    if kind == "root pop":
        direction = rng.standard_normal(3)
        direction /= np.linalg.norm(direction)
    work.position[work.span] += metres * envelope[:, None] * direction
    if kind == "root pop":
        work.certain[work.span, -2] = True


_KINDS: dict[str, Callable[[_Work, str], None]] = {
    "spike": _turn, "offset": _turn, "noise": _turn, "drift": _turn, "flip": _turn,
    "limb": _turn, "pop": _turn, "jitter": _turn,
    "freeze": _hold, "gap": _hold,
    "swap": _swap,
    "root pop": _root, "height drift": _root, "heading flip": _root,
}  # fmt: skip
_SHARES = np.array([1.0, 1.6, 1.0, 1.6, 0.8, 1.0, 1.0, 0.8, 1.8, 1.8, 0.8, 1.4, 1.4, 1.0])
_SHARES /= _SHARES.sum()
