"""Markers solved to a skeleton, step by step.

1. Markers are attached to joints: by name, the others where they move least.
2. Marker places, bone lengths and the poses of some frames are found together.
3. With those fixed, every frame is posed, near its neighbours where markers leave a turn open.
"""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from mocapstudio.motion import progress
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.completion import complete
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.solving.attachment import Attachment, attach_by_name, attach_by_rigidity
from mocapstudio.motion.solving.body import Body, Pose
from mocapstudio.motion.solving.calibration import calibrate
from mocapstudio.motion.solving.initial import first_pose
from mocapstudio.motion.solving.model import Solved
from mocapstudio.motion.solving.pose import Seen, freed, refine, residuals
from mocapstudio.motion.solving.template import Template, template_of
from mocapstudio.motion.take import Take

Array = NDArray[np.float64]

_FEWEST = 6
_FEWEST_JOINTS = 3
_CALIBRATED = 80
_ALIKE = 0.06
"""Share by which markers may be misplaced: a body as near the template's size is as large."""
_FILLED = 0.05
"""Weight of a marker that was filled, not measured."""
_RIGID = 0.06
"""Metres: a marker that moves more on every joint is on none."""
_OFF = 0.1
"""Metres: a frame with a marker farther off is told of."""
_ROUNDS, _CALIBRATIONS, _LAST = 5, 12, 4


def solve(markers: MarkerTake, template: Take) -> Solved:
    """Solve markers to the skeleton of a template; `solving` with nobody watching."""
    return progress.run(solving(markers, template))


def solving(markers: MarkerTake, template: Take) -> Generator[Progress, None, Solved]:
    """Solve markers to the skeleton of a template.

    Parameters
    ----------
    markers
        Labelled markers of one performer.
    template
        A take of the same or a similar performer in any joint format. Of its motion only what
        joints can turn and, where the rest pose does not stand, one standing pose are used.

    Raises
    ------
    MocapError
        If too few markers are known by name to tell the body from.
    """
    body_template = template_of(template)
    seen = [m for m in range(len(markers.labels)) if not markers.missing[:, m].all()]
    attachment = attach_by_name(markers, body_template, seen)
    _check(markers, attachment, len(seen))
    yield Progress(0.02, "filling gaps")
    whole = complete(markers) if markers.missing[:, seen].any() else markers
    yield Progress(0.1, "finding where markers sit")
    some = _some(markers, seen)
    body, attachment, pose = _calibrated(whole, body_template, attachment, some)
    others = sorted(set(seen) - set(attachment.markers.tolist()))
    left_out: list[int] = []
    if others:
        positions, world = body.joints(pose)
        found = attach_by_rigidity(whole, others, positions, world, some.astype(float))
        for marker in others:
            joint, offset, spread = found.get(marker, (0, np.zeros(3), np.inf))
            if spread > _RIGID:
                left_out.append(marker)
                continue
            attachment = attachment.with_marker(marker, joint, offset)
        body, attachment, pose = _calibrated(whole, body_template, attachment, some)
    yield Progress(0.4, "posing every frame")
    samples = _samples(whole, attachment.markers)
    pose = first_pose(body, samples)
    for at in range(_LAST):
        with threadpool_limits(1, "blas"):
            pose = refine(body, pose, samples, 1, beside=at > 0)
            if at == _LAST - 2:
                pose = freed(body, pose, samples, _ROUNDS)
        yield Progress(0.4 + 0.6 * (at + 1) / _LAST, "posing every frame")
    return _result(markers, template, body, pose, left_out)


def _check(markers: MarkerTake, attachment: Attachment, seen: int) -> None:
    known, joints = len(attachment.markers), len(np.unique(attachment.joints))
    if seen < _FEWEST:
        raise MocapError(f"{seen} markers are too few to solve; {_FEWEST} are needed")
    if known < _FEWEST or joints < _FEWEST_JOINTS:
        raise MocapError(
            f"only {known} of {seen} marker names tell a part of the template's"
            " body; rename markers with --joint-map to names such as LKNE, RSHO, LASI"
        )


def _some(markers: MarkerTake, seen: list[int]) -> NDArray[np.int64]:
    """Frames to calibrate on: evenly spread over those that show the most markers."""
    start, end = markers.span
    shown = (~markers.missing[start:end][:, seen]).sum(axis=1)
    good = start + np.flatnonzero(shown >= np.quantile(shown, 0.3))
    return np.unique(good[np.linspace(0, len(good) - 1, _CALIBRATED).astype(int)])


