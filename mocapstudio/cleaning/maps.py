"""Drawing digression maps: at the take's own rate, joints first, then the two root rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning import calibration, root
from mocapstudio.cleaning.decision.model import Decision
from mocapstudio.cleaning.decision.surroundings import anatomy_of, surroundings
from mocapstudio.cleaning.model import DigressionMap
from mocapstudio.cleaning.own_rate import OwnRate
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION, ROOT_ROWS
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import BodyMotion, MotionTexture
from mocapstudio.similarity.words import Corpus

F32 = NDArray[np.float32]


def of_joints(take: Take, texture: MotionTexture, values: F32, departures: F32) -> DigressionMap:
    """Lay a map of joints at the take's own rate, root rows left empty.

    Parameters
    ----------
    values
        (T, m) 0..1, at the texture's rate.
    departures
        (T, m) radians, at the texture's rate.
    """
    empty = np.zeros((take.frames, len(ROOT_ROWS)), dtype=np.float32)
    degrees = np.asarray(np.rad2deg(departures), dtype=np.float32)
    return DigressionMap(
        rows=(*texture.joints, *ROOT_ROWS),
        values=np.hstack([at_own_rate(take, texture, values), empty]),
        residuals=np.hstack([at_own_rate(take, texture, degrees), empty]),
    )


def plain(
    take: Take, texture: MotionTexture, departures: F32, height: F32, rates: OwnRate
) -> DigressionMap:
    """Draw the map that needs no preparation: departures on their usual scale, pops, root rows.

    Parameters
    ----------
    departures
        (T, m) radians from the mean texture.
    height
        (T,) centimetres, see `root.height_departure`.
    rates
        Pops and jitter of all rows at the take's own rate.
    """
    joints = of_joints(take, texture, calibration.calibrated(departures), departures)
    values, residuals = joints.values.copy(), joints.residuals.copy()
    at = {row: joints.rows.index(row) for row in ROOT_ROWS}
    residuals[:, at[ROOT_POSITION]] = at_own_rate(take, texture, height[:, None])[:, 0]
    residuals[:, at[ROOT_HEADING]] = root.heading_departure(take)
    for row, scale in (
        (ROOT_POSITION, calibration.HEIGHT_CENTIMETRES),
        (ROOT_HEADING, calibration.HEADING_DEGREES),
    ):
        values[:, at[row]] = calibration.value_of(residuals[:, at[row]], scale)
    sharp = np.maximum(rates.pops, rates.jitter)
    values = np.maximum(values, calibration.exceeding(sharp))
    return DigressionMap(joints.rows, values, residuals)


def with_edges(
    digression: DigressionMap, take: Take, motion: BodyMotion, texture: MotionTexture, mean: F32
) -> DigressionMap:
    """Add the departure of the take's own frames from the mean texture (T, m, 4)."""
    between = at_own_rate(take, texture, mean.reshape(len(mean), -1))
    first, last = take.span
    expected = between[first:last].reshape(last - first, -1, 4)
    norm = np.linalg.norm(expected, axis=-1)
    dot = np.abs(np.sum(expected * motion.rotations, axis=-1)) / np.maximum(norm, 1e-9)
    fine = np.zeros((take.frames, expected.shape[1]), dtype=np.float32)
    fine[first:last] = np.nan_to_num(np.rad2deg(2.0 * np.arccos(np.clip(dot, 0.0, 1.0))))
    return replace(digression, fine=fine)


def decided(
    take: Take, motion: BodyMotion, corpus: Corpus, decision: Decision, plainly: DigressionMap
) -> DigressionMap:
    """Let the learnt decision draw the map; the plain residuals of the root rows stay."""
    texture, *others = corpus.textures
    limb = anatomy_of(take.skeleton, decision.joints).limb
    around = surroundings(others, texture, limb)
    probability, degrees = decision.probabilities(motion, around)
    residuals = plainly.residuals.copy()
    residuals[:, : len(decision.joints)] = at_own_rate(take, texture, degrees)
    values = at_own_rate(take, texture, probability)
    return replace(plainly, values=values, residuals=residuals)


def without(digression: DigressionMap, excepted: Sequence[Declared]) -> DigressionMap:
    """Return the map with 0 on excepted rows x spans."""
    if not excepted:
        return digression
    values = digression.values.copy()
    for span in excepted:
        if span.row in digression.rows:
            values[span.start : span.end, digression.rows.index(span.row)] = 0.0
    return replace(digression, values=values)


def at_own_rate(take: Take, texture: MotionTexture, values: F32) -> F32:
    """Interpolate (T, n) texture values to the frames of the take; 0 outside the trimmed span."""
    first, last = take.span
    at = (np.arange(first, last) - texture.start) / texture.frames_each
    low = np.clip(at.astype(np.int64), 0, len(values) - 2)
    part = np.clip(at - low, 0.0, 1.0)[:, None].astype(np.float32)
    result = np.zeros((take.frames, values.shape[1]), dtype=np.float32)
    result[first:last] = values[low] * (1 - part) + values[low + 1] * part
    return result
