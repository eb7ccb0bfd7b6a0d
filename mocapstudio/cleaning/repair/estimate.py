"""The best guess of unknown joints over a span: predicted by the others, joined to both flanks.

How much the prediction counts beside mere interpolation is decided by evidence, joint by joint:
both are tried on stretches of the same length and liveliness where the truth is known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.repair import kriging
from mocapstudio.cleaning.repair.kriging import OF_MOTION, OF_PREDICTED, Kernel
from mocapstudio.cleaning.repair.material import Material
from mocapstudio.cleaning.repair.regression import Prediction, Regression
from mocapstudio.motion import rotations as rot

F64 = NDArray[np.float64]
Mask = NDArray[np.bool_]

Span = tuple[int, int]

_TRIALS = 16
_TRIAL_SECONDS = 0.5
_PRIOR_TRIALS = 2.0
_LEAST_TRIALS = 4
_AS_LIVELY = 0.3
_AS_IT_IS = np.deg2rad(1.0)
_USUAL_TIMES = 2.0


@dataclass(frozen=True, eq=False)
class Estimate:
    """Rotations of one unknown joint over its span.

    Parameters
    ----------
    rotations
        (n, 4).
    share
        How much the other joints tell of it, 0..1; the rest is interpolation between the flanks.
    usual
        (n,) radians by which each frame was missed in trials; 0 where there were none.
    """

    rotations: F64
    share: float
    usual: F64


def estimate(
    material: Material, unknown: Sequence[int], spans: Sequence[Span], pad: int = 0
) -> list[Estimate]:
    """Guess the rotations of joints that are unknown together, each over its own span.

    Parameters
    ----------
    material
        What is known.
    unknown
        Columns of the joints.
    spans
        Half-open, in frames of `material.motion`, one a joint.
    pad
        How many frames at both ends of a span may be right after all: they stay as they are
        where they are as near to the guess as the truth usually is.
    """
    whole = min(start for start, _ in spans), max(end for _, end in spans)
    regression = Regression(material, tuple(unknown), whole)
    flat, predicted = regression.constant(), regression.predict()
    unseen = regression.predict_unseen() if predicted is not None else None
    found = []
    for i, (column, span) in enumerate(zip(unknown, spans, strict=True)):
        guess = _Guess(flat, predicted, unseen, i, material.motion.rate, regression.pace)
        usable = ~material.wrong[:, column]
        usable[slice(*span)] = False
        first = guess.over(span, usable)
        actual = material.motion.rotations[slice(*span), column]
        away = rot.angle(first.rotations, actual)
        fits = away < np.maximum(_AS_IT_IS, _USUAL_TIMES * first.usual)
        inner = _narrowed(fits, span, pad)
        if inner == span:
            found.append(first)
            continue
        usable[span[0] : inner[0]] = usable[inner[1] : span[1]] = True
        again, rotations = guess.over(inner, usable), actual.copy()
        rotations[inner[0] - span[0] : inner[1] - span[0]] = again.rotations
        found.append(Estimate(rotations, again.share, first.usual))
    return found


@dataclass(frozen=True, eq=False)
class _Guess:
    """One joint's predictions, and how to make a guess of them."""

    flat: Prediction
    predicted: Prediction | None
    unseen: Prediction | None
    which: int
    rate: float
    pace: F64

    def over(self, span: Span, usable: Mask) -> Estimate:
        i, rate = self.which, self.rate
        starts = _trials(usable, span, max(2, round(_TRIAL_SECONDS * rate)), self.pace)
        flat = trials(self.flat.residuals[:, i], OF_MOTION, span, starts, rate)
        led = joined(self.flat, i, usable, span, rate, flat.kernel)
        if self.predicted is None:
            return Estimate(led, 0.0, _rms(flat.missed))
        unseen = (self.unseen or self.predicted).residuals[:, i]
        of_others = trials(unseen, OF_PREDICTED, span, starts, rate)
        share = evidence(of_others.missed, flat.missed)
        guessed = joined(self.predicted, i, usable, span, rate, of_others.kernel)
        missed = _rms(share * of_others.missed + (1.0 - share) * flat.missed)
        return Estimate(rot.slerp(led, guessed, share), share, missed)


