"""Properties that every analysis must have, whatever the take."""

from __future__ import annotations

import gc
import threading
import weakref
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from made_takes import chain, elsewhere, faced, horse, moved, person, turned, walking

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.model import Kind
from mocapstudio.cleaning.parameters import MODES, PAPER, DetectionParameters, schema
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError, ParameterError, SkeletonMismatchError
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION, ROOT_ROWS
from mocapstudio.motion.progress import run
from mocapstudio.motion.skeleton import Skeleton
from mocapstudio.motion.take import Source, Take


def found(take: Take, context: Sequence[Take] = (), **options: object) -> Analysis:
    return run(detect(take, context, **options))  # type: ignore[arg-type]


def check(analysis: Analysis) -> None:
    """Check what holds of every analysis."""
    take, digression = analysis.take, analysis.map
    assert digression.values.shape == (take.frames, len(digression.rows))
    assert digression.residuals.shape == digression.values.shape
    assert digression.values.dtype == np.float32
    assert np.all((digression.values >= 0) & (digression.values <= 1))
    assert np.all(np.isfinite(digression.residuals) & (digression.residuals >= 0))
    first, last = take.span
    assert np.all(digression.values[:first] == 0) and np.all(digression.values[last:] == 0)
    assert digression.rows[-2:] == ROOT_ROWS
    assert {*digression.rows[:-2], *analysis.unanalysed} == set(take.skeleton.names)
    flags = analysis.flags
    assert len({flag.id for flag in flags}) == len(flags)
    assert [flag.score for flag in flags] == sorted((f.score for f in flags), reverse=True)
    for flag in flags:
        assert first <= flag.start < flag.end <= last
        assert flag.joint in flag.joints
        assert flag.start <= flag.peak_frame < flag.end
        assert flag.peak == analysis.peak(flag.joint, flag.start, flag.end)
        assert flag.peak > analysis.parameters.threshold
        assert 0 <= flag.score <= 1
    for row in digression.rows:
        spans = sorted((f.start, f.end) for f in flags if f.joint == row)
        assert all(a[1] < b[0] for a, b in pairwise(spans))


def rows_between(analysis: Analysis, start: int, end: int) -> set[str]:
    return {flag.joint for flag in analysis.flags if flag.overlaps(start, end)}


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("with_context", [True, False])
def test_every_analysis_is_well_formed(
    take: Take, context: tuple[Take, ...], mode: str, with_context: bool
) -> None:
    spoilt = turned(turned(take, "LeftForeArm", 100, 125, 45), "RightLeg", 0, 9, 60)
    others = context if with_context else ()
    analysis = found(spoilt, others, parameters=DetectionParameters(mode=mode))
    check(analysis)
    assert analysis.flags
    assert analysis.take is spoilt
    assert analysis.context == others


def test_a_clean_take_raises_hardly_a_flag(take: Take, context: tuple[Take, ...]) -> None:
    assert len(found(take, context).flags) <= 2
    assert len(found(take).flags) <= 2


@pytest.mark.parametrize("with_context", [True, False])
@pytest.mark.parametrize(
    ("joint", "start", "end", "degrees"),
    [
        ("LeftForeArm", 100, 125, 45),
        ("RightLeg", 150, 153, 60),
        ("Spine", 60, 90, 35),
        ("Hips", 100, 125, 40),
        ("Head", 0, 20, 50),
        ("LeftFoot", 285, 300, 50),
    ],
)
def test_gross_errors_are_found_where_they_are(
    take: Take,
    context: tuple[Take, ...],
    with_context: bool,
    joint: str,
    start: int,
    end: int,
    degrees: float,
) -> None:
    spoilt = turned(take, joint, start, end, degrees, (0.8, 0.0, 0.6))
    analysis = found(spoilt, context if with_context else ())
    check(analysis)
    assert joint in rows_between(analysis, start, end)
    # Words reach over what they touch; nothing farther than one of them is flagged.
    reach = round(15 / 24 * 30)
    for flag in analysis.flags:
        if flag.joint == joint:
            assert start - reach <= flag.start and flag.end <= end + reach
    assert len({flag.joint for flag in analysis.flags}) <= 3


