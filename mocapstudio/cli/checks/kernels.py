"""The compiled kernels and where they are kept."""

from __future__ import annotations

import time
from collections.abc import Generator
from typing import TypeVar

from mocapstudio.cli.checks.finding import Finding, State
from mocapstudio.cli.kernel_cache import TEMPORARY, VARIABLE, is_writable, place_kernel_cache
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.take import Take

Result = TypeVar("Result")


def check_kernel_cache() -> list[Finding]:
    """Find out whether compiled kernels are kept from one start to the next."""
    what = "Kernel cache"
    folder = place_kernel_cache()
    if not is_writable(folder):
        remedy = f"make the folder writable or set {VARIABLE} to another"
        return [Finding(what, State.FAILED, f"{folder} cannot be written", remedy)]
    if folder.name.startswith(TEMPORARY):
        remedy = f"set {VARIABLE} to a folder that stays"
        found = f"{folder}, for this start only: kernels are compiled again each time"
        return [Finding(what, State.NOTE, found, remedy)]
    kept = sum(1 for _ in folder.rglob("*.nbc"))
    remedy = "" if kept else "mocapstudio doctor --warm compiles all of them now"
    return [Finding(what, State.OK, f"{folder}, {kept} compiled", remedy)]


def warm() -> Generator[Progress, None, Finding]:
    """Compile all kernels by doing, on a part of the built-in take, what needs them.

    Yields
    ------
    Progress.

    Returns
    -------
    How long it took.
    """
    from dataclasses import replace

    from mocapstudio.cleaning.decision.training import learn
    from mocapstudio.cleaning.detection import detect
    from mocapstudio.cleaning.parameters import CALIBRATED, PAPER, DetectionParameters
    from mocapstudio.cleaning.proposals import propose
    from mocapstudio.comparison.kata import compare
    from mocapstudio.evaluation.demo import demo_take

    began = time.monotonic()
    yield Progress(0.0, "making a take")
    take = replace(demo_take(), trim=(0, 1200))
    decision = yield from _part(learn([take], take.skeleton.names), 0.0, 0.6)
    # A threshold low enough that there is something to repair.
    low = {mode: DetectionParameters(mode=mode, threshold=0.1) for mode in (PAPER, CALIBRATED)}
    yield from _part(detect(take, (), low[CALIBRATED], decision=decision), 0.6, 0.8)
    analysis = yield from _part(detect(take, (), low[PAPER]), 0.8, 0.95)
    propose(analysis, analysis.flags[0])
    yield from _part(compare(take, take), 0.95, 0.99)
    _align_online(take)
    return Finding("Kernels", State.OK, f"all compiled, after {time.monotonic() - began:.0f} s")


def _align_online(take: Take) -> None:
    import numpy as np

    from mocapstudio.comparison.online import OnlineAligner, Variant
    from mocapstudio.comparison.online_reference import reference_of
    from mocapstudio.comparison.weights_quality import Example, Trials

    reference = reference_of(take)
    aligner = OnlineAligner(reference, path_frames=2)
    aligner.feed(reference.rows[0, : len(reference.features.names)])
    aligner.path()
    segments = np.zeros(len(reference), np.int32)
    short = Example("", "", reference.rows[:3], segments[:3])
    for variant in Variant:
        Trials(reference, segments, [short]).qualities(reference.plain_weights[None], variant)


def _part(
    work: Generator[Progress, None, Result], low: float, high: float
) -> Generator[Progress, None, Result]:
    """Pass the progress of a part of the work on as progress of the whole."""
    while True:
        try:
            progress = next(work)
        except StopIteration as stop:
            result: Result = stop.value
            return result
        yield Progress(low + (high - low) * progress.done, progress.what)