def _samples(
    markers: MarkerTake, chosen: NDArray[np.int64], frames: NDArray[np.int64] | None = None
) -> Seen:
    rows = slice(None) if frames is None else frames
    places = markers.positions[rows][:, chosen]
    weights = (~np.isnan(places).any(axis=2)).astype(float)
    if markers.filled is not None:
        weights[markers.filled[rows][:, chosen]] *= _FILLED
    return Seen(np.nan_to_num(places), weights)


def _calibrated(
    markers: MarkerTake, template: Template, attachment: Attachment, some: NDArray[np.int64]
) -> tuple[Body, Attachment, Pose]:
    seen = _samples(markers, attachment.markers, some)
    size = _size(template, attachment, seen)
    attachment = attachment.scaled(size)
    body = Body(template, attachment, np.full(len(template.skeleton), size))
    # Matrices are small: several threads on each would only wait for each other.
    with threadpool_limits(1, "blas"):
        pose = refine(body, first_pose(body, seen), seen, _ROUNDS)
        body, pose = calibrate(body, pose, seen, _CALIBRATIONS)
    return body, attachment.scaled(1 / size), pose


def _size(template: Template, attachment: Attachment, seen: Seen) -> float:
    """How many times as large as the template the markers' body is.

    Told by pairs of markers that keep their distance.
    """
    positions, world = template.standing_pose
    joints = attachment.joints
    at = positions[joints] + np.einsum("mab,mb->ma", world[joints], attachment.offsets)
    places = np.where(seen.weights[..., None] > 0, seen.places, np.nan)
    ratios = []
    for one in range(len(joints)):
        expected = np.linalg.norm(at - at[one], axis=1)
        apart = np.linalg.norm(places - places[:, one : one + 1], axis=2)
        many = (~np.isnan(apart)).sum(axis=0) > len(apart) // 2
        pairs = np.flatnonzero(many & (expected > 0.2 * expected.max()))
        if not len(pairs):
            continue
        length = np.nanmedian(apart[:, pairs], axis=0)
        rigid = np.nanstd(apart[:, pairs], axis=0) < 0.03 * length
        ratios += list(length[rigid] / expected[pairs][rigid])
    size = float(np.median(ratios)) if ratios else 1.0
    return 1.0 if abs(size - 1.0) < _ALIKE else size


def _result(
    markers: MarkerTake, template: Take, body: Body, pose: Pose, left_out: list[int]
) -> Solved:
    attachment = body.attachment
    raw = _samples(markers, attachment.markers)
    measured = raw.weights == 1.0
    lengths = np.linalg.norm(residuals(body, pose, raw), axis=2)
    warnings = [f"{markers.labels[m]} belongs to no joint and is left out" for m in left_out]
    warnings += _thin(body)
    far = int((np.where(measured, lengths, 0.0).max(axis=1) > _OFF).sum())
    if far:
        warnings.append(f"in {far} of {len(lengths)} frames a marker is more than 10 cm off")
    return Solved(
        take=_as_take(markers, template, body, pose),
        labels=tuple(markers.labels[m] for m in attachment.markers),
        joints=attachment.joints,
        offsets=attachment.offsets,
        residuals=np.where(measured, lengths, np.nan),
        scales=body.scales,
        left_out=tuple(markers.labels[m] for m in left_out),
        warnings=tuple(warnings),
    )


def _thin(body: Body) -> list[str]:
    """Say which joints turn by fewer markers than tell a rotation."""
    names = body.template.skeleton.names
    carried = np.bincount(body.attachment.joints, minlength=len(names))
    thin = [names[j] for j in np.unique(body.attachment.joints) if carried[j] < 2]
    if not thin:
        return []
    return [f"a single marker each on {', '.join(thin)}: what it leaves open is a guess"]


def _as_take(markers: MarkerTake, template: Take, body: Body, pose: Pose) -> Take:
    skeleton, hips = template.skeleton, body.template.hips
    ends = skeleton.end_offsets * body.scales[skeleton.end_parents, None]
    offsets = body.offsets.copy()
    scaled = replace(skeleton, offsets=offsets, end_offsets=ends)
    rotations = rot.continuous(rot.from_matrix(pose.turns))
    place = pose.place
    translated: tuple[int, ...] = (0,)
    translations = place[:, None]
    if hips != 0:
        positions, world = body.joints(pose)
        parent = int(skeleton.parents[hips])
        local = np.einsum("kba,kb->ka", world[:, parent], place - positions[:, parent])
        root = np.broadcast_to(positions[:1, 0], place.shape)
        translated, translations = (0, hips), np.stack([root, local], axis=1)
    return Take(
        name=markers.name,
        skeleton=scaled,
        rotations=rotations,
        translations=translations,
        rate=markers.rate,
        translated=translated,
        first_frame=markers.first_frame,
        timecode=markers.timecode,
        trim=markers.trim,
    )
