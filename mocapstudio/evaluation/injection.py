"""Errors of known place and shape, injected into clean takes.

`inject` draws where and how; `apply` repeats from a `Truth` exactly what was drawn, so that a
benchmark can be re-run from its record. Every change lies inside the truth's span.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from mocapstudio.cleaning.model import Kind
from mocapstudio.evaluation import shapes, swaps
from mocapstudio.evaluation.shapes import Family
from mocapstudio.evaluation.truth import Array, Truth, analysed_rows, departure, erroneous, limits
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION, carrier
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology

__all__ = [
    "ERRORS_A_MINUTE",
    "KINDS",
    "InjectionError",
    "Truth",
    "apply",
    "corrupt",
    "erroneous",
    "inject",
    "inject_each",
    "recur",
]

KINDS: tuple[Kind, ...] = tuple(Kind)
ERRORS_A_MINUTE = 6.0
"""Makes some 12 % of a take's words hold an error, as in Table 1 of paper 1."""

_ROOT_KINDS = {
    Kind.ROOT_POP: ROOT_POSITION,
    Kind.HEIGHT_DRIFT: ROOT_POSITION,
    Kind.HEADING_FLIP: ROOT_HEADING,
}
_HOLDING = (Kind.FREEZE, Kind.GAP, Kind.SWAP)
_MARGIN = 4.0
_APART = 12.0
_ATTEMPTS = 60


class InjectionError(MocapError):
    """An error of this kind finds no place in the take where it would be one."""


def apply(take: Take, truth: Truth) -> Take:
    """Repeat the error that `truth` records on `take`; nothing outside its span changes."""
    rotations, translations = take.rotations.copy(), take.translations.copy()
    span = slice(truth.start, truth.end)
    rotations[span], translations[span] = _samples(take, truth)
    # Signs run on from the frame before, as a take's quaternions do.
    before = max(0, truth.start - 1)
    run = rot.continuous(rotations[before : truth.end])
    rotations[span] = run[truth.start - before :]
    return take.with_motion(rotations, translations)


def inject(
    take: Take,
    kind: Kind,
    rng: np.random.Generator,
    *,
    joints: Sequence[str] | None = None,
    start: int | None = None,
    magnitude: float | None = None,
    family: Family = "standard",
    avoid: Sequence[tuple[int, int]] = (),
) -> tuple[Take, Truth]:
    """Put one error into a take.

    Parameters
    ----------
    take
        A clean take at its own rate, which is left as it is.
    kind
        What to do.
    joints
        Names of the joints to spoil; drawn where None. Root kinds choose their own row, a swap
        takes the limb of the first and its mirror.
    start
        First frame at the take's own rate; drawn where None.
    magnitude
        Degrees, or centimetres for errors of the root's place; drawn where None. Freezes, gaps
        and swaps are as large as the motion makes them.
    family
        Shapes to use, see `evaluation.shapes`.
    avoid
        Half-open spans from which the error keeps half a second.

    Returns
    -------
    The spoilt take, and the truth, whose `joints` are all rows that really depart.

    Raises
    ------
    InjectionError
        If no place was found: the take is too short, too slow for jitter (a rate of 26 frames a
        second is needed), or stands still where a freeze or gap was to be.
    """
    rate = float(take.rate)
    if kind is Kind.JITTER and rate < 26:
        raise InjectionError(f"jitter above 12 Hz does not exist at {rate:g} frames a second")
    for _ in range(_ATTEMPTS):
        frames = shapes.length(kind, rate, rng)
        at = _place(take, frames, rng, avoid) if start is None else start
        if at is None or at < 0 or at + frames > take.frames:
            continue
        low, high = shapes.magnitude_bounds(kind)
        size = float(rng.uniform(low, high)) if magnitude is None else float(magnitude)
        names = _choose(take, kind, joints, rng)
        truth = _drawn(kind, names, (at, at + frames), size, family, rng)
        found = _settle(take, truth, magnitude)
        if found is not None:
            return found
    raise InjectionError(f"no place for an error of kind {kind.value} in take {take.name}")


def corrupt(
    take: Take,
    rng: np.random.Generator,
    errors_per_minute: float = ERRORS_A_MINUTE,
    kinds: Sequence[Kind] = KINDS,
    *,
    family: Family = "standard",
) -> tuple[Take, tuple[Truth, ...]]:
    """Inject several errors that keep half a second from each other.

    The number is `errors_per_minute` times the length, its fraction drawn; kinds are drawn anew
    for each. Errors for which there is no room are left out.

    Returns
    -------
    The spoilt take and its truths in order of time.
    """
    expected = errors_per_minute * take.duration / 60.0
    count = int(expected) + int(rng.random() < expected % 1.0)
    drawn = [kinds[int(rng.integers(len(kinds)))] for _ in range(count)]
    return inject_each(take, drawn, rng, family=family)


