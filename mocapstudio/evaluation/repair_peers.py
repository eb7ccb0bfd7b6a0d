"""What else would be done about an error: interpolation, smoothing, low rank, Kalman.

All but the two smoothers are told the true spans and change nothing outside them; the smoothers
run over the whole take, as they are used. Rotations are filtered as sign-continuous quaternions
and scaled to unit length.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline
from scipy.signal import butter, savgol_filter, sosfiltfilt
from scipy.spatial.transform import Rotation, RotationSpline

from mocapstudio.evaluation.truth import Array, Mask
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION, carrier
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

Peer = Callable[[Take, tuple[Take, ...], Sequence[Declared]], Take]
"""Repairs a take, given its context and the rows × spans that are wrong."""


@dataclass(frozen=True)
class Family:
    """A method with the settings among which training chooses.

    Parameters
    ----------
    make
        The method; its keyword arguments are the settings.
    grid
        Values to try by setting.
    """

    make: Callable[..., Take]
    grid: Mapping[str, Sequence[Any]]

    def members(self) -> dict[tuple[tuple[str, Any], ...], Peer]:
        """Every combination of settings."""
        names = list(self.grid)
        settings = [tuple(zip(names, v, strict=True)) for v in product(*self.grid.values())]
        return {one: partial(self.make, **dict(one)) for one in settings}


def slerp(take: Take, _: tuple[Take, ...], spans: Sequence[Declared]) -> Take:
    """Shortest way from the frame before to the frame after."""

    def fill(times: Array, values: Array, at: Array) -> Array:
        inner = (len(times) // 2) - 1
        a, b = values[inner], values[inner + 1]
        t = (at - times[inner]) / (times[inner + 1] - times[inner])
        if values.shape[1] == 3:
            return np.asarray(a + t[:, None] * (b - a))
        return rot.slerp(a[None], b[None], t)

    return _filled(take, spans, fill, knots=1, spacing=1)


def spline(
    take: Take, _: tuple[Take, ...], spans: Sequence[Declared], *, knots: int, seconds: float
) -> Take:
    """Cubic spline through frames on both sides: `RotationSpline`, `CubicSpline` for places."""

    def fill(times: Array, values: Array, at: Array) -> Array:
        if values.shape[1] == 3:
            return np.asarray(CubicSpline(times, values)(at))
        return np.asarray(RotationSpline(times, Rotation.from_quat(values))(at).as_quat())

    spacing = max(1, round(seconds * float(take.rate)))
    return _filled(take, spans, fill, knots, spacing)


def savitzky_golay(
    take: Take, _: tuple[Take, ...], __: Sequence[Declared], *, seconds: float, order: int
) -> Take:
    """Savitzky–Golay smoothing of the whole take."""
    window = max(order + 2, round(seconds * float(take.rate))) | 1
    if window > take.frames:
        return take
    return _smoothed(take, lambda x: np.asarray(savgol_filter(x, window, order, axis=0)))


def butterworth(take: Take, _: tuple[Take, ...], __: Sequence[Declared], *, hertz: float) -> Take:
    """Zero-phase Butterworth low-pass of second order over the whole take."""
    if hertz >= 0.5 * float(take.rate):
        return take
    sections = butter(2, hertz, fs=float(take.rate), output="sos")
    pad = min(take.frames - 1, int(take.rate))
    return _smoothed(take, lambda x: np.asarray(sosfiltfilt(sections, x, axis=0, padlen=pad)))


def low_rank(
    take: Take, context: tuple[Take, ...], spans: Sequence[Declared], *, rank: int, noise: float
) -> Take:
    """Fill from the pose's principal components, seams met by a linear offset.

    Probabilistic PCA of the context's poses (of the take's own right frames where there is no
    context), conditioned frame by frame on the joints that are right; after Gløersen and Federolf
    (2016). Root rows are interpolated.
    """
    root = [s for s in spans if s.row in (ROOT_POSITION, ROOT_HEADING)]
    inner = [s for s in spans if s.row in take.skeleton.index]
    result = slerp(take, (), root) if root else take
    joints = topology(take.skeleton).body_joints()
    wrong = np.zeros((take.frames, len(joints)), dtype=bool)
    for one in inner:
        wrong[one.start : one.end, joints.index(take.skeleton.index[one.row])] = True
    sane = ~wrong.any(axis=1)
    mean, basis = (
        _components(context, joints, rank)
        if context
        else _principal(take.rotations[sane][:, list(joints)], rank)
    )
    poses = _signed(take.rotations[:, joints], mean)
    rotations = result.rotations.copy()
    for one in inner:
        at = joints.index(take.skeleton.index[one.row])
        frames = np.arange(max(0, one.start - 1), min(take.frames, one.end + 1), dtype=np.int64)
        unknown = wrong[frames]
        unknown[:, at] = True
        predicted = _conditioned(poses[frames], unknown, at, mean, basis, noise)
        filled = _met(predicted, poses[frames, at], frames, one)
        rotations[one.start : one.end, joints[at]] = filled
    return result.with_motion(rotations)


def kalman(take: Take, _: tuple[Take, ...], spans: Sequence[Declared], *, restless: float) -> Take:
    """Kalman (Rauch–Tung–Striebel) smoothing at constant velocity, the span unobserved.

    `restless` is the variance of the velocity's walk, a second, over that of the observations.
    """
    groups = _channels(take, spans)
    rotations, translations = take.rotations.copy(), take.translations.copy()
    for joint, wrong in groups.items():
        values = take.translations[:, carrier(take)] if joint < 0 else take.rotations[:, joint]
        if joint >= 0:
            # What is wrong may have turned the signs of all that follows.
            values = values.copy()
            values[~wrong] = rot.continuous(values[~wrong])
        smooth = smoothed_states(values, ~wrong, 1.0 / float(take.rate), restless)
        if joint < 0:
            translations[wrong, carrier(take)] = smooth[wrong]
        else:
            rotations[wrong, joint] = rot.normalize(smooth[wrong])
    return take.with_motion(rotations, translations)


PEERS: dict[str, Family] = {
    "slerp": Family(slerp, {}),
    "cubic spline": Family(spline, {"knots": (1, 2, 4), "seconds": (0.04, 0.1, 0.2)}),
    "Savitzky-Golay": Family(savitzky_golay, {"seconds": (0.2, 0.4, 0.8, 1.5), "order": (2, 3)}),
    "Butterworth": Family(butterworth, {"hertz": (0.5, 1.0, 2.0, 4.0, 8.0)}),
    "low rank": Family(low_rank, {"rank": (8, 16, 32), "noise": (0.02, 0.1)}),
    "Kalman": Family(kalman, {"restless": (1e3, 1e5, 1e7, 1e9)}),
}
"""The peers by name, with the settings among which training chooses."""


def smoothed_states(values: Array, seen: Mask, step: float, restless: float) -> Array:
    """(F, D) smoothed positions of D channels that share one model and one mask.

    A constant-velocity Kalman filter and Rauch–Tung–Striebel smoother with observation variance
    1, started without knowledge.
    """
    frames, channels = values.shape
    move = np.array([[1.0, step], [0.0, 1.0]])
    unrest = restless * np.array([[step**3 / 3, step**2 / 2], [step**2 / 2, step]])
    mean, spread = np.zeros((2, channels)), 1e9 * np.eye(2)
    means, spreads = np.empty((frames, 2, channels)), np.empty((frames, 2, 2))
    ahead_means, ahead_spreads = np.empty_like(means), np.empty_like(spreads)
    for i in range(frames):
        if i > 0:
            mean, spread = move @ mean, move @ spread @ move.T + unrest
        ahead_means[i], ahead_spreads[i] = mean, spread
        if seen[i]:
            gain = spread[:, :1] / (spread[0, 0] + 1.0)
            mean = mean + gain * (values[i] - mean[0])
            # Joseph's form: the plain one loses its symmetry from the vague start.
            keep = np.eye(2) - gain @ np.array([[1.0, 0.0]])
            spread = keep @ spread @ keep.T + gain @ gain.T
        means[i], spreads[i] = mean, spread
    for i in range(frames - 2, -1, -1):
        back = np.linalg.solve(ahead_spreads[i + 1], move @ spreads[i]).T
        means[i] = means[i] + back @ (means[i + 1] - ahead_means[i + 1])
    return means[:, 0]


def _filled(
    take: Take,
    spans: Sequence[Declared],
    fill: Callable[[Array, Array, Array], Array],
    knots: int,
    spacing: int,
) -> Take:
    """Fill every span from `knots` right frames on each side; hold where a side is missing."""
    rotations, translations = take.rotations.copy(), take.translations.copy()
    for one in spans:
        joint = _joint(take, one.row)
        track = translations[:, carrier(take)] if joint < 0 else rotations[:, joint]
        before = one.start - 1 - spacing * np.arange(knots)[::-1]
        after = one.end + spacing * np.arange(knots)
        before, after = before[before >= 0], after[after < take.frames]
        at = np.arange(one.start, one.end)
        if not len(before) or not len(after):
            edge = track[after[0]] if len(after) else track[before[-1]]
            track[at] = edge
            continue
        fewer = min(len(before), len(after))
        times = np.concatenate([before[-fewer:], after[:fewer]])
        values = track[times]
        track[at] = fill(times.astype(float), values, at.astype(float))
    return take.with_motion(rotations, translations)


def _smoothed(take: Take, smooth: Callable[[Array], Array]) -> Take:
    rotations = take.rotations.copy()
    joints = list(topology(take.skeleton).body_joints())
    flat = rot.continuous(rotations[:, joints]).reshape(take.frames, -1)
    rotations[:, joints] = rot.normalize(smooth(flat).reshape(take.frames, -1, 4))
    translations = take.translations.copy()
    translations[:, carrier(take)] = smooth(translations[:, carrier(take)])
    return take.with_motion(rotations, translations)


def _joint(take: Take, row: str) -> int:
    """Joint whose rotation a row stands for, -1 for the root's position."""
    if row == ROOT_POSITION:
        return -1
    return topology(take.skeleton).hips if row == ROOT_HEADING else take.skeleton.index[row]


