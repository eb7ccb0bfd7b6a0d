"""Detection, top to bottom: from a take and its context to map and flags (paper 1, section 3).

1. 24 fps textures without the facing direction; 2. every word's K nearest neighbours by
constrained DTW; 3. the mean texture of the neighbours and the departure from it; 4. the
digression map; 5. pops and jitter at the take's own rate, and the root; 6. flags.
"""

from __future__ import annotations

from collections.abc import Generator, Sequence

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning import calibration, own_rate, root
from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.decision.model import Decision
from mocapstudio.cleaning.decision.surroundings import anatomy_of, surroundings
from mocapstudio.cleaning.flags import find_flags
from mocapstudio.cleaning.mean_texture import departure, mean_texture, paper_map
from mocapstudio.cleaning.model import DigressionMap
from mocapstudio.cleaning.own_rate import OwnRate
from mocapstudio.cleaning.parameters import PAPER, DetectionParameters
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION, ROOT_ROWS
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import (
    BodyMotion,
    MotionTexture,
    body_motion,
    comparable_joints,
    motion_texture,
    texture_of,
)
from mocapstudio.similarity.words import Corpus, WordShape, find_neighbours, trim_count

F32 = NDArray[np.float32]

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
    """Find where a take departs from itself and from its context.

    Parameters
    ----------
    take
        The take; only its trimmed span is looked at.
    context
        Other takes of the same skeleton, joints matched by name; the take itself is searched too.
    parameters
        See `DetectionParameters`.
    decision
        What `decision.store.prepare` learnt from the context; None for the plain map, which
        needs no preparation. The paper's mode never uses it.
    normal
        Rows x spans that somebody called correct: they are never flagged.
    protected
        Rows x spans that nothing may change: they are not flagged either.

    Yields
    ------
    Progress; the generator may be closed at any of them.

    Returns
    -------
    The analysis.

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
    yield Progress(0.1, "searching neighbours")
    trim = trim_count(len(joints), whole_body=True)
    neighbours = find_neighbours(texture, corpus, parameters.neighbours, trim, shape)
    yield Progress(0.6, "drawing the map")
    away = departure(texture, mean_texture(texture, corpus, neighbours, shape))
    values = paper_map(away) if parameters.mode == PAPER else calibration.calibrated(away)
    digression = _joint_rows(take, joints, texture, values, np.rad2deg(away))
    yield Progress(0.7, "looking for pops")
    rates = own_rate.of_motion(motion).placed(take.span[0], take.frames)
    if parameters.mode != PAPER:
        height = root.height_departure(texture, corpus, neighbours, shape)
        digression = _with_root_and_pops(take, digression, texture, height, rates)
    learnt = parameters.mode != PAPER and decision is not None and decision.joints == joints
    if decision is not None and learnt:
        yield Progress(0.75, "deciding")
        digression = _decided(take, motion, corpus, decision, digression)
    digression = _without(digression, [*normal, *protected])
    yield Progress(0.95, "raising flags")
    return Analysis(
        take=take,
        context=tuple(context),
        parameters=parameters,
        corpus=corpus,
        map=digression,
        flags=find_flags(take, digression, rates, parameters.threshold),
        own_rate=rates,
        unanalysed=tuple(name for name in take.skeleton.names if name not in joints),
        learnt=learnt,
    )


def _at_own_rate(take: Take, texture: MotionTexture, values: F32) -> F32:
    """Interpolate (T, n) texture values to the frames of the take; 0 outside the trimmed span."""
    first, last = take.span
    at = (np.arange(first, last) - texture.start) / texture.frames_each
    low = np.clip(at.astype(np.int64), 0, len(values) - 2)
    part = np.clip(at - low, 0.0, 1.0)[:, None].astype(np.float32)
    result = np.zeros((take.frames, values.shape[1]), dtype=np.float32)
    result[first:last] = values[low] * (1 - part) + values[low + 1] * part
    return result


def _joint_rows(
    take: Take, joints: tuple[str, ...], texture: MotionTexture, values: F32, degrees: F32
) -> DigressionMap:
    """Lay the joints' rows, and empty root rows after them, at the take's own rate."""
    empty = np.zeros((take.frames, len(ROOT_ROWS)), dtype=np.float32)
    return DigressionMap(
        rows=(*joints, *ROOT_ROWS),
        values=np.hstack([_at_own_rate(take, texture, values), empty]),
        residuals=np.hstack([_at_own_rate(take, texture, degrees), empty]),
    )


def _with_root_and_pops(
    take: Take, digression: DigressionMap, texture: MotionTexture, height: F32, rates: OwnRate
) -> DigressionMap:
    values, residuals = digression.values.copy(), digression.residuals.copy()
    at = {row: digression.rows.index(row) for row in ROOT_ROWS}
    residuals[:, at[ROOT_POSITION]] = _at_own_rate(take, texture, height[:, None])[:, 0]
    residuals[:, at[ROOT_HEADING]] = root.heading_departure(take)
    for row, scale in (
        (ROOT_POSITION, calibration.HEIGHT_CENTIMETRES),
        (ROOT_HEADING, calibration.HEADING_DEGREES),
    ):
        values[:, at[row]] = calibration.value_of(residuals[:, at[row]], scale)
    sharp = np.maximum(rates.pops, rates.jitter)
    return DigressionMap(
        digression.rows, np.maximum(values, calibration.exceeding(sharp)), residuals
    )


def _decided(
    take: Take,
    motion: BodyMotion,
    corpus: Corpus,
    decision: Decision,
    plain: DigressionMap,
) -> DigressionMap:
    """Let the learnt decision draw the map; the plain residuals of the root rows stay."""
    texture, *others = corpus.textures
    limb = anatomy_of(take.skeleton, decision.joints).limb
    around = surroundings(others, texture, limb)
    probability, degrees = decision.probabilities(motion, around)
    residuals = plain.residuals.copy()
    residuals[:, : len(decision.joints)] = _at_own_rate(take, texture, degrees)
    return DigressionMap(plain.rows, _at_own_rate(take, texture, probability), residuals)


def _without(digression: DigressionMap, excepted: Sequence[Declared]) -> DigressionMap:
    if not excepted:
        return digression
    values = digression.values.copy()
    for span in excepted:
        if span.row in digression.rows:
            values[span.start : span.end, digression.rows.index(span.row)] = 0.0
    return DigressionMap(digression.rows, values, digression.residuals)
