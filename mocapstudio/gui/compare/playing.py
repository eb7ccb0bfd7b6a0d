"""The running play heads: along the warping path, or each performance at its own true speed."""

from __future__ import annotations

import time
from collections.abc import Callable

from PySide6.QtCore import QObject, Qt, QTimer

from mocapstudio.gui.compare.bridge import CompareBridge, CompareUi

_EVERY_MS = 16


class ComparePlayback(QObject):
    """Moves both play heads while `ui.playing`.

    Parameters
    ----------
    bridge
        Its `ui` says whether, how fast and in which way to play.
    parent
        Qt's parent.
    clock
        Seconds of a monotonic clock; tests give their own.
    """

    def __init__(
        self,
        bridge: CompareBridge,
        parent: QObject | None = None,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        super().__init__(parent)
        self._bridge, self._clock = bridge, clock
        self._timer = QTimer(self)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.setInterval(_EVERY_MS)
        self._timer.timeout.connect(self.tick)
        self._began = 0.0
        self._from = (0, 0)
        self._shown = (0, 0)
        bridge.ui_changed.connect(self._follow)

    def toggle(self) -> None:
        """Start or stop; from the end it starts again at the beginning."""
        linked = self._bridge.state.linked
        if linked is None:
            return
        playing = not self._bridge.ui.playing
        if playing:
            self._to_start()
        self._bridge.set_ui(playing=playing)

    def tick(self) -> None:
        """Show the frames of now."""
        state = self._bridge.state
        if state.linked is None:
            self._bridge.set_ui(playing=False)
            return
        if (state.frame, state.source_frame) != self._shown:
            # Somebody scrubbed: go on from there.
            self._restart()
            return
        passed = (self._clock() - self._began) * self._bridge.ui.speed
        frames, ended = self._frames_after(passed)
        self._shown = frames
        self._bridge.sitting.go_both(*frames)
        now = self._bridge.state
        self._shown = now.frame, now.source_frame
        if ended and self._bridge.ui.loop:
            self._to_start(always=True)
            self._restart()
        elif ended:
            self._bridge.set_ui(playing=False)

    def _frames_after(self, passed: float) -> tuple[tuple[int, int], bool]:
        """Frames of both so many seconds after the start, and whether the end is reached."""
        state = self._bridge.state
        linked = state.linked
        assert linked is not None
        last = self._span()[1]
        if self._bridge.ui.along_path:
            at = linked.seconds_at(*self._from) + passed
            frames = linked.at(at)
            return frames, frames[0] >= last or at >= linked.duration
        both = linked.comparison
        frame = self._from[0] + int(passed * float(both.reference_rate))
        source = self._from[1] + int(passed * float(both.source_rate))
        over = frame >= last and source >= linked.source_of(last)
        kept = min(frame, linked.frames[0] - 1), min(source, linked.frames[1] - 1)
        return kept, over or kept == (linked.frames[0] - 1, linked.frames[1] - 1)

    def _span(self) -> tuple[int, int]:
        """First and last reference frame to be played."""
        state = self._bridge.state
        assert state.linked is not None
        if self._bridge.ui.loop and state.segment is not None:
            segment = state.segments[state.segment]
            return segment.start, segment.end - 1
        return 0, state.linked.frames[0] - 1

    def _to_start(self, *, always: bool = False) -> None:
        first, last = self._span()
        if always or not first <= self._bridge.state.frame < last:
            self._bridge.sitting.go(first)

    def _restart(self) -> None:
        state = self._bridge.state
        self._from = self._shown = state.frame, state.source_frame
        self._began = self._clock()

    def _follow(self, old: CompareUi, new: CompareUi) -> None:
        began = new.playing and not old.playing
        other = (new.speed, new.along_path, new.loop) != (old.speed, old.along_path, old.loop)
        if new.playing and (began or other):
            self._restart()
            self._timer.start()
        elif not new.playing:
            self._timer.stop()
