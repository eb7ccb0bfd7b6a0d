"""How the errors of the training examples run in time. Lengths are in frames at 24 fps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

USUAL_LENGTHS = (6.0, 36.0)
LENGTHS: dict[str, tuple[float, float]] = {
    "spike": (1.0, 5.0),
    "drift": (24.0, 100.0),
    "height drift": (20.0, 100.0),
    "flip": (2.0, 28.0),
    "heading flip": (2.0, 28.0),
}


def envelope(kind: str, n: int, own: float, rng: np.random.Generator) -> Array:
    """(n,) size over time, about 1 at its largest; `own` is one 24 fps frame in own frames."""
    t = (np.arange(n) + 1.0) / (n + 1.0)
    if kind == "pop":
        return np.asarray(rng.uniform(0.6, 1.0, n) * rng.choice([-1.0, 1.0], n))
    if kind == "spike":
        return np.asarray(np.sin(np.pi * t) ** rng.uniform(0.2, 1.5))
    if kind == "drift":
        shape = (t, t**2, np.sin(np.pi * t), np.sqrt(t))[int(rng.integers(4))]
        fall = np.clip((n - np.arange(n)) / (1.0 + own * rng.uniform(0.5, 10)), 0.0, 1.0)
        return np.asarray(shape * fall)
    rise, fall = own * (rng.uniform(0.2, 2.5, 2) if kind == "flip" else rng.uniform(0.4, 8.0, 2))
    up = np.clip((np.arange(n) + 1.0) / max(rise, 1.0), 0.0, 1.0)
    down = np.clip((n - np.arange(n)) / max(fall, 1.0), 0.0, 1.0)
    waves = np.sin(2 * np.pi * (t * rng.uniform(0.3, 3.0) + rng.random()))
    level = 1.0 + rng.uniform(0.0, 0.3) * waves
    decay = np.exp(-t * rng.uniform(0.0, 1.5)) if rng.random() < 0.4 else 1.0
    return np.asarray(np.minimum(up, down) * level * decay)


def axis(n: int, rng: np.random.Generator) -> Array:
    """(n, 3) unit vectors that wander from one direction some way to another."""
    a, b = rng.standard_normal((2, 3))
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    line = a + np.linspace(0.0, rng.uniform(0.0, 0.7), n)[:, None] * (b - a)
    return np.asarray(line / np.linalg.norm(line, axis=1, keepdims=True))


def noise(kind: str, n: int, rate: float, rng: np.random.Generator) -> Array:
    """(n, 3) noise whose longest vector has length 1: a burst below 12 Hz, or jitter above."""
    time = np.arange(n)[:, None] / rate
    low, high = (12.0, 0.48 * rate) if kind == "jitter" else (1.5, 11.0)
    values = np.zeros((n, 3))
    for _ in range(int(rng.integers(2, 7))):
        phase = 2 * np.pi * (rng.uniform(low, max(high, low)) * time + rng.random(3))
        values += rng.standard_normal(3) * np.sin(phase)
    return np.asarray(values / max(np.linalg.norm(values, axis=1).max(), 1e-9))