def _channels(take: Take, spans: Sequence[Declared]) -> dict[int, Mask]:
    groups: dict[int, Mask] = {}
    for one in spans:
        mask = groups.setdefault(_joint(take, one.row), np.zeros(take.frames, dtype=bool))
        mask[one.start : one.end] = True
    return groups


@lru_cache(maxsize=32)
def _components(
    context: tuple[Take, ...], joints: tuple[int, ...], rank: int
) -> tuple[Array, Array]:
    step = max(1, round(float(context[0].rate) / 24))
    poses = np.concatenate([t.rotations[::step][:, list(joints)] for t in context])
    return _principal(poses, rank)


def _principal(poses: Array, rank: int) -> tuple[Array, Array]:
    """Mean pose (m, 4), and (4 m, rank) principal directions scaled by their deviation."""
    mean = rot.mean(poses)
    away = (_signed(poses, mean) - mean).reshape(len(poses), -1)
    _, size, directions = np.linalg.svd(away, full_matrices=False)
    scaled = directions[:rank].T * size[:rank] / np.sqrt(max(1, len(poses) - 1))
    return mean, np.asarray(scaled)


def _signed(poses: Array, mean: Array) -> Array:
    return np.where(np.sum(poses * mean, axis=-1, keepdims=True) < 0, -poses, poses)


