"""What joints should do, given all others over a second around: a local linear model.

The Gaussian of stacked poses (see `cleaning.decision.gaussian`), of the context and with more
weight of the take itself, conditioned on the joints that are right; paper 2's linear models of
neighbours, with the whole context as neighbours.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.decision.gaussian import OFFSETS
from mocapstudio.cleaning.repair.material import WALK, Material, frames_each, sampled_stack
from mocapstudio.motion import rotations as rot

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]
Mask = NDArray[np.bool_]

OWN_WEIGHT = 10.0
"""How much more a frame of the take itself counts than one of its context."""
_RIDGE = np.deg2rad(2.5) ** 2
_LEAST = 24
_FAR = 2.5


@dataclass(frozen=True, eq=False)
class Prediction:
    """Rotations of unknown joints that the other joints let expect, over the trimmed span.

    Parameters
    ----------
    rotations
        (F', u, 4).
    residuals
        (F', u, 3) rotation vectors from the prediction to the take, radians.
    """

    rotations: F64
    residuals: F64


@dataclass(frozen=True, eq=False)
class Regression:
    """Predictor of unknown joints from all joints that are right around a span.

    Parameters
    ----------
    material
        What is known.
    unknown
        Columns of the unknown joints.
    span
        Half-open span in frames of `material.motion`.
    """

    material: Material
    unknown: tuple[int, ...]
    span: tuple[int, int]

    @cached_property
    def known(self) -> I64:
        """Columns of one pose that may be drawn on: what is right all around the span."""
        material, (start, end) = self.material, self.span
        reach = int(np.ceil(max(OFFSETS) * frames_each(material))) + 1
        wrong = np.any(material.wrong[max(start - reach, 0) : end + reach], axis=0)
        joints = len(material.joints)
        there = ~wrong[:joints]
        there[list(self.unknown)] = False
        walk = np.full(WALK, not wrong[joints:].any())
        return np.flatnonzero(np.concatenate([np.repeat(there, 3), walk]))

    @cached_property
    def stack(self) -> F64:
        """(F', d) stacked values of the take at its own rate."""
        frames = np.arange(len(self.material.motion), dtype=np.float64)
        return sampled_stack(self.material.values, frames_each(self.material), frames)

    @cached_property
    def right(self) -> Mask:
        """(F',) frames of the take to learn from: neither inputs nor targets are wrong there."""
        material = self.material
        joints = len(material.joints)
        walk = material.wrong[:, joints:].any(axis=1, keepdims=True)
        inner = np.repeat(material.wrong[:, :joints], 3, axis=1)
        wrong = np.asarray(np.hstack([inner, walk.repeat(WALK, 1)]), dtype=np.bool_)
        near = np.asarray(np.any(wrong[:, self.known], axis=1), dtype=np.float64)[:, None]
        frames = np.arange(len(near), dtype=np.float64)
        touched = np.any(sampled_stack(near, frames_each(material), frames), axis=1)
        return np.asarray(~wrong[:, self._targets].any(axis=1) & ~touched)

    @cached_property
    def pace(self) -> F64:
        """(F',) how fast the known joints move, radians a frame all together."""
        values = self.material.values[:, self.known]
        speed = np.linalg.norm(np.gradient(values, axis=0), axis=1)
        return np.asarray(np.maximum(speed, 1e-6))

    def predict(self) -> Prediction | None:
        """Predict over the whole trimmed span; None where there is nothing to learn from."""
        slopes = self._learnt(self.right)
        return None if slopes is None else self._prediction(self._applied(slopes))

    def predict_unseen(self, folds: int = 2) -> Prediction | None:
        """Predict each part of the take without having learnt from that part.

        None where there is nothing to learn from. Parts are stretches of the take, `folds` of
        them.
        """
        frames = len(self.right)
        part = np.arange(frames) * folds // frames
        vectors = np.empty((frames, 3 * len(self.unknown)))
        for fold in range(folds):
            here = part == fold
            slopes = self._learnt(self.right & ~here)
            if slopes is None:
                return None
            vectors[here] = self._applied(slopes)[here]
        return self._prediction(vectors)

    def _learnt(self, right: Mask) -> tuple[F64, F64, F64] | None:
        """Mean inputs, mean targets and slopes, from the context and the right frames."""
        chosen = np.flatnonzero(right)[:: max(1, round(frames_each(self.material)))]
        inputs = self._inputs
        if not len(inputs) or (len(chosen) < _LEAST and self.material.known is None):
            return None
        columns = np.concatenate([inputs, self._targets])
        sample = self.stack[np.ix_(chosen, columns)]
        count = OWN_WEIGHT * len(chosen)
        total, outer = OWN_WEIGHT * sample.sum(axis=0), OWN_WEIGHT * (sample.T @ sample)
        known = self.material.known
        if known is not None:
            count += known.count
            total = total + known.total[columns]
            outer = outer + known.outer[np.ix_(columns, columns)]
        mean = total / count
        covariance = outer / count - np.outer(mean, mean)
        n = len(inputs)
        square = covariance[:n, :n] + _RIDGE * np.eye(n)
        slopes = np.linalg.solve(square, covariance[:n, n:])
        return mean[:n], mean[n:], slopes

    def _applied(self, learnt: tuple[F64, F64, F64]) -> F64:
        given, wanted, slopes = learnt
        return np.asarray((self.stack[:, self._inputs] - given) @ slopes + wanted)

    def constant(self) -> Prediction:
        """Predict the mean pose: what is left then is interpolated as it is."""
        return self._prediction(np.zeros((len(self.material.motion), 3 * len(self.unknown))))

    def _prediction(self, vectors: F64) -> Prediction:
        vectors = vectors.reshape(len(vectors), -1, 3)
        columns = list(self.unknown)
        centre = self.material.centre[columns]
        rotations = rot.multiply(centre, rot.from_rotation_vector(vectors))
        actual = self.material.motion.rotations[:, columns]
        away = rot.to_rotation_vector(rot.multiply(rot.conjugate(rotations), actual))
        for i, column in enumerate(columns):
            if np.linalg.norm(away[:, i], axis=1).max() > _FAR:
                away[:, i] = unwrapped(away[:, i], ~self.material.wrong[:, column])
        return Prediction(rotations, away)

    @cached_property
    def _inputs(self) -> I64:
        width = self.material.values.shape[1]
        return np.concatenate([self.known + width * i for i in range(len(OFFSETS))])

    @cached_property
    def _targets(self) -> I64:
        return np.concatenate([3 * j + np.arange(3) for j in self.unknown])


def unwrapped(vectors: F64, right: Mask) -> F64:
    """Rotation vectors (F, 3) of the same rotations that run on where they pass half a turn.

    Each is that nearest to the right one before it, so that joints which turn round and round can
    be interpolated.
    """
    result, before = vectors.copy(), vectors[int(np.argmax(right))]
    for i, vector in enumerate(vectors):
        angle = float(np.linalg.norm(vector))
        if angle > 1e-9:
            axis = vector / angle
            turns = round((float(axis @ before) - angle) / (2.0 * np.pi))
            result[i] = vector + 2.0 * np.pi * turns * axis
        if right[i]:
            before = result[i]
    return result
