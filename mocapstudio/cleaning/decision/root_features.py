"""Features of the two root rows: travel and turning against the neighbours', and themselves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.decision.features import moved, running_median, windows
from mocapstudio.cleaning.decision.matching import Matches
from mocapstudio.cleaning.own_rate import OwnRate
from mocapstudio.similarity.texture import TEXTURE_RATE, TRAVEL, MotionTexture

F32 = NDArray[np.float32]

_SIGNALS = (*TRAVEL, "rise", "turning")
NAMES = (
    *(f"{name} {what}" for name in _SIGNALS for what in ("context", "own", "spread")),
    *(f"{name} {what}" for name in _SIGNALS for what in ("size", "change")),
    "height onset", "heading onset", "distance", "own distance",
    "place pop", "place jitter", "heading pop", "heading jitter",
    "place pop around", "heading pop around",
    "height context 6 before", "height context 6 after",
    "heading onset lowest", "heading onset highest", "slide highest", "clearance onset", "row",
)  # fmt: skip


def root_features(
    texture: MotionTexture,
    textures: list[MotionTexture],
    matches: Matches,
    rates: OwnRate,
    slide: F32,
) -> F32:
    """Assemble the features of root position and root heading.

    Parameters
    ----------
    texture
        The take, S frames.
    textures
        Its context.
    matches
        From `matching.match`.
    rates
        Pops and jitter pooled to 24 fps; the last two columns are the root rows.
    slide
        (S,) highest speed of the slowest foot around each frame, m/s.

    Returns
    -------
    (S, 2, len(NAMES)) float32: both rows see the same values, and which row they are.
    """
    signals = np.concatenate([_signals(one) for one in (texture, *textures)])
    mine = signals[: len(texture)]
    shift = np.arange(len(texture)) - matches.centres[matches.centre_of]
    context, spread = _departure(mine, signals, matches.found, matches, shift)
    own, _ = _departure(mine, signals, matches.own_found, matches, shift)
    # Another floor or body height is no error.
    height, clearance = _SIGNALS.index("height"), _SIGNALS.index("clearance")
    for away in (context, own):
        for column in (height, clearance):
            known = np.isfinite(away[:, column])
            away[:, column] -= np.median(away[known, column]) if known.any() else 0.0
    columns = [x for i in range(len(_SIGNALS)) for x in (context[:, i], own[:, i], spread[:, i])]
    columns += [x for v in mine.T for x in (np.abs(v), np.abs(np.gradient(v)))]
    turned = np.cumsum(mine[:, _SIGNALS.index("turning")])[:, None] / TEXTURE_RATE
    heading = np.asarray(turned, dtype=np.float32)
    onset = np.abs(heading - running_median(heading, 30))
    columns += [
        np.abs(mine[:, height] - running_median(mine[:, height : height + 1], 30)[:, 0]),
        onset[:, 0],
        matches.distance[matches.centre_of, -1, 0],
        matches.own_distance[matches.centre_of, -1, 0],
        rates.pops[:, -2], rates.jitter[:, -2], rates.pops[:, -1], rates.jitter[:, -1],
        windows(rates.pops[:, -2:-1], 2).max(axis=-1)[:, 0],
        windows(rates.pops[:, -1:], 2).max(axis=-1)[:, 0],
        moved(context[:, height], -6), moved(context[:, height], 6),
        windows(onset, 6).min(axis=-1)[:, 0], windows(onset, 6).max(axis=-1)[:, 0], slide,
        np.abs(mine[:, clearance] - running_median(mine[:, clearance : clearance + 1], 36)[:, 0]),
    ]  # fmt: skip
    both = np.repeat(np.stack(columns, axis=-1)[:, None], 2, axis=1)
    row = np.broadcast_to(np.array([0.0, 1.0])[None, :, None], (*both.shape[:2], 1))
    return np.concatenate([both, row], axis=-1).astype(np.float32)


def _signals(texture: MotionTexture) -> F32:
    """(S, 7): what `TRAVEL` names, rise (m/s) and turning rate (rad/s)."""
    rise = np.gradient(texture.travel[:, TRAVEL.index("height")]) * TEXTURE_RATE
    stacked = np.column_stack([texture.travel, rise, texture.turning])
    return np.asarray(stacked, dtype=np.float32)


def _departure(
    mine: F32, signals: F32, found: NDArray[np.int32], matches: Matches, shift: NDArray[np.int64]
) -> tuple[F32, F32]:
    """Difference to the neighbours' median and their spread, (S, 7) each; NaN without any."""
    at = found[matches.centre_of, -1]
    there = at >= 0
    values = np.where(there[..., None], signals[np.maximum(at, 0) + shift[:, None]], np.nan)
    nobody = ~there.any(axis=1)
    values[nobody] = 0.0
    median = np.nanmedian(values, axis=1)
    spread = np.nanmean(np.abs(values - median[:, None]), axis=1)
    away = mine - median
    away[nobody], spread[nobody] = np.nan, np.nan
    return away.astype(np.float32), spread.astype(np.float32)
