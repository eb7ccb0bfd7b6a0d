"""How long a frame of online alignment and the training of weights take."""

from __future__ import annotations

import math
import time
from collections.abc import Generator
from dataclasses import replace

import numpy as np

from mocapstudio.comparison.online import OnlineAligner
from mocapstudio.comparison.online_features import F32, JointRotations
from mocapstudio.comparison.online_reference import Reference, reference_of
from mocapstudio.comparison.weights_quality import Example
from mocapstudio.comparison.weights_training import PAPER, evolved
from mocapstudio.evaluation.demo import demo_take
from mocapstudio.evaluation.speed_benchmark import SpeedRow
from mocapstudio.motion.progress import Progress, run
from mocapstudio.motion.take import Take

REFERENCE_FRAMES = 500
FOLD_TAKES, FOLD_FRAMES, FOLD_RATE, FOLD_SEGMENTS = 76, 120, 30, 5

_FED = 500


def online_speed(*, long: bool) -> Generator[Progress, None, list[SpeedRow]]:
    """Measure a new frame against 500 reference frames, and with `long` one fold of training."""
    take = demo_take()
    rows = []
    for motion in (False, True):
        reference = _long(take, motion)
        poses = np.ascontiguousarray(reference.rows[:, : len(reference.features.names)])
        for whole, reach in ((False, 0.0002), (True, 0.001)):
            yield Progress(0.0, "online alignment, a frame")
            seconds, cpu = _a_frame(reference, poses, whole)
            name = f"a new frame, {len(reference)} reference frames"
            name += ", poses and motion" if motion else ", poses alone"
            name += ", with the whole path" if whole else ""
            rows.append(SpeedRow(name, seconds, cpu, reach, 0.007 if whole else math.nan))
    if long:
        yield Progress(0.1, "training one fold")
        rows.append(_a_fold(take))
    return rows


def _long(take: Take, motion: bool) -> Reference:
    return _cut(take, 0, REFERENCE_FRAMES, motion)


def _cut(take: Take, start: int, frames: int, motion: bool) -> Reference:
    each = max(1, round(float(take.rate) / FOLD_RATE))
    part = replace(take, trim=(start, min(start + frames * each, take.frames)))
    features = JointRotations.common(part)
    return reference_of(part, rate=take.rate / each, motion=motion, features=features)


def _a_frame(reference: Reference, poses: F32, whole: bool) -> tuple[float, float]:
    """Median seconds a frame, and processor seconds of all frames by their number."""
    aligner = OnlineAligner(reference, path_frames=_FED if whole else 0)
    _fed(aligner, poses, whole)
    aligner.restart()
    processor = time.process_time()
    times = _fed(aligner, poses, whole)
    return float(np.median(times)), (time.process_time() - processor) / len(times)


def _fed(aligner: OnlineAligner, poses: F32, whole: bool) -> list[float]:
    """Seconds that each frame took."""
    times = []
    for i in range(_FED):
        started = time.perf_counter()
        aligner.feed(poses[i % len(poses)], i / FOLD_RATE)
        if whole:
            aligner.path()
        times.append(time.perf_counter() - started)
    return times


def _a_fold(take: Take) -> SpeedRow:
    each = max(1, round(float(take.rate) / FOLD_RATE))
    starts = np.linspace(0, take.frames - FOLD_FRAMES * each - 1, FOLD_TAKES + 1).astype(int)
    cuts = [_cut(take, int(start), FOLD_FRAMES, motion=False) for start in starts]
    segments = (np.arange(len(cuts[0])) * FOLD_SEGMENTS // len(cuts[0])).astype(np.int32)
    examples = [Example(str(i), str(i), one.rows, segments) for i, one in enumerate(cuts[1:])]
    started, processor = time.perf_counter(), time.process_time()
    run(evolved(cuts[0], segments, examples, PAPER))
    seconds, cpu = time.perf_counter() - started, time.process_time() - processor
    name = f"weights, a fold of {FOLD_TAKES} takes of {len(segments)} frames, {PAPER.iterations}"
    return SpeedRow(f"{name} iterations", seconds, cpu, 60.0)
