"""Streams as they arrive: repeated, late and missing frames, and where an action begins."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_takes import reaching, walking

from mocapstudio import formats
from mocapstudio.comparison.labels import read_labels
from mocapstudio.comparison.live import LiveAlignment, LiveState, Note, played
from mocapstudio.comparison.online import OnlineAligner
from mocapstudio.comparison.online_begin import Following
from mocapstudio.comparison.online_reference import reference_of
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.take import Take

LABELS = Path(__file__).parents[1] / "labels"


def joined(*takes: Take) -> Take:
    rotations = np.concatenate([take.rotations for take in takes])
    places = np.concatenate([take.translations for take in takes])
    return replace(takes[0], rotations=rotations, translations=places)


@pytest.fixture
def live() -> LiveAlignment:
    return LiveAlignment(OnlineAligner(reference_of(walking(4.0, seed=1))))


def fed(live: LiveAlignment, times: list[float], rate: float = 30.0) -> list[LiveState]:
    """Feed the walk as it is at each time."""
    poses = live.aligner.reference.features.of(walking(4.0, seed=1))
    return [live.feed(poses[round(time * rate)], time) for time in times]


def test_a_repeated_and_a_late_frame_change_nothing(live: LiveAlignment) -> None:
    clean = LiveAlignment(live.aligner.__class__(live.aligner.reference))
    times = [i / 30 for i in range(60)]
    wanted = fed(clean, times)
    disturbed = fed(live, [*times[:20], times[19], times[18], *times[20:]])
    assert [s.note for s in disturbed[20:22]] == [Note.REPEATED, Note.LATE]
    assert disturbed[20].step == disturbed[21].step == wanted[19].step
    assert [s.step for s in disturbed[:20] + disturbed[22:]] == [s.step for s in wanted]
    assert [s.frame for s in disturbed] == list(range(62))


@settings(max_examples=15, deadline=None)
@given(again=st.lists(st.sampled_from(["", "", "repeated", "late"]), min_size=40, max_size=40))
def test_frames_that_come_again_never_count(again: list[str]) -> None:
    reference = reference_of(walking(4.0, seed=1))
    times = [i / 30 for i in range(len(again))]
    wanted = [s.step for s in fed(LiveAlignment(OnlineAligner(reference)), times)]
    sent: list[float] = []
    for at, kind in enumerate(again):
        sent.append(times[at])
        if kind:
            sent.append(times[at] if kind == "repeated" else times[max(at - 3, 0)])
    states = fed(LiveAlignment(OnlineAligner(reference)), sent)
    assert [s.step for s in states if s.note is None] == wanted
    assert len(states) - len(wanted) == sum(map(bool, again))


@settings(max_examples=15, deadline=None)
@given(gaps=st.lists(st.integers(1, 6), min_size=25, max_size=25))
def test_whatever_few_frames_are_missing_she_is_found(gaps: list[int]) -> None:
    live = LiveAlignment(OnlineAligner(reference_of(walking(4.0, seed=1))))
    frames = np.minimum(np.cumsum(gaps), 118)
    frames = np.unique(np.concatenate([[0, 1, 2], frames + 2]))
    states = fed(live, (frames / 30).tolist())
    found = np.array([s.step.reference_frame for s in states if s.step])
    assert len(found) == len(frames)
    assert np.abs(found - frames).max() <= 4


def test_frames_that_are_missing_are_bridged(live: LiveAlignment) -> None:
    times = [i / 30 for i in range(100) if not 40 <= i < 50]
    states = fed(live, times)
    assert [s.note for s in states if s.note] == [Note.BRIDGED]
    assert states[40].note is Note.BRIDGED
    found = np.array([s.step.reference_frame for s in states])
    # Ten frames of a walk drawn straight: none but those after them may be off, and only little.
    off = np.abs(found - np.round(np.array(times) * 30))
    assert off[:40].max() == 0
    assert off[40:].max() <= 4
    assert off[60:].max() <= 1


def test_a_long_gap_is_not_filled_but_survived(live: LiveAlignment) -> None:
    times = [i / 30 for i in range(115) if not 40 <= i < 65]
    states = fed(live, times)
    assert states[40].note is Note.GAP
    found = np.array([s.step.reference_frame for s in states])
    assert np.median(np.abs(found - np.array(times) * 30)[60:]) <= 2


def test_a_frame_without_joints_is_told(live: LiveAlignment) -> None:
    states = fed(live, [0.0, 1 / 30, 2 / 30])
    pose = np.full_like(live.aligner.reference.rows[0, :19], np.nan)
    state = live.feed(pose, 3 / 30)
    assert state.note is Note.UNSEEN
    assert state.step is None
    assert states[2].step is not None


def test_a_clock_that_is_set_back_begins_anew(live: LiveAlignment) -> None:
    fed(live, [i / 30 for i in range(90)])
    states = fed(live, [0.0, 1 / 30, 2 / 30])
    assert states[0].note is Note.RESTARTED
    assert [s.step.frame for s in states] == [0, 1, 2]
    assert [s.step.reference_frame for s in states] == [0, 1, 2]


@pytest.mark.parametrize("still", [10, 45, 120])
def test_the_action_is_found_after_any_silence_and_again(still: int) -> None:
    reference = reference_of(reaching(6, 60, 10))
    stream = joined(reaching(still, 70, 40), reaching(20, 55, 30))
    live = LiveAlignment(OnlineAligner(reference), wait=True)
    states = list(played(live, stream))
    begins = sorted({s.began for s in states if s.began is not None})
    # The reference stands for six frames before it moves.
    truth = [still - 6, still + 70 + 40 + 20 - 6]
    assert len(begins) == 2
    assert np.abs(np.array(begins) - truth).max() <= 6
    assert states[-1].following is Following.WAITING
    assert states[still - 6].following is Following.WAITING
    top = states[still + 35]
    assert top.step is not None
    assert abs(top.step.reference_frame - (6 + 30)) <= 3


def test_another_pose_is_not_where_the_action_begins() -> None:
    reference = reference_of(reaching(6, 60, 10))
    aside = reaching(60, 60, 60)
    turned = aside.rotations.copy()
    for joint in range(1, len(aside.skeleton)):
        turned[:, joint] = rot.multiply(
            rot.about_axis(0, np.full(len(turned), 0.9)), turned[:, joint]
        )
    live = LiveAlignment(OnlineAligner(reference), wait=True)
    states = list(played(live, aside.with_motion(turned)))
    assert {s.following for s in states} == {Following.WAITING}
    assert all(s.step is None for s in states)


def test_memory_is_bounded() -> None:
    live = LiveAlignment(OnlineAligner(reference_of(reaching(6, 60, 10))), wait=True)
    poses = live.aligner.reference.features.of(reaching(6, 60, 10))
    follower = live._follower
    assert follower is not None
    for i in range(2000):
        live.feed(poses[i % 3], i / 30)
    assert len(follower._buffer) <= follower._buffer.maxlen
    assert len(live.aligner._past) <= live.aligner._past.maxlen


def test_squats_of_a_real_take_are_told_apart(data: Path) -> None:
    path = data / "markerless_opencap_trc_MIT" / "Squats_0.trc"
    take = formats.read_any(path)[0][0]
    labels = read_labels(LABELS / "squats.json")[0]
    starts = [s.start for s in labels.segments if s.name == "going down"]
    second = replace(take, trim=(199, 328))
    live = LiveAlignment(OnlineAligner(reference_of(second)), wait=True)
    begins = sorted({s.began for s in played(live, take) if s.began is not None})
    found = [min(abs(begin - start) for begin in begins) for start in starts]
    assert max(found) <= 30
    assert np.median(found) <= 15
    assert len(begins) <= len(starts) + 1