def test_both_arms_exchanged_are_found(take: Take, context: tuple[Take, ...]) -> None:
    rotations = take.rotations.copy()
    index = take.skeleton.index
    for name in ("UpLeg", "Leg"):
        left, right = index[f"Left{name}"], index[f"Right{name}"]
        rotations[120:160, [left, right]] = rotations[120:160, [right, left]]
    rows = rows_between(found(take.with_motion(rotations), context), 120, 160)
    assert rows & {"LeftUpLeg", "LeftLeg", "RightUpLeg", "RightLeg"}


@pytest.mark.parametrize("with_context", [True, False])
def test_root_errors_have_rows_of_their_own(
    take: Take, context: tuple[Take, ...], with_context: bool
) -> None:
    others = context if with_context else ()
    pop = found(moved(take, 80, 82, (0, 0.25, 0)), others)
    assert rows_between(pop, 80, 82) == {ROOT_POSITION}
    assert next(f.kind for f in pop.flags if f.overlaps(80, 82)) is Kind.ROOT_POP
    lifted = found(moved(take, 100, 170, (0, 0.12, 0)), others)
    assert ROOT_POSITION in rows_between(lifted, 110, 160)
    flip = found(faced(take, 120, 140, 120), others)
    assert rows_between(flip, 120, 140) == {ROOT_HEADING}
    for analysis in (pop, lifted, flip):
        check(analysis)


def test_a_turn_and_a_place_in_the_world_change_no_joint(
    take: Take, context: tuple[Take, ...]
) -> None:
    spoilt = turned(take, "LeftArm", 100, 130, 40)
    here = found(spoilt, context)
    there = found(elsewhere(spoilt, 77.0, (4.0, 0.0, -3.0)), context)
    np.testing.assert_allclose(there.map.values, here.map.values, atol=2e-3)
    assert [f.joint for f in there.flags] == [f.joint for f in here.flags]


def test_what_a_take_was_found_to_be_is_found_again(take: Take, context: tuple[Take, ...]) -> None:
    spoilt = turned(take, "LeftArm", 100, 130, 40)
    once, again = found(spoilt, context), found(spoilt, context)
    np.testing.assert_array_equal(once.map.values, again.map.values)
    assert once.flags == again.flags


@pytest.mark.parametrize("frames", [3, 5, 12, 18, 19, 25])
@pytest.mark.parametrize("mode", MODES)
def test_a_take_shorter_than_a_word_is_analysed(
    take: Take, context: tuple[Take, ...], frames: int, mode: str
) -> None:
    short = replace(
        take, rotations=take.rotations[:frames], translations=take.translations[:frames]
    )
    for others in (context, ()):
        analysis = found(short, others, parameters=DetectionParameters(mode=mode))
        check(analysis)


def test_a_take_of_one_frame_is_refused_by_name(take: Take) -> None:
    one = replace(take, rotations=take.rotations[:1], translations=take.translations[:1])
    with pytest.raises(MocapError, match=r"walk 0.*too short|too short"):
        found(one)


def test_a_still_take_raises_no_flag() -> None:
    names = person().names
    still = np.tile([0.0, 0.0, 0.0, 1.0], (200, len(names), 1))
    take = Take("still", person(), still, np.full((200, 1, 3), 0.9), Fraction(30))
    analysis = found(take)
    check(analysis)
    assert analysis.flags == ()


