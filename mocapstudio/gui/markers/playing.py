"""The running play head of the Markers workspace: real time, frames skipped where drawing lags."""

from __future__ import annotations

import time
from collections.abc import Callable

from PySide6.QtCore import QObject, Qt, QTimer

from mocapstudio.gui.markers.bridge import MarkersBridge, MarkersShown
from mocapstudio.gui.playback import MARGIN

_EVERY_MS = 16


class MarkersPlayback(QObject):
    """Moves the frame while `shown.playing`.

    Parameters
    ----------
    bridge
        Says whether, how fast and over what to play.
    parent
        Qt's parent.
    clock
        Seconds of a monotonic clock; tests give their own.
    """

    def __init__(
        self,
        bridge: MarkersBridge,
        parent: QObject | None = None,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        super().__init__(parent)
        self._bridge, self._clock = bridge, clock
        self._timer = QTimer(self)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.setInterval(_EVERY_MS)
        self._timer.timeout.connect(self.tick)
        self._began, self._from, self._last = 0.0, 0, 0
        bridge.changed.connect(self._follow)

    def toggle(self) -> None:
        """Start or stop; from the end it starts again at the beginning."""
        shown = self._bridge.shown
        if shown.result is None:
            return
        first, end = self._span()
        if not shown.playing and not first <= shown.frame < end - 1:
            self._bridge.go(first)
        self._bridge.set(playing=not shown.playing)

    def toggle_loop(self) -> None:
        """Play the chosen gap and half a second around it over and over, or stop that."""
        looping = not self._bridge.shown.loop
        self._bridge.set(loop=looping, playing=False)
        if looping:
            self.toggle()

    def tick(self) -> None:
        """Show the frame of now."""
        shown = self._bridge.shown
        if shown.result is None:
            self._bridge.set(playing=False)
            return
        if shown.frame != self._last:
            # Somebody scrubbed: go on from there.
            self._restart()
            return
        passed = (self._clock() - self._began) * float(shown.result.rate) * shown.speed
        first, end = self._span()
        frame = self._from + int(passed)
        if frame >= end and shown.loop:
            self._bridge.go(first)
            self._restart()
            return
        self._last = min(frame, end - 1)
        self._bridge.go(self._last)
        if frame >= end:
            self._bridge.set(playing=False)

    def _span(self) -> tuple[int, int]:
        shown = self._bridge.shown
        assert shown.result is not None
        frames = shown.result.frames
        if not shown.loop or shown.span is None:
            return 0, frames
        margin = round(MARGIN * float(shown.result.rate))
        return max(0, shown.span[0] - margin), min(frames, shown.span[1] + margin)

    def _restart(self) -> None:
        self._from = self._last = self._bridge.shown.frame
        self._began = self._clock()

    def _follow(self, old: MarkersShown, new: MarkersShown) -> None:
        other = (new.speed, new.loop, new.span) != (old.speed, old.loop, old.span)
        if new.playing and (not old.playing or other):
            self._restart()
            self._timer.start()
        elif not new.playing:
            self._timer.stop()
