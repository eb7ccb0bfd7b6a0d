"""How injected errors run in time: two families of shapes that have nothing in common.

Detectors may learn from the family ``"standard"``; ``"held-out"`` has other ramps, other noise
spectra and other interpolation, so that a detector that merely learnt the injector is found out.
Lengths are in frames of the take's own rate; every profile peaks at 1 on a sampled frame.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.model import Kind

Array = NDArray[np.float64]
Family = Literal["standard", "held-out"]
FAMILIES: tuple[Family, ...] = ("standard", "held-out")

SPANS: dict[Kind, tuple[float, float]] = {
    Kind.SPIKE: (2, 4),
    Kind.OFFSET: (8, 30),
    Kind.FREEZE: (8, 30),
    Kind.NOISE: (8, 30),
    Kind.GAP: (8, 30),
    Kind.DRIFT: (30, 90),
    Kind.SWAP: (8, 30),
    Kind.FLIP: (3, 24),
    Kind.LIMB: (8, 30),
    Kind.JITTER: (8, 30),
    Kind.HEIGHT_DRIFT: (30, 90),
    Kind.HEADING_FLIP: (3, 24),
}
"""Shortest and longest span in frames at 24 fps; pops are counted in own frames."""

POP_FRAMES = (1, 3)
"""Shortest and longest pop in frames of the take's own rate."""

DEGREES: dict[Kind, tuple[float, float]] = {
    Kind.FLIP: (90.0, 180.0),
    Kind.HEADING_FLIP: (60.0, 180.0),
}
"""Magnitudes where they are not 10° to 80°."""

ROOT_CENTIMETRES = (3.0, 30.0)
JITTER_HERTZ = 12.0


def magnitude_bounds(kind: Kind) -> tuple[float, float]:
    """Smallest and largest magnitude: degrees, or centimetres for errors of the root's place."""
    if kind in (Kind.ROOT_POP, Kind.HEIGHT_DRIFT):
        return ROOT_CENTIMETRES
    return DEGREES.get(kind, (10.0, 80.0))


def length(kind: Kind, rate: float, rng: np.random.Generator) -> int:
    """Draw a span in frames of the take's own rate."""
    if kind in (Kind.POP, Kind.ROOT_POP):
        return int(rng.integers(POP_FRAMES[0], POP_FRAMES[1] + 1))
    low, high = SPANS[kind]
    return max(1, round(rng.uniform(low, high) * rate / 24.0))


def ramp(frames: int, length: int, family: Family) -> Array:
    """(frames,) rise from above 0 to 1: a cosine, or a straight line when held out."""
    t = np.arange(1, frames + 1) / (min(frames, length) + 1.0)
    t = np.clip(t, 0.0, 1.0)
    return np.asarray(0.5 - 0.5 * np.cos(np.pi * t) if family == "standard" else t)


def profile(
    kind: Kind, frames: int, rate: float, family: Family, rng: np.random.Generator
) -> Array:
    """(frames,) envelope of an error, largest magnitude 1."""
    if family == "standard":
        values = _standard(kind, frames, rate, rng)
    else:
        values = _held_out(kind, frames, rate, rng)
    return np.asarray(values / np.abs(values).max())


def _own(frames24: float, rate: float) -> int:
    return max(1, round(frames24 * rate / 24.0))


def _plateau(frames: int, rise: int, fall: int, family: Family) -> Array:
    up = ramp(frames, rise, family)
    return np.minimum(up, ramp(frames, fall, family)[::-1])


def _standard(kind: Kind, frames: int, rate: float, rng: np.random.Generator) -> Array:
    i = np.arange(frames)
    match kind:
        case Kind.SPIKE:
            return np.sin(np.pi * (i + 1) / (frames + 1))
        case Kind.POP | Kind.ROOT_POP | Kind.FLIP | Kind.HEADING_FLIP:
            return np.ones(frames)
        case Kind.DRIFT | Kind.HEIGHT_DRIFT:
            fall = min(_own(rng.uniform(3, 8), rate), max(1, frames // 3))
            return np.minimum((i + 1.0) / frames, ramp(frames, fall, "standard")[::-1])
        case _:
            rise, fall = (_own(x, rate) for x in rng.uniform(1, 4, 2))
            return _plateau(frames, rise, fall, "standard")


def _held_out(kind: Kind, frames: int, rate: float, rng: np.random.Generator) -> Array:
    i = np.arange(frames)
    match kind:
        case Kind.SPIKE:
            tail = np.exp(-i / max(1.0, frames * 0.4))
            return tail if rng.random() < 0.5 else tail[::-1]
        case Kind.POP | Kind.ROOT_POP:
            return np.array([1.0, -0.6, 0.8])[:frames]
        case Kind.FLIP | Kind.HEADING_FLIP:
            return _plateau(frames, 2, 1, "held-out") * (1 + 0.05 * np.sin(i))
        case Kind.DRIFT | Kind.HEIGHT_DRIFT:
            # Rises ever faster and is let go at once, or swells and ebbs.
            t = (i + 1.0) / frames
            return t**2 if rng.random() < 0.5 else np.sin(np.pi * (i + 1) / (frames + 1)) ** 2
        case _:
            # A sudden onset that overshoots and dies away slowly, or the reverse.
            decay = np.exp(-i / (frames * rng.uniform(0.5, 1.5)))
            wobble = 1 + 0.3 * np.exp(-i / _own(2, rate)) * np.cos(i * 2 * np.pi / _own(4, rate))
            values = decay * wobble * _plateau(frames, 1, _own(6, rate), "held-out")
            return values if rng.random() < 0.5 else values[::-1]


def axis(frames: int, rng: np.random.Generator) -> Array:
    """(frames, 3) unit vectors: a random axis that wanders smoothly, rarely by over 20°."""
    ends = rng.standard_normal((2, 3))
    ends /= np.linalg.norm(ends, axis=1, keepdims=True)
    t = np.linspace(0.0, 0.25, frames)[:, None]
    line = ends[0] + t * (ends[1] - ends[0])
    return np.asarray(line / np.linalg.norm(line, axis=1, keepdims=True))


def noise(kind: Kind, frames: int, rate: float, family: Family, rng: np.random.Generator) -> Array:
    """(frames, 3) noise whose longest vector has length 1.

    A noise burst is band-limited to 2–10 Hz (held out: white); jitter lies
    between 12 Hz and 90 % of the Nyquist frequency (held out: one tone there, alternating sign
    at low rates).
    """
    if kind is Kind.JITTER:
        low, high = JITTER_HERTZ, max(JITTER_HERTZ, 0.45 * rate)
        tones = 6 if family == "standard" else 1
    elif family == "held-out":
        values = np.clip(rng.standard_t(3, size=(frames, 3)), -2.0, 2.0)
        return np.asarray(values / np.linalg.norm(values, axis=1).max())
    else:
        low, high, tones = 2.0, min(10.0, 0.45 * rate), 8
    hertz = rng.uniform(low, high, size=(tones, 1, 3))
    phase = rng.uniform(0, 2 * np.pi, size=(tones, 1, 3))
    time = np.arange(frames)[None, :, None] / rate
    values = np.sin(2 * np.pi * hertz * time + phase).sum(axis=0)
    return np.asarray(values / np.linalg.norm(values, axis=1).max())