@pytest.mark.parametrize("skeleton", [horse(), chain(), chain(1)])
def test_other_bodies_than_peoples_are_analysed(skeleton: Skeleton) -> None:
    time = np.arange(240) / 30
    angles = 0.4 * np.sin(2 * np.pi * (time[:, None] + np.linspace(0, 1, len(skeleton))))
    rotations = np.zeros((240, len(skeleton), 4))
    rotations[..., 0], rotations[..., 3] = np.sin(angles / 2), np.cos(angles / 2)
    take = Take("animal", skeleton, rotations, np.zeros((240, 1, 3)), Fraction(30))
    check(found(take))
    joint = skeleton.names[-1]
    analysis = found(turned(take, joint, 100, 120, 70, (0, 0, 1)))
    check(analysis)
    assert joint in rows_between(analysis, 100, 120)


def test_a_context_of_another_skeleton_is_refused_by_file(take: Take) -> None:
    names = horse().names
    stranger = Take(
        "horse",
        horse(),
        np.tile([0.0, 0.0, 0.0, 1.0], (90, len(names), 1)),
        np.zeros((90, 1, 3)),
        Fraction(30),
        source=Source(Path("stable/horse.bvh"), "bvh", "0"),
    )
    with pytest.raises(SkeletonMismatchError, match=r"stable/horse\.bvh"):
        found(take, [stranger])


def test_joints_unknown_to_the_context_are_named(take: Take) -> None:
    other = walking(10.0, 30, seed=1)
    names = tuple(n.replace("Neck", "Nape") for n in other.skeleton.names)
    analysis = found(take, [replace(other, skeleton=replace(other.skeleton, names=names))])
    check(analysis)
    assert analysis.unanalysed == ("Neck",)


@pytest.mark.parametrize("mode", MODES)
def test_nothing_outside_the_trimmed_span_is_flagged(
    take: Take, context: tuple[Take, ...], mode: str
) -> None:
    spoilt = take
    for start, end in ((5, 30), (140, 165), (270, 295)):
        spoilt = turned(spoilt, "LeftForeArm", start, end, 60)
    spoilt = moved(spoilt, 20, 22, (0, 0.4, 0))
    trimmed = replace(spoilt, trim=(45, 255))
    analysis = found(trimmed, context, parameters=DetectionParameters(mode=mode))
    check(analysis)
    assert "LeftForeArm" in rows_between(analysis, 140, 165)
    cut = replace(
        spoilt, rotations=spoilt.rotations[45:255], translations=spoilt.translations[45:255]
    )
    alone = found(cut, context, parameters=DetectionParameters(mode=mode))
    np.testing.assert_array_equal(analysis.map.values[45:255], alone.map.values)


@pytest.mark.parametrize("which", ["normal", "protected"])
@pytest.mark.parametrize("span", [(0, 300), (90, 140), (110, 113), (118, 119), (0, 112)])
def test_what_is_normal_or_protected_is_never_flagged(
    take: Take, context: tuple[Take, ...], which: str, span: tuple[int, int]
) -> None:
    spoilt = turned(moved(take, 110, 112, (0, 0.3, 0)), "LeftForeArm", 100, 125, 60)
    for row in ("LeftForeArm", ROOT_POSITION):
        excepted = [Declared(row, *span), Declared("nobody's joint", 0, 300)]
        analysis = found(spoilt, context, **{which: excepted})
        check(analysis)
        assert not [f for f in analysis.flags if f.joint == row and f.overlaps(*span)]
        other = {"LeftForeArm", ROOT_POSITION} - {row}
        assert other <= rows_between(analysis, 100, 125)


@pytest.mark.parametrize("stop_after", range(7))
def test_it_can_be_given_up_at_any_moment(
    take: Take, context: tuple[Take, ...], stop_after: int
) -> None:
    """Closed after any yield it leaves no thread and nothing that holds the take."""
    mine = turned(take, "LeftArm", 100, 130, 40)
    before = {thread.name for thread in threading.enumerate() if "kernels" not in thread.name}
    work = detect(mine, context)
    for _ in range(stop_after):
        if next(work, None) is None:
            break
    work.close()
    with pytest.raises(StopIteration):
        next(work)
    assert {t.name for t in threading.enumerate() if "kernels" not in t.name} == before
    gone = weakref.ref(mine)
    del mine, work
    gc.collect()
    assert gone() is None
    check(found(take, context))


