"""Paper 1's search under another pose distance, all else alike (Table 1, 'SSA with …').

Both rows draw the map from the mean of the K neighbours on one fixed scale in degrees, tuned on
training cases, so that nothing but the distance differs between them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.mean_texture import departure, mean_texture
from mocapstudio.evaluation.cases import Case
from mocapstudio.evaluation.detection_benchmark import Detector
from mocapstudio.evaluation.map_detector import detector_of, tuned
from mocapstudio.evaluation.truth import Array
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.facing import split_heading
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology
from mocapstudio.similarity import kernels
from mocapstudio.similarity.texture import (
    TEXTURE_RATE,
    MotionTexture,
    comparable_joints,
    motion_texture,
)
from mocapstudio.similarity.words import (
    Corpus,
    WordNeighbours,
    WordShape,
    find_neighbours,
    trim_count,
    word_starts,
)

SCALES = (10.0, 15.0, 20.0, 25.0, 35.0, 50.0)
"""Tried: degrees at which the map passes 0.5."""
VELOCITY_WEIGHT = 0.04
"""Square of the time, s², that a velocity is worth as a distance: 0.2 s."""
NEIGHBOURS = 5

F32 = NDArray[np.float32]
Search = Callable[[Take, Sequence[Take], Corpus, WordShape], WordNeighbours]


def geodesic(
    take: Take, context: Sequence[Take], corpus: Corpus, shape: WordShape
) -> WordNeighbours:
    """Neighbours by the paper's own distance on rotations (equation 1)."""
    trim = trim_count(len(corpus.textures[0].joints), whole_body=True)
    return find_neighbours(corpus.textures[0], corpus, NEIGHBOURS, trim, shape)


def chai_hodgins(
    take: Take, context: Sequence[Take], corpus: Corpus, shape: WordShape
) -> WordNeighbours:
    """Neighbours by positions and velocities of the joints (Chai and Hodgins 2005), time-warped.

    Positions are relative to the hips, the facing direction removed.
    """
    joints = corpus.textures[0].joints
    parts = zip((take, *context), corpus.textures, strict=True)
    features = [_features(one, texture, joints) for one, texture in parts]
    everything = np.concatenate(features)
    words = word_starts(len(features[0]), shape)
    count = max(corpus.frames - shape.target + 1, 0)
    found = np.full((len(words), NEIGHBOURS), -1, dtype=np.int64)
    spans = np.zeros((len(words), NEIGHBOURS, 2), dtype=np.int16)
    distances = np.full((len(words), NEIGHBOURS), np.inf, dtype=np.float32)
    if not count or not len(words):
        return WordNeighbours(words, found, spans, distances)
    straddling = np.zeros(count, dtype=bool)
    for start in corpus.starts[1:]:
        straddling[max(int(start) - shape.target + 1, 0) : int(start)] = True
    row, ends = np.empty(count, dtype=np.float32), np.empty((2, count), dtype=np.int16)
    for w, word in enumerate(words):
        poses = _squared(features[0][word : word + shape.source], everything)
        kernels.dtw_word(poses, shape.target, row, ends)
        row[straddling] = 1e30
        centre = int(word) + shape.source // 2 - shape.target // 2
        near = np.array([centre - shape.source // 2, centre + shape.source // 2 + 1])
        n = kernels.smallest_minima(row, corpus.starts, NEIGHBOURS, near, found[w])
        distances[w, :n] = row[found[w, :n]]
        spans[w, :n] = ends[:, found[w, :n]].T
    return WordNeighbours(words, found, spans, distances)


def tuned_alternatives(training: Sequence[Case]) -> dict[str, Detector]:
    """Both distances, each with its best scale on the training cases."""
    rows = {}
    for name, search in (("paper 1, fixed scale", geodesic), ("Chai-Hodgins", chai_hodgins)):
        kept: dict[Take, tuple[tuple[str, ...], Array]] = {}
        candidates = {s: partial(_remembered, search, s, kept) for s in SCALES}
        best = tuned(candidates, training)
        rows[name] = detector_of(partial(_mapped, search, best))
    return rows


def _mapped(
    search: Search, scale: float, take: Take, context: Sequence[Take]
) -> tuple[tuple[str, ...], Array]:
    return _scaled(_residuals(search, take, context), scale)


def _remembered(
    search: Search,
    scale: float,
    kept: dict[Take, tuple[tuple[str, ...], Array]],
    take: Take,
    context: Sequence[Take],
) -> tuple[tuple[str, ...], Array]:
    if take not in kept:
        kept[take] = _residuals(search, take, context)
    return _scaled(kept[take], scale)


def _scaled(found: tuple[tuple[str, ...], Array], scale: float) -> tuple[tuple[str, ...], Array]:
    rows, degrees = found
    return rows, 1.0 - np.exp(-np.log(2.0) * (degrees / scale) ** 2)


def _residuals(
    search: Search, take: Take, context: Sequence[Take]
) -> tuple[tuple[str, ...], Array]:
    """Joints, and (F, m) degrees from the mean texture, at the take's own rate."""
    shape = WordShape()
    joints = comparable_joints(take, context)
    corpus = Corpus.of([motion_texture(one, joints) for one in (take, *context)])
    texture = corpus.textures[0]
    neighbours = search(take, context, corpus, shape)
    away = np.degrees(departure(texture, mean_texture(texture, corpus, neighbours, shape)))
    at = np.clip((np.arange(take.frames) - texture.start) / texture.frames_each, 0, None)
    columns = [np.interp(at, np.arange(len(away)), away[:, j]) for j in range(away.shape[1])]
    return joints, np.stack(columns, axis=1)


def _features(take: Take, texture: MotionTexture, joints: Sequence[str]) -> F32:
    """(T, 6 m) float32: positions in metres, and velocities weighted to metres."""
    heading, _ = split_heading(take)
    positions, _ = take_pose(take)
    hips = topology(take.skeleton).hips
    own = positions[:, [take.skeleton.index[name] for name in joints]] - positions[:, hips, None]
    local = rot.rotate(rot.about_axis(1, -heading)[:, None], own).reshape(take.frames, -1)
    at = texture.start + np.arange(len(texture)) * texture.frames_each
    frames = np.arange(take.frames)
    sampled = np.stack([np.interp(at, frames, column) for column in local.T], axis=1)
    velocity = np.gradient(sampled, axis=0) * TEXTURE_RATE * np.sqrt(VELOCITY_WEIGHT)
    return np.concatenate([sampled, velocity], axis=1).astype(np.float32)


def _squared(a: F32, b: F32) -> F32:
    """(N, T) squared Euclidean distances."""
    product = a @ b.T
    total = (a * a).sum(axis=1)[:, None] + (b * b).sum(axis=1)[None] - 2.0 * product
    return np.ascontiguousarray(np.maximum(total, 0.0), dtype=np.float32)
