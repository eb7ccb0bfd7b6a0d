"""The running play head: real time at the take's rate, frames skipped where drawing is slower."""

from __future__ import annotations

import time
from collections.abc import Callable

from PySide6.QtCore import QObject, Qt, QTimer

from mocapstudio.gui.document import DocumentBridge, UiState
from mocapstudio.review.model import QueueItem

SPEEDS = (0.25, 0.5, 1.0)
MARGIN = 0.5
"""Seconds played before and after the looped flag."""


def loop_span(item: QueueItem | None, frames: int, rate: float) -> tuple[int, int]:
    """Return the half-open span to play: the flag and half a second around it, or all frames."""
    if item is None:
        return 0, frames
    margin = round(MARGIN * rate)
    return max(0, item.flag.start - margin), min(frames, item.flag.end + margin)


class Playback(QObject):
    """Moves the document's frame while `ui.playing`.

    Parameters
    ----------
    bridge
        Its `ui` says whether, how fast and over what to play.
    parent
        Qt's parent.
    clock
        Seconds of a monotonic clock; tests give their own.
    """

    def __init__(
        self,
        bridge: DocumentBridge,
        parent: QObject | None = None,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        super().__init__(parent)
        self._bridge = bridge
        self._clock = clock
        self._timer = QTimer(self)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self.tick)
        self._origin = (0.0, 0)
        self._shown = 0
        bridge.ui_changed.connect(self._follow)

    def toggle(self) -> None:
        """Start or stop; from the last frame it starts again at the first."""
        take = self._bridge.state.take
        if take is None:
            return
        playing = not self._bridge.ui.playing
        if playing:
            start, end = self._span()
            if not start <= self._bridge.state.frame < end - 1:
                self._bridge.document.set_frame(start)
        self._bridge.set_ui(playing=playing)

    def toggle_loop(self) -> None:
        """Play the selected flag over and over, or stop that."""
        if self._bridge.ui.loop:
            self._bridge.set_ui(loop=False, playing=False)
            return
        self._bridge.set_ui(loop=True)
        if not self._bridge.ui.playing:
            self.toggle()

    def tick(self) -> None:
        """Show the frame of now."""
        state = self._bridge.state
        if state.take is None:
            self._bridge.set_ui(playing=False)
            return
        if state.frame != self._shown:
            # Somebody scrubbed or chose another flag: go on from there.
            self._restart()
            return
        began, first = self._origin
        passed = (self._clock() - began) * float(state.take.rate) * self._bridge.ui.speed
        start, end = self._span()
        frame = first + int(passed)
        if frame < start:
            self._origin = (self._clock(), start)
            frame = start
        elif frame >= end:
            if not self._bridge.ui.loop:
                self._show(end - 1)
                self._bridge.set_ui(playing=False)
                return
            self._origin = (self._clock(), start)
            frame = start
        self._show(frame)

    def _show(self, frame: int) -> None:
        self._shown = frame
        self._bridge.document.set_frame(frame)

    def _span(self) -> tuple[int, int]:
        state = self._bridge.state
        assert state.take is not None
        item = state.selected if self._bridge.ui.loop else None
        if item is None and self._bridge.ui.loop and state.selection.span is not None:
            return state.selection.span
        return loop_span(item, state.take.frames, float(state.take.rate))

    def _restart(self) -> None:
        self._shown = self._bridge.state.frame
        self._origin = (self._clock(), self._shown)

    def _follow(self, old: UiState, new: UiState) -> None:
        if new.playing and (not old.playing or old.speed != new.speed or old.loop != new.loop):
            take = self._bridge.state.take
            rate = 60.0 if take is None else float(take.rate) * new.speed
            self._restart()
            # No screen shows more than about sixty frames a second.
            self._timer.start(max(16, round(1000 / rate)))
        elif not new.playing:
            self._timer.stop()