def inject_each(
    take: Take,
    kinds: Sequence[Kind],
    rng: np.random.Generator,
    *,
    family: Family = "standard",
) -> tuple[Take, tuple[Truth, ...]]:
    """Inject one error of each of `kinds`, as far as there is room, half a second apart.

    Returns
    -------
    The spoilt take and its truths in order of time.
    """
    spoilt, truths = take, list[Truth]()
    for kind in kinds:
        try:
            avoid = [(t.start, t.end) for t in truths]
            spoilt, truth = inject(spoilt, kind, rng, family=family, avoid=avoid)
        except InjectionError:
            continue
        truths.append(truth)
    return spoilt, tuple(sorted(truths, key=lambda t: t.start))


def recur(
    take: Take,
    truth: Truth,
    rng: np.random.Generator,
    times: int,
    avoid: Sequence[Truth] = (),
) -> tuple[Take, tuple[Truth, ...]]:
    """Repeat one error of a take at `times` further places, as far as there is room.

    Returns the take, and the error with its repetitions; they keep away from those of `avoid`.
    """
    spoilt, truths = take, [truth]
    for _ in range(times):
        others = [(t.start, t.end) for t in (*truths, *avoid)]
        at = _place(take, truth.end - truth.start, rng, others)
        if at is None:
            break
        again = replace(truth, start=at, end=at + truth.end - truth.start)
        spoilt = apply(spoilt, again)
        truths.append(again)
    return spoilt, tuple(sorted(truths, key=lambda t: t.start))


def _drawn(
    kind: Kind,
    names: tuple[str, ...],
    span: tuple[int, int],
    magnitude: float,
    family: Family,
    rng: np.random.Generator,
) -> Truth:
    params: dict[str, Any] = {"family": family, "joints": list(names), "magnitude": magnitude}
    if kind is Kind.SWAP:
        params["manner"] = swaps.draw_manner(family, rng)
    return Truth(kind, names, *span, params, int(rng.integers(2**31)))


