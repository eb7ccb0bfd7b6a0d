"""Contact or not, frame by frame: a two-state hidden Markov model that learns from the take.

Each point is in contact or free. In contact its speed is low and it is on the floor; free, it is
fast or high. What low and fast mean differs between takes (noise, shoes, style), so that the
distributions are learnt by expectation and maximisation, held near what is usual by conjugate
priors. States are sticky, which gives hysteresis: a short doubt does not end a contact.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_FLOOR_SPEED = 0.01
"""Share of the leg a second that is never told from rest."""
_DWELL = 0.15
"""Seconds that a state lasts on average."""
_LEARNING_RATE = 30.0
"""Frames a second at which neighbouring frames are taken to tell something new."""
_PRIOR_FRAMES = 20.0
"""How many frames what is usual weighs."""
_ROUNDS = 4
_MOST = 12.0
"""No single frame speaks louder than this."""
_ANYWHERE = 0.07
"""Share of free points that are anywhere up to a leg above the floor."""
_IDLE = 0.05
"""Share of free points that are as slow as if they were in contact: feet held up, idle hands."""
_SUNK_LEAST, _SUNK_MOST = 0.004, 0.04
"""Of `sunk`, in legs."""
_OPEN = 0.5
"""Learning begins with contacts that may be faster than usual by this, in log speed."""
_WIDEST, _NARROWEST = 1.3, 0.6
"""Of the spread of a log speed: a foot that shifts on the spot is no free one, however still the
rest of the take stands."""
_SLOWEST_FREE = 0.3
"""Below the usual log speed of a free point by no more than this: where nothing moves, nothing
tells what is free."""


@dataclass(frozen=True)
class Emissions:
    """Distributions of log speed and height of points of one kind, in legs and seconds.

    Parameters
    ----------
    contact, contact_spread
        Mean and standard deviation of the log speed in contact.
    free, free_spread
        The same of a free point.
    sunk
        Standard deviation of the height in contact (of a Student t with 4 degrees of freedom).
    raised
        Mean height of a free point.
    """

    contact: float
    contact_spread: float
    free: float
    free_spread: float
    sunk: float
    raised: float

    def log_odds(self, log_speed: Array, height: Array) -> Array:
        """How much speed and height speak for contact, as log likelihood ratio."""
        slow = _gaussian(np.maximum(log_speed, self.contact), self.contact, self.contact_spread)
        fast = _gaussian(np.minimum(log_speed, self.free), self.free, self.free_spread)
        fast = np.logaddexp(fast + np.log(1 - _IDLE), slow + np.log(_IDLE))
        low = -2.5 * np.log1p(np.where(height > 0, height, 0.5 * height) ** 2 / (4 * self.sunk**2))
        low = low - np.log(self.sunk)
        raised = np.exp(-np.maximum(height, 0.0) / self.raised) * (1 - _ANYWHERE) / self.raised
        high = np.log(raised + _ANYWHERE)
        ratio: Array = slow - fast + low - high
        return np.clip(ratio, -_MOST, _MOST)


_USUAL = Emissions(-4.0, 1.0, 0.45, 0.95, 0.010, 0.036)
_USUAL_HEEL = Emissions(-4.0, 0.6, 0.25, 0.8, 0.0045, 0.017)
_USUAL_PALM = Emissions(-4.0, 1.0, 0.45, 0.95, 0.03, 0.5)


def usual(point: str | None) -> Emissions:
    """What is usual for heels, for palms (whose thickness nobody knows), and for other points."""
    return {"heel": _USUAL_HEEL, "palm": _USUAL_PALM}.get(point or "", _USUAL)


def log_speed(speed: Array) -> Array:
    """Log of a speed in legs a second, with what cannot be told from rest added."""
    return np.asarray(np.log(speed + _FLOOR_SPEED))


def learnt(prior: Emissions, speed: Array, height: Array, rate: float) -> Emissions:
    """Fit the distributions to a take.

    Parameters
    ----------
    prior
        What is usual.
    speed, height
        (F, P) of points of one kind, in legs a second and legs.
    rate
        Frames a second.
    """
    step = max(1, round(rate / _LEARNING_RATE))
    x, h = log_speed(speed[::step]), height[::step]
    now = replace(prior, contact=prior.contact + _OPEN, contact_spread=_WIDEST)
    for _ in range(_ROUNDS):
        p = posterior(now.log_odds(x, h), rate / step)
        contact, contact_spread = _moments(x, p, prior.contact, prior.contact_spread)
        free, free_spread = _moments(x, 1 - p, prior.free, prior.free_spread)
        square = float((p * np.clip(h, -_SUNK_MOST, _SUNK_MOST) ** 2).sum())
        square += _PRIOR_FRAMES * prior.sunk**2
        now = replace(
            now,
            contact=contact,
            contact_spread=contact_spread,
            free=max(free, contact + 1.0, prior.free - _SLOWEST_FREE),
            free_spread=free_spread,
            sunk=max(_SUNK_LEAST, float(np.sqrt(square / (float(p.sum()) + _PRIOR_FRAMES)))),
        )
    return now


def posterior(log_odds: Array, rate: float) -> Array:
    """(F, P) probability of contact at each frame, given all frames.

    Parameters
    ----------
    log_odds
        (F, P) log likelihood ratio of each frame.
    rate
        Frames a second; at high rates neighbouring frames tell the same, so that each counts less.
    """
    frames = len(log_odds)
    evidence = log_odds * min(1.0, _LEARNING_RATE / rate)
    leave = float(1 - np.exp(-1 / (_DWELL * rate)))
    forward, backward = np.empty_like(evidence), np.zeros_like(evidence)
    last = np.zeros(evidence.shape[1])
    for t in range(frames):
        forward[t] = evidence[t] + (last if t == 0 else _passed(last, leave))
        last = forward[t]
    ahead = backward[-1]
    for t in range(frames - 2, -1, -1):
        ahead = _passed(ahead + evidence[t + 1], leave)
        backward[t] = ahead
    return np.asarray(1 / (1 + np.exp(-np.clip(forward + backward, -60, 60))))


def _passed(odds: Array, leave: float) -> Array:
    """Log odds after one step of a chain that leaves either state alike, in either direction."""
    e = np.exp(np.clip(odds, -60, 60))
    return np.asarray(np.log(e * (1 - leave) + leave) - np.log(e * leave + 1 - leave))


def _gaussian(x: Array, mean: float, spread: float) -> Array:
    return np.asarray(-0.5 * ((x - mean) / spread) ** 2 - np.log(spread))


def _moments(x: Array, weight: Array, mean: float, spread: float) -> tuple[float, float]:
    total = float(weight.sum())
    about = (float((weight * x).sum()) + _PRIOR_FRAMES * mean) / (total + _PRIOR_FRAMES)
    square = float((weight * (x - about) ** 2).sum()) + _PRIOR_FRAMES * spread**2
    wide = float(np.sqrt(square / (total + _PRIOR_FRAMES)))
    return about, float(np.clip(wide, _NARROWEST, _WIDEST))