def _conditioned(
    poses: Array, unknown: Mask, at: int, mean: Array, basis: Array, noise: float
) -> Array:
    """(n, 4) expected rotation of joint `at` given the known joints of each frame."""
    predicted = np.empty((len(poses), 4))
    for i, (pose, hidden) in enumerate(zip(poses, unknown, strict=True)):
        known = np.repeat(~hidden, 4)
        w = basis[known]
        away = (pose - mean).reshape(-1)[known]
        z = np.linalg.solve(w.T @ w + noise**2 * np.eye(w.shape[1]), w.T @ away)
        predicted[i] = mean[at] + basis[4 * at : 4 * at + 4] @ z
    return rot.normalize(predicted)


def _met(predicted: Array, track: Array, frames: NDArray[np.int64], span: Declared) -> Array:
    """Turn a prediction to meet the track just outside the span, and cut it to the span."""
    before, after = frames[0] < span.start, frames[-1] >= span.end
    left = rot.multiply(track[0], rot.conjugate(predicted[0])) if before else rot.IDENTITY
    right = rot.multiply(track[-1], rot.conjugate(predicted[-1])) if after else rot.IDENTITY
    t = np.linspace(0.0, 1.0, len(frames))
    turned = rot.multiply(rot.slerp(left[None], right[None], t), predicted)
    return turned[span.start - frames[0] : span.end - frames[0]]