def _settle(take: Take, truth: Truth, magnitude: float | None) -> tuple[Take, Truth] | None:
    """Apply, and keep the result only where it is an error, with the rows that depart."""
    spoilt = apply(take, truth)
    rows = analysed_rows(take.skeleton)
    away = departure(take, spoilt, rows, truth.start, truth.end)
    beyond = away > limits(rows)
    least = max(1, (truth.end - truth.start) // 4) if truth.kind in _HOLDING else 1
    wanted = [rows.index(name) for name in truth.joints if name in rows]
    if beyond[:, wanted].sum(axis=0).max(initial=0) < least:
        # What somebody asked for by its size is done even where it stays below the threshold.
        return (spoilt, truth) if magnitude is not None and truth.kind not in _HOLDING else None
    departing = tuple(row for i, row in enumerate(rows) if beyond[:, i].any())
    return spoilt, replace(truth, joints=departing)


def _place(
    take: Take, frames: int, rng: np.random.Generator, avoid: Sequence[tuple[int, int]]
) -> int | None:
    rate = float(take.rate)
    margin, apart = round(_MARGIN * rate / 24.0), round(_APART * rate / 24.0)
    first, last = take.span
    free = np.ones(take.frames + 1, dtype=bool)
    free[: first + margin] = False
    free[max(0, last - margin - frames + 1) :] = False
    for start, end in avoid:
        free[max(0, start - apart - frames + 1) : end + apart] = False
    places = np.flatnonzero(free)
    return int(rng.choice(places)) if len(places) else None


def _choose(
    take: Take, kind: Kind, given: Sequence[str] | None, rng: np.random.Generator
) -> tuple[str, ...]:
    skeleton = take.skeleton
    if kind in _ROOT_KINDS:
        return (_ROOT_KINDS[kind],)
    if kind is Kind.SWAP:
        pairs = swaps.pairs(skeleton, skeleton.index[given[0]] if given else None)
        if not pairs:
            raise InjectionError("the skeleton has no limbs with a mirror image to swap")
        chosen = pairs[int(rng.integers(len(pairs)))]
        return tuple(skeleton.names[j] for side in chosen for j in side)
    if given is not None:
        return tuple(given)
    moving = _moving(take)
    many = kind is Kind.LIMB or (kind in (Kind.FREEZE, Kind.GAP) and rng.random() < 0.3)
    chains = _chains(skeleton, moving) if many else []
    if chains:
        chain = chains[int(rng.integers(len(chains)))]
        return tuple(skeleton.names[j] for j in chain)
    return (skeleton.names[moving[int(rng.integers(len(moving)))]],)


def _moving(take: Take) -> list[int]:
    # An error in a joint that never moves is found by anything; it would flatter the detector.
    body = list(topology(take.skeleton).body_joints())
    turned = rot.angle(take.rotations[:, body], take.rotations[:1, body]).max(axis=0)
    return [j for j, angle in zip(body, turned, strict=True) if angle > np.radians(1.0)] or body


def _chains(skeleton: Skeleton, joints: Sequence[int]) -> list[tuple[int, ...]]:
    """Every chain of two to four joints of one limb, each the parent of the next."""
    chains = []
    for top in joints:
        chain = [top]
        while len(chain) < 4:
            below = [j for j in joints if skeleton.parents[j] == chain[-1]]
            if len(below) != 1:
                break
            chain.append(below[0])
            chains.append(tuple(chain))
    return chains


def _samples(take: Take, truth: Truth) -> tuple[Array, Array]:
    """Rotations and translations of the span after the error."""
    span = slice(truth.start, truth.end)
    rotations, translations = take.rotations[span].copy(), take.translations[span].copy()
    rng = np.random.default_rng(truth.seed)
    index = take.skeleton.index
    joints = [index[name] for name in truth.params["joints"] if name in index]
    family: Family = truth.params["family"]
    match truth.kind:
        case Kind.ROOT_POP | Kind.HEIGHT_DRIFT:
            _shift_root(take, truth, translations, rng)
        case Kind.HEADING_FLIP:
            _turn_hips(take, truth, rotations, rng)
        case Kind.SWAP:
            swaps.swap(take, truth.start, joints, str(truth.params["manner"]), rotations)
        case Kind.FREEZE:
            _freeze(take, truth.start, joints, family, rotations)
        case Kind.GAP:
            _interpolate(take, truth.start, joints, family, rotations)
        case _:
            _turn(truth, joints, float(take.rate), rotations, rng)
    return rotations, translations


def _turn(
    truth: Truth, joints: Sequence[int], rate: float, rotations: Array, rng: np.random.Generator
) -> None:
    family: Family = truth.params["family"]
    frames = len(rotations)
    envelope = shapes.profile(truth.kind, frames, rate, family, rng)
    size = np.radians(float(truth.params["magnitude"]))
    for joint in joints:
        if truth.kind in (Kind.NOISE, Kind.JITTER):
            vector = shapes.noise(truth.kind, frames, rate, family, rng) * envelope[:, None]
            vector /= np.linalg.norm(vector, axis=1).max()
        else:
            vector = shapes.axis(frames, rng) * envelope[:, None]
        turn = rot.from_rotation_vector(size * vector)
        rotations[:, joint] = rot.multiply(rotations[:, joint], turn)


def _freeze(take: Take, start: int, joints: Sequence[int], family: Family, out: Array) -> None:
    frames = len(out)
    held = np.broadcast_to(take.rotations[max(0, start - 1), joints], out[:, joints].shape)
    rejoin = shapes.ramp(frames, max(1, frames // 5), family)[::-1]
    # Held out: the value is not quite held, and let go within a frame or two.
    keep = rejoin if family == "standard" else 0.9 * shapes.ramp(frames, 1, family)[::-1]
    out[:, joints] = rot.slerp(out[:, joints], held, keep[:, None])


def _interpolate(take: Take, start: int, joints: Sequence[int], family: Family, out: Array) -> None:
    frames = len(out)
    before = take.rotations[max(0, start - 1), joints]
    after = take.rotations[min(take.frames - 1, start + frames), joints]
    t = np.arange(1, frames + 1) / (frames + 1.0)
    if family == "held-out":
        t = t * t * (3 - 2 * t)
    out[:, joints] = rot.slerp(before[None], after[None], t[:, None])


def _shift_root(take: Take, truth: Truth, translations: Array, rng: np.random.Generator) -> None:
    family: Family = truth.params["family"]
    envelope = shapes.profile(truth.kind, len(translations), float(take.rate), family, rng)
    if truth.kind is Kind.HEIGHT_DRIFT:
        direction = np.array([0.0, rng.choice([-1.0, 1.0]), 0.0])
    else:
        direction = rng.standard_normal(3)
        direction /= np.linalg.norm(direction)
    shift = 0.01 * float(truth.params["magnitude"]) * envelope[:, None] * direction
    at = carrier(take)
    to_parent = rot.conjugate(_parent_world(take, take.translated[at], truth))
    translations[:, at] += rot.rotate(to_parent, shift)


def _turn_hips(take: Take, truth: Truth, rotations: Array, rng: np.random.Generator) -> None:
    family: Family = truth.params["family"]
    envelope = shapes.profile(truth.kind, len(rotations), float(take.rate), family, rng)
    hips = topology(take.skeleton).hips
    yaw = rot.about_axis(
        1, rng.choice([-1.0, 1.0]) * np.radians(truth.params["magnitude"]) * envelope
    )
    parent = _parent_world(take, hips, truth)
    turn = rot.multiply(rot.multiply(rot.conjugate(parent), yaw), parent)
    rotations[:, hips] = rot.multiply(turn, rotations[:, hips])


def _parent_world(take: Take, joint: int, truth: Truth) -> Array:
    """(n, 4) world rotations of a joint's parent in the truth's span."""
    parent = int(take.skeleton.parents[joint])
    if parent < 0:
        return np.broadcast_to(rot.IDENTITY, (truth.end - truth.start, 4))
    _, world = take_pose(take, truth.start, truth.end)
    return np.asarray(world[:, parent])
