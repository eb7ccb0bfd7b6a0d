"""Detection, top to bottom: from a take and its context to map and flags (paper 1, section 3).

1. 24 fps textures without the facing direction; 2. every word's K nearest neighbours by
constrained DTW; 3. the mean texture of the neighbours and the departure from it; 4. the
digression map; 5. pops and jitter at the take's own rate, and the root; 6. flags.
"""

from __future__ import annotations

from collections.abc import Generator, Sequence

from mocapstudio.cleaning import maps, own_rate, root
from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.decision.model import Decision
from mocapstudio.cleaning.flags import find_flags
from mocapstudio.cleaning.mean_texture import departure, mean_texture, paper_map
from mocapstudio.cleaning.parameters import PAPER, DetectionParameters
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.take import Take
from mocapstudio.similarity.search import searching
from mocapstudio.similarity.texture import (
    MotionTexture,
    body_motion,
    comparable_joints,
    motion_texture,
    texture_of,
)
from mocapstudio.similarity.words import Corpus, WordNeighbours, WordShape, trim_count

DEFAULTS = DetectionParameters()


def detect(
    take: Take,
    context: Sequence[Take] = (),
    parameters: DetectionParameters = DEFAULTS,
    *,
    decision: Decision | None = None,
    normal: Sequence[Declared] = (),
    protected: Sequence[Declared] = (),
) -> Generator[Progress, None, Analysis]:
    """Find where a take departs from itself and from its context; yields progress.

    Parameters
    ----------
    take, context
        The take, of which only the trimmed span is looked at, and other takes of the same
        skeleton, joints matched by name; the take itself is searched too.
    parameters
        See `DetectionParameters`.
    decision
        What `decision.store.prepare` learnt, or None; never used in the paper's mode.
    normal, protected
        Rows x spans that somebody called correct, or that nothing may change: never flagged.

    Raises
    ------
    SkeletonMismatchError
        If a take of the context has another skeleton.
    MocapError
        If the take is shorter than two frames at 24 fps.
    """
    yield Progress(0.0, "sampling textures")
    joints = comparable_joints(take, context)
    shape = WordShape(parameters.source_word, parameters.hop, parameters.target_word)
    motion = body_motion(take, joints)
    texture = texture_of(motion)
    corpus = Corpus.of([texture, *(motion_texture(one, joints) for one in context)])
    neighbours = yield from _search(texture, corpus, parameters, shape)
    yield Progress(0.6, "drawing the map")
    mean = mean_texture(texture, corpus, neighbours, shape)
    away = departure(texture, mean)
    rates = own_rate.of_motion(motion).placed(take.span[0], take.frames)
    used = _usable(decision, parameters, joints)
    if parameters.mode == PAPER:
        digression = maps.of_joints(take, texture, paper_map(away), away)
    else:
        height = root.height_departure(texture, corpus, neighbours, shape)
        digression = maps.plain(take, texture, away, height, rates)
        digression = maps.with_edges(digression, take, motion, texture, mean)
    if used is not None:
        yield Progress(0.75, "deciding")
        digression = maps.decided(take, motion, corpus, used, digression)
    digression = maps.without(digression, [*normal, *protected])
    yield Progress(0.95, "raising flags")
    flags = find_flags(take, digression, rates, parameters.threshold)
    left_out = tuple(name for name in take.skeleton.names if name not in joints)
    others, learnt = tuple(context), used is not None
    doubts = () if used is None else used.doubted(others)
    return Analysis(
        take, others, parameters, corpus, digression, flags, rates, left_out, learnt, doubts
    )


def _usable(
    decision: Decision | None, parameters: DetectionParameters, joints: tuple[str, ...]
) -> Decision | None:
    """Return the decision where it is about the joints that are compared."""
    if decision is None or parameters.mode == PAPER:
        return None
    return decision if decision.joints == joints else None


def _search(
    texture: MotionTexture, corpus: Corpus, parameters: DetectionParameters, shape: WordShape
) -> Generator[Progress, None, WordNeighbours]:
    """Find the neighbours of all words of the whole body, with progress from 0.1 to 0.6."""
    keep, trim = parameters.neighbours, trim_count(len(texture.joints), True)
    work = searching(texture, corpus, keep, trim, shape, parameters.search)
    while True:
        try:
            done = next(work)
        except StopIteration as stop:
            found: WordNeighbours = stop.value
            return found
        yield Progress(0.1 + 0.5 * done, "searching neighbours")