def test_progress_never_falls_and_says_what_is_done(take: Take, context: tuple[Take, ...]) -> None:
    seen = list(detect(take, context))
    done = [progress.done for progress in seen]
    assert done == sorted(done)
    assert done[0] == 0.0
    assert done[-1] <= 1.0
    assert all(progress.what for progress in seen)


@pytest.mark.parametrize("threshold", [0.05, 0.2, 0.5, 0.8, 0.95])
@pytest.mark.parametrize("mode", MODES)
def test_another_threshold_is_as_good_as_another_run(
    take: Take, context: tuple[Take, ...], threshold: float, mode: str
) -> None:
    spoilt = moved(turned(take, "LeftForeArm", 100, 125, 25), 30, 32, (0, 0.1, 0))
    first = found(spoilt, context, parameters=DetectionParameters(mode=mode))
    again = first.with_threshold(threshold)
    anew = found(spoilt, context, parameters=DetectionParameters(mode=mode, threshold=threshold))
    assert again.flags == anew.flags
    assert again.parameters == anew.parameters
    assert again.map is first.map
    check(again)


def test_flags_of_one_limb_at_one_time_know_each_other(
    take: Take, context: tuple[Take, ...]
) -> None:
    spoilt = take
    for joint in ("LeftArm", "LeftForeArm", "RightLeg"):
        spoilt = turned(spoilt, joint, 100, 125, 60)
    spoilt = turned(spoilt, "LeftHand", 200, 225, 60)
    flags = {f.joint: f for f in found(spoilt, context).flags}
    assert flags["LeftArm"].joints == flags["LeftForeArm"].joints == ("LeftArm", "LeftForeArm")
    assert flags["RightLeg"].joints == ("RightLeg",)
    assert flags["LeftHand"].joints == ("LeftHand",)


@pytest.mark.parametrize(
    "wrong",
    [
        {"threshold": 0.0}, {"threshold": 1.0}, {"neighbours": 0}, {"mode": "guess"},
        {"hop": 0}, {"source_word": 4}, {"source_word": 30, "target_word": 20},
        {"threshold": float("nan")},
    ],
)  # fmt: skip
def test_parameters_out_of_bounds_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ParameterError, match=r"threshold|neighbours|mode|hop|word"):
        DetectionParameters(**wrong)  # type: ignore[arg-type]


def test_parameters_have_a_schema_that_admits_their_defaults() -> None:
    defaults = DetectionParameters()
    for name in ("threshold", "neighbours", "source_word", "hop", "target_word"):
        one = schema(name)
        assert one.low is not None and one.high is not None
        assert one.low <= getattr(defaults, name) <= one.high
        assert one.help and one.label
        for bound in (one.low, one.high):
            kind = type(getattr(defaults, name))
            words = {"target_word": 80} if name == "source_word" else {}
            words |= {"source_word": 5} if name == "target_word" else {}
            assert DetectionParameters(**{name: kind(bound), **words})
    assert schema("mode").choices == MODES
    with pytest.raises(KeyError):
        schema("colour")


@pytest.mark.parametrize("words", [(5, 5), (5, 80), (60, 60), (60, 80), (15, 20)])
def test_words_of_every_allowed_length_work(take: Take, words: tuple[int, int]) -> None:
    parameters = DetectionParameters(source_word=words[0], target_word=words[1], hop=30)
    spoilt = turned(take, "LeftForeArm", 100, 125, 60)
    check(found(spoilt, parameters=parameters))


def test_the_papers_mode_needs_no_root() -> None:
    take = walking(4.0, 30)
    analysis = found(moved(take, 50, 60, (0, 1.0, 0)), parameters=DetectionParameters(mode=PAPER))
    assert not {f.joint for f in analysis.flags} & set(ROOT_ROWS)
