"""Live mode: what the user asks of it, and the clock that lets frames arrive."""

from __future__ import annotations

import time
from collections.abc import Callable

from PySide6.QtCore import QObject, Qt, QTimer, Signal

from mocapstudio.comparison.weights import JointWeights
from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.live_bridge import LiveBridge, LiveShown, Phase
from mocapstudio.gui.compare.live_intake import Intake, preparing
from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.messages import Messages
from mocapstudio.motion.errors import MocapError
from mocapstudio.review.comparing import ComparingState, Recording
from mocapstudio.review.live_feeds import StreamFeed

_EVERY_MS = 16
_BUDGET = 0.010
_DOING = "This could not be aligned live"
_KEY = "live"


class LiveMode(QObject):
    """Feeds the online alignment while live mode is on.

    Parameters
    ----------
    bridge
        Names reference and source; its play heads follow.
    live
        Is told what came of each frame.
    jobs, messages
        Run the preparation, and are told what went wrong.
    parent
        Qt's parent.
    clock
        Seconds of a monotonic clock; tests give their own.
    """

    posed = Signal(object)
    """Emitted with the `Arrived` of a stream before the state that it gave."""

    def __init__(
        self,
        bridge: CompareBridge,
        live: LiveBridge,
        jobs: Jobs,
        messages: Messages,
        parent: QObject | None = None,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        super().__init__(parent)
        self._bridge, self._live, self._jobs, self._messages = bridge, live, jobs, messages
        self._clock = clock
        self._stream: StreamFeed | None = None
        self._stream_rate: float | None = None
        self._hang_up: Callable[[], object] = lambda: None
        self._intake: Intake | None = None
        self._performer: Recording | None = None
        self._looked = 0.0
        self._timer = QTimer(self)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.setInterval(_EVERY_MS)
        self._timer.timeout.connect(self.tick)
        bridge.changed.connect(self._follow)

    # -- what the user asks for

    @property
    def possible(self) -> bool:
        """Whether there is a reference, and somebody who performs."""
        state = self._bridge.state
        return state.reference is not None and (
            self._stream is not None or state.source is not None
        )

    def listen(
        self,
        stream: StreamFeed,
        name: str,
        rate: float | None = None,
        hang_up: Callable[[], object] = lambda: None,
    ) -> None:
        """Let a stream perform, at `rate` frames a second or what its first frames tell.

        `hang_up` is called when no more is wanted of it.
        """
        self._let_go()
        self._stream, self._stream_rate, self._hang_up = stream, rate, hang_up
        self._live.set(streams=True, name=name)
        self.begin()

    def begin(self) -> None:
        """Switch live mode on, from the first frame, or go on waiting for a reference."""
        self._timer.stop()
        self._jobs.cancel(_KEY)
        self._intake = None
        state = self._bridge.state
        if self._stream is not None and self._stream.ended and state.source is not None:
            # What the stream had to say was heard; now it is the source's turn.
            self._let_go()
        if state.reference is None or not self.possible:
            return
        self._bridge.set_ui(playing=False)
        if self._stream is None:
            assert state.source is not None
            self._performer = state.source.take
            self._live.set(name=state.source.id)
        self._forget(phase=Phase.PREPARING, alignment=None, history=None)
        if self._stream is None:
            self._prepare(self._performer, None)
        else:
            self._timer.start()

    def hang_up(self) -> None:
        """Want no more of the stream, if there is one; live mode ends with it."""
        if self._stream is not None:
            self._let_go()
            self.stop()

    def stop(self) -> None:
        """Switch live mode off."""
        self._timer.stop()
        self._jobs.cancel(_KEY)
        self._intake = self._performer = None
        self._forget(phase=Phase.OFF, alignment=None, history=None)

    def switch(self) -> None:
        """Switch live mode on or off."""
        if self._live.shown.on:
            self.stop()
        else:
            self.begin()

    def toggle(self) -> None:
        """Pause or go on; at the end of a take begin anew."""
        phase = self._live.shown.phase
        if phase is Phase.RUNNING:
            self._timer.stop()
            self._live.set(phase=Phase.PAUSED)
        elif phase is Phase.PAUSED:
            self._run()
        elif phase is Phase.ENDED:
            self.restart()

    def pause(self) -> None:
        """Stop taking frames in for now."""
        if self._live.shown.phase is Phase.RUNNING:
            self.toggle()

    def restart(self) -> None:
        """Forget the action; a take is played from its beginning."""
        if self._intake is None:
            return
        self._intake.restart()
        self._forget()
        if not self._intake.feed.ended:
            self._run()

    def look(self, seconds: float) -> None:
        """Show both as they were so many seconds into the action, while a take stands still."""
        shown = self._live.shown
        if self._intake is None or shown.phase not in (Phase.PAUSED, Phase.ENDED):
            return
        found = None if shown.now is None else self._intake.frames_at(seconds, shown.now)
        if found is not None:
            frame, source_frame, kept = found
            self._live.set(looked=kept)
            self._bridge.sitting.go_both(frame, source_frame)

    def set_wait(self, wait: bool) -> None:
        """Wait for the action's beginning or not; begins anew where live mode is on."""
        self._live.set(wait=wait)
        self._again()

    def use(self, weights: JointWeights | None, file: str = "") -> None:
        """Align with other weights; begins anew where live mode is on."""
        self._live.set(weights=weights, weights_file=file)
        self._again()

    def _again(self) -> None:
        if self._live.shown.on:
            self.begin()

    # -- preparing

    def _prepare(self, source: Recording | None, rate: float | None) -> None:
        state, shown = self._bridge.state, self._live.shown
        performer = source if source is not None else self._stream
        assert state.reference is not None
        assert performer is not None
        if source is not None:
            rate = float(source.rate)
        work = preparing(state.reference, performer, shown.weights, rate=rate, wait=shown.wait)
        title = "Preparing the live alignment"
        self._jobs.start(title, work, self._ready, self._fail, key=_KEY)

    def _ready(self, intake: Intake) -> None:
        self._intake = intake
        self._live.set(alignment=intake.live, history=intake.history)
        self._run()

    def _fail(self, error: BaseException) -> None:
        self.stop()
        self._messages.complain(error, _DOING)

    def _run(self) -> None:
        paused = self._live.shown.phase is Phase.PAUSED
        # A stream goes on while nobody looks, a take does not.
        if not (paused and self._intake is not None and not self._intake.feed.slips):
            self._looked = self._clock()
        self._live.set(phase=Phase.RUNNING, looked=None)
        self._timer.start()

    # -- frames

    def tick(self) -> None:
        """Take in what has arrived by now."""
        if self._intake is None:
            self._wait_for_rate()
            return
        intake, now = self._intake, self._clock()
        intake.pass_time(now - self._looked, self._bridge.ui.speed)
        self._looked = now
        try:
            changes, latest = intake.take_in(lambda: self._clock() > now + _BUDGET)
        except MocapError as error:
            self._fail(error)
            return
        if latest is not None and latest.joints is not None:
            self.posed.emit(latest)
        if intake.feed.ended:
            self._timer.stop()
            changes["phase"] = Phase.ENDED
        if changes:
            self._live.set(**changes)
            self._go(self._live.shown, intake.frame)

    def _go(self, shown: LiveShown, source_frame: int | None) -> None:
        """Move both play heads to where the performer is."""
        sitting, state = self._bridge.sitting, self._bridge.state
        frame = state.frame if shown.step is None else shown.step.reference_frame
        sitting.go_both(frame, state.source_frame if source_frame is None else source_frame)

    # -- within

    def _let_go(self) -> None:
        self._hang_up()
        self._stream, self._hang_up = None, lambda: None
        self._live.set(streams=False)

    def _wait_for_rate(self) -> None:
        """Wait until a stream tells how fast it comes."""
        assert self._stream is not None
        told = self._stream.rate()
        if told is not None:
            self._timer.stop()
            self._prepare(None, self._stream_rate or told or None)

    def _forget(self, **changes: object) -> None:
        blank = LiveShown()
        names = ("now", "step", "seconds", "frames", "looked", "notes", "faults", "fault")
        self._live.set(**{name: getattr(blank, name) for name in names}, **changes)

    def _follow(self, old: ComparingState, new: ComparingState) -> None:
        other = new.reference is not old.reference
        if self._stream is not None:
            if other and new.reference is not None:
                self.begin()
            elif other:
                self.stop()
            return
        if not self._live.shown.on:
            return
        take = None if new.source is None else new.source.take
        if new.reference is None or take is None:
            self.stop()
        elif other or take is not self._performer:
            self.begin()
