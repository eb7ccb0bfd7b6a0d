"""Frames of a live performance: when they are due, and what is wrong with lines."""

from __future__ import annotations

import json
from collections import deque

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_takes import walking

from mocapstudio.comparison.online_features import JointRotations
from mocapstudio.motion.errors import FileError, SkeletonMismatchError
from mocapstudio.review.live_feeds import Arrived, StreamFeed, TakeFeed

RATE = 30
TAKE = walking(2.0, rate=RATE)
FEATURES = JointRotations.common(TAKE)
POSES = FEATURES.of(TAKE)


def line(frame: int, time: float | None = None, **joints) -> bytes:
    """A frame of the take as a stream sends it."""
    rotations = dict(zip(TAKE.skeleton.names, TAKE.rotations[frame].tolist(), strict=True))
    place = TAKE.translations[frame, 0].tolist()
    return json.dumps({"time": time, "joints": rotations | joints, "root": place}).encode()


class Sender:
    """Lines that have come so far, with the time at which they came, or all at 0."""

    def __init__(self, lines=()) -> None:
        self.lines, self.over = deque(lines), False

    def take(self) -> tuple[float, bytes] | None:
        if not self.lines:
            return None
        line = self.lines.popleft()
        return line if isinstance(line, tuple) else (0.0, line)


def stream(sender: Sender, **options) -> StreamFeed:
    over = lambda: sender.over and not sender.lines  # noqa: E731
    feed = StreamFeed(sender.take, over, **{"clock": lambda: 0.0} | options)
    feed.settle(FEATURES)
    return feed


def given_until(feed, seconds: float) -> list[Arrived | FileError]:
    found = []
    while (one := feed.due(seconds)) is not None:
        found.append(one)
    return found


def test_a_take_is_played_at_its_own_rate_and_anew():
    feed = TakeFeed(TAKE, FEATURES)
    assert [one.frame for one in given_until(feed, 0.1)] == [0, 1, 2, 3]
    assert given_until(feed, 0.1) == []
    rest = given_until(feed, 100.0)
    assert [one.frame for one in rest] == list(range(4, TAKE.frames))
    assert feed.ended
    feed.rewind()
    assert feed.due(0.0).frame == 0


@settings(max_examples=20, deadline=None)
@given(
    kinds=st.lists(st.sampled_from(["frame", "bad", "blank"]), max_size=30),
    arrivals=st.lists(st.floats(0, 0.2), min_size=30, max_size=30),
)
def test_every_line_is_given_once_and_in_order(kinds, arrivals):
    sender, texts = Sender(), {"bad": b'{"time": 1,', "blank": b"  "}
    feed, now, found, frame = stream(sender), 0.0, [], 0
    for kind, later in zip(kinds, arrivals, strict=False):
        now += later
        if kind == "frame":
            sender.lines.append(line(frame, frame / RATE))
            frame += 1
        else:
            sender.lines.append(texts[kind])
        found += given_until(feed, now)
    found += given_until(feed, now + 100.0)
    frames = [one for one in found if isinstance(one, Arrived)]
    assert len(frames) == frame
    for number, one in enumerate(frames):
        np.testing.assert_allclose(one.pose, POSES[number], atol=1e-5)
    bad = [one.line for one in found if isinstance(one, FileError)]
    assert bad == [at for at, kind in enumerate(kinds, 1) if kind == "bad"]


def test_lines_that_wait_are_held_back_until_their_own_times():
    feed = stream(Sender(line(i, 5.0 + i / RATE) for i in range(30)))
    assert len(given_until(feed, 0.0)) == 1
    assert len(given_until(feed, 10 / RATE)) == 10
    assert len(given_until(feed, 10.0)) == 19


def test_what_came_while_nobody_looked_is_made_up_for():
    feed = stream(Sender((i / RATE, line(i, 7.0 + i / RATE)) for i in range(30)), clock=lambda: 0.5)
    # Half a second has passed since the first frame came, and with it fifteen more.
    assert len(given_until(feed, 0.0)) == 16
    assert len(given_until(feed, 1 / RATE)) == 1


def test_a_line_that_comes_alone_is_shown_at_once():
    sender = Sender()
    feed = stream(sender)
    # Its clock runs twice as fast as ours.
    for i in range(20):
        sender.lines.append(line(i, 2 * i / RATE))
        assert len(given_until(feed, i / RATE)) == 1


def test_a_clock_that_is_set_back_does_not_rush_what_follows():
    lines = [line(i, 50.0 + i / RATE) for i in range(5)]
    feed = stream(Sender(lines + [line(i, i / RATE) for i in range(30)]))
    assert len(given_until(feed, 0.0)) == 1
    assert len(given_until(feed, 5 / RATE)) == 5
    assert len(given_until(feed, 10 / RATE)) == 5


@pytest.mark.parametrize(("rate", "told"), [(120, 120.0), (24, 24.0)])
def test_the_first_frames_tell_the_rate(rate, told):
    sender = Sender(line(i, i / rate) for i in range(3))
    feed = stream(sender)
    assert feed.rate() is None
    # One frame twice, one missing.
    sender.lines.extend(line(i, i / rate) for i in (3, 3, 4, 6, 7, 8, 9))
    assert feed.rate() == pytest.approx(told)
    assert given_until(feed, 0.0)[0].time == 0.0
    assert len(given_until(feed, 100.0)) == 9


def test_without_times_there_is_no_rate_and_no_waiting():
    feed = stream(Sender(line(i) for i in range(20)))
    assert feed.rate() == 0.0
    assert len(given_until(feed, 0.0)) == 20


def test_what_a_frame_lacks_is_missing_and_what_it_sends_is_handed_on():
    feed = stream(Sender([line(3, 0.0, LeftArm=None)]))
    one = feed.due(0.0)
    row = FEATURES.names.index("LeftArm")
    assert np.isnan(one.pose[row]).all()
    assert "LeftArm" not in one.joints
    assert one.root == pytest.approx(tuple(TAKE.translations[3, 0]))


def test_joints_go_by_the_references_names():
    text = line(0, 0.0).replace(b'"LeftArm"', b'"arm_l"')
    feed = stream(Sender([text]), names={"arm_l": "LeftArm"})
    np.testing.assert_allclose(feed.due(0.0).pose, POSES[0], atol=1e-5)


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        (b'{"joints": 3}', "joints must be"),
        (b'{"root": [1, 2]}', "root must be three numbers"),
        (b"\xff\xfe", "UTF-8"),
        (b"[1]", "an object"),
    ],
)
def test_a_bad_line_is_told_by_its_number(text, cause):
    feed = stream(Sender([b"", text, line(0, 0.0)]))
    bad = feed.due(0.0)
    assert bad.line == 2
    assert cause in bad.cause
    assert isinstance(feed.due(0.0), Arrived)


def test_another_skeleton_is_refused():
    strange = json.dumps({"time": 0, "joints": {"tail": [0, 0, 0, 1]}}).encode()
    with pytest.raises(SkeletonMismatchError, match="another skeleton"):
        stream(Sender([strange])).due(0.0)