def _rms(missed: F64) -> F64:
    """(n,) root mean square over trials (t, n, 3), 0 without any."""
    squared = np.sum(missed**2, axis=-1)
    return np.sqrt(squared.mean(axis=0)) if len(missed) else np.zeros(missed.shape[1])


def _narrowed(right: Mask, span: Span, pad: int) -> Span:
    """Leave out up to `pad` frames at each end of a span that are right (n,)."""
    pad = min(pad, (len(right) - 1) // 2)
    first = next((k for k in range(pad) if not right[k]), pad)
    last = next((k for k in range(pad) if not right[-1 - k]), pad)
    return span[0] + first, span[1] - last


def joined(
    prediction: Prediction, which: int, usable: Mask, span: Span, rate: float, kernel: Kernel
) -> F64:
    """(n, 4) one joint's prediction over a span, its residual led across from both flanks."""
    away = kriging.led_across(prediction.residuals[:, which], usable, *span, rate, kernel)
    inside = prediction.rotations[slice(*span), which]
    return rot.multiply(inside, rot.from_rotation_vector(away))


@dataclass(frozen=True, eq=False)
class Trials:
    """How a residual was led across stretches where it is known.

    Parameters
    ----------
    kernel
        That which missed least; the general one where that was not clear.
    missed
        (t, n, 3) what it missed, radians.
    """

    kernel: Kernel
    missed: F64


def trials(
    residuals: F64, kernels: Sequence[Kernel], span: Span, starts: NDArray[np.int64], rate: float
) -> Trials:
    """Lead residuals across stretches where they are known, to see how much is missed.

    Parameters
    ----------
    residuals
        (F', 3) radians.
    kernels
        Those to choose from, the general one first.
    span
        Half-open frames of what is to be led across; stretches are as long.
    starts
        (t,) first frames of the stretches, flank included.
    rate
        Frames a second.
    """
    n, reach = span[1] - span[0], max(2, round(_TRIAL_SECONDS * rate))
    if not len(starts):
        return Trials(kernels[0], np.zeros((0, n, 3)))
    known = np.concatenate([np.arange(reach), np.arange(reach + n, n + 2 * reach)])
    inside = np.arange(reach, reach + n)
    parts = residuals[starts[:, None] + np.arange(n + 2 * reach)]
    tried = []
    for kernel in kernels:
        weights = kriging.weights(kernel, known / rate, inside / rate)
        tried.append(Trials(kernel, np.matmul(weights, parts[:, known]) - parts[:, inside]))
    if len(starts) < _LEAST_TRIALS:
        return tried[0]
    return min(tried, key=lambda one: float(np.mean(one.missed**2)))


def evidence(predicted: F64, flat: F64) -> float:
    """Share that a prediction should have beside interpolation to miss least.

    Parameters
    ----------
    predicted, flat
        (t, n, 3) what either missed in the same trials.

    Returns
    -------
    0..1; 1 where there were no trials.
    """
    if not len(flat):
        return 1.0
    apart = float(np.mean((flat - predicted) ** 2))
    prior = apart * _PRIOR_TRIALS / len(flat)
    share = (float(np.mean(flat * (flat - predicted))) + prior) / max(apart + prior, 1e-12)
    return float(np.clip(share, 0.0, 1.0))


def _trials(usable: Mask, span: Span, reach: int, pace: F64) -> NDArray[np.int64]:
    """Starts of stretches, flanks included, that are right throughout and as lively as the span."""
    n = span[1] - span[0]
    whole = n + 2 * reach
    if whole > len(usable):
        return np.zeros(0, dtype=np.int64)
    wrong = np.concatenate([[0], np.cumsum(~usable)])
    free = np.flatnonzero(wrong[whole:] == wrong[:-whole])
    total = np.concatenate([[0.0], np.cumsum(pace)])
    here = total[span[1]] - total[span[0]]
    away = np.abs(np.log((total[free + reach + n] - total[free + reach]) / here))
    chosen: list[int] = []
    for i in np.argsort(away, kind="stable"):
        if away[i] > _AS_LIVELY or len(chosen) >= _TRIALS:
            break
        if all(abs(int(free[i]) - one) >= max(1, n // 2) for one in chosen):
            chosen.append(int(free[i]))
    return np.array(chosen, dtype=np.int64)
