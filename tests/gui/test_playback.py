"""The play head keeps real time, whatever drawing costs."""

from __future__ import annotations

from itertools import pairwise

import pytest
from plot_scene import sitting, walking

from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.playback import Playback, loop_span

RATE = 120


class Clock:
    now = 100.0

    def __call__(self) -> float:
        return self.now


class Player:
    def __init__(self) -> None:
        self.bridge = DocumentBridge(sitting(walking(1200, RATE)))
        self.clock = Clock()
        self.playback = Playback(self.bridge, clock=self.clock)

    def after(self, seconds: float) -> int:
        self.clock.now += seconds
        self.playback.tick()
        return self.bridge.state.frame


@pytest.fixture
def player(qapp):
    return Player()


def test_frames_follow_the_clock_not_the_ticks(player):
    player.playback.toggle()
    assert player.after(0.5) == 60
    # A slow frame: the next one makes up for it.
    assert player.after(1.5) == 240
    shown = [player.after(0.01) for _ in range(100)]
    assert shown[-1] == 360
    assert shown == sorted(shown)


@pytest.mark.parametrize(("speed", "frame"), [(0.25, 30), (0.5, 60), (1.0, 120)])
def test_speed_is_a_share_of_real_time(player, speed, frame):
    player.bridge.set_ui(speed=speed)
    player.playback.toggle()
    assert player.after(1.0) == frame


def test_it_stops_at_the_end_and_starts_again_at_the_beginning(player):
    player.bridge.document.set_frame(1150)
    player.playback.toggle()
    assert player.after(5) == 1199
    assert not player.bridge.ui.playing
    player.playback.toggle()
    assert player.bridge.state.frame == 0


def test_scrubbing_while_it_plays_goes_on_from_there(player):
    player.playback.toggle()
    player.after(0.5)
    player.bridge.document.set_frame(700)
    player.after(0.0)
    assert player.after(0.5) == 760


def test_the_loop_stays_half_a_second_around_the_flag(player):
    flag = player.bridge.state.queue[1].flag
    player.bridge.document.select_flag(flag.id)
    player.playback.toggle_loop()
    assert player.bridge.ui.playing
    seen = [player.after(0.05) for _ in range(200)]
    assert min(seen) >= flag.start - RATE // 2
    assert max(seen) < flag.end + RATE // 2
    # It went around: some frame was followed by an earlier one.
    assert any(b < a for a, b in pairwise(seen))


def test_the_loop_is_cut_at_the_ends_of_the_take(player):
    item = player.bridge.state.queue[0]
    start, end = loop_span(item, item.flag.end + 3, 10_000.0)
    assert (start, end) == (0, item.flag.end + 3)
    assert loop_span(None, 50, 30.0) == (0, 50)
