"""Live mode: frames arrive, are aligned one by one, and the sitting follows."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Generator
from dataclasses import dataclass

from PySide6.QtCore import QObject, Qt, QTimer, Signal

from mocapstudio.comparison.live import LiveAlignment, LiveState, Note
from mocapstudio.comparison.live_history import LiveHistory
from mocapstudio.comparison.live_setup import live_alignment
from mocapstudio.comparison.online_features import JointRotations
from mocapstudio.comparison.weights import JointWeights
from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.live_bridge import LiveBridge, LiveShown, Phase
from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.messages import Messages
from mocapstudio.motion.errors import FileError, MocapError, SkeletonMismatchError
from mocapstudio.motion.progress import Progress
from mocapstudio.review.comparing import ComparingState, Recording
from mocapstudio.review.live_feeds import Arrived, Feed, StreamFeed, TakeFeed

PATH_FRAMES = 4096
"""Over how many frames the path can be drawn; the rest of a longer action keeps its trace."""

_EVERY_MS = 16
_BUDGET = 0.010
_LONGEST_STEP = 0.1
_DOING = "This could not be aligned live"
_KEY = "live"


@dataclass(frozen=True, eq=False)
class _Prepared:
    live: LiveAlignment
    feed: Feed


def preparing(
    reference: Recording,
    source: Recording | StreamFeed,
    weights: JointWeights | None,
    *,
    rate: float | None,
    wait: bool,
) -> Generator[Progress, None, _Prepared]:
    """Make the alignment, and run it once so that nothing is compiled while frames arrive."""
    yield Progress(0.0, "preparing the live alignment")
    takes = () if isinstance(source, StreamFeed) else (source,)
    live = live_alignment(reference, takes, rate, weights, wait=wait, path_frames=PATH_FRAMES)
    aligner = live.aligner
    features = aligner.reference.features
    feed: Feed
    if isinstance(source, StreamFeed):
        if not isinstance(features, JointRotations):
            raise SkeletonMismatchError("the stream sends joints, the reference holds markers")
        source.settle(features)
        feed = source
    else:
        feed = TakeFeed(source, features)
    yield Progress(0.7, "preparing the live alignment")
    aligner.feed(features.of(reference)[0], 0.0)
    aligner.path()
    live.restart()
    return _Prepared(live, feed)


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
        self._prepared: _Prepared | None = None
        self._performer: Recording | None = None
        self._played, self._looked = 0.0, 0.0
        self._action = 0
        self._frame: int | None = None
        self._notes: Counter[Note] = Counter()
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
        self.hang_up()
        self._stream, self._stream_rate, self._hang_up = stream, rate, hang_up
        self._live.set(streams=True, name=name)
        self.begin()

    def begin(self) -> None:
        """Switch live mode on, from the first frame, or go on waiting for a reference."""
        self._timer.stop()
        self._jobs.cancel(_KEY)
        self._prepared = None
        state = self._bridge.state
        if self._stream is not None and self._stream.ended and state.source is not None:
            # What the stream had to say was heard; now it is the source's turn.
            self.hang_up()
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
        """Want no more of the stream."""
        self._hang_up()
        self._stream = None
        self._live.set(streams=False)

    def stop(self) -> None:
        """Switch live mode off."""
        self._timer.stop()
        self._jobs.cancel(_KEY)
        self._prepared = self._performer = None
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
        ready = self._prepared
        if ready is None:
            return
        ready.live.restart()
        if isinstance(ready.feed, TakeFeed):
            ready.feed.rewind()
            self._played = 0.0
        if self._live.shown.history is not None:
            self._live.shown.history.clear()
        self._forget()
        if not ready.feed.ended:
            self._run()

    def look(self, seconds: float) -> None:
        """Show both as they were so many seconds into the action, while a take stands still."""
        ready, shown = self._prepared, self._live.shown
        still = shown.phase in (Phase.PAUSED, Phase.ENDED)
        now, history = shown.now, shown.history
        if ready is None or history is None or not history.frames or not still:
            return
        if now is None or now.began is None or self._frame is None:
            return
        reference = ready.live.aligner.reference
        at = min(round(seconds * reference.rate), history.frames - 1)
        self._live.set(looked=at / reference.rate)
        matched = int(history.course.at[at // history.stride])
        begin = self._frame - (now.frame - now.began)
        self._bridge.sitting.go_both(reference.own_frame(matched), begin + at)

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

    def _ready(self, prepared: _Prepared) -> None:
        self._prepared = prepared
        self._played = 0.0
        history = LiveHistory(len(prepared.live.aligner.reference))
        self._live.set(alignment=prepared.live, history=history)
        self._run()

    def _fail(self, error: BaseException) -> None:
        self.stop()
        self._messages.complain(error, _DOING)

    def _run(self) -> None:
        paused = self._live.shown.phase is Phase.PAUSED
        # A stream goes on while nobody looks, a take does not.
        if not (paused and self._prepared is not None and not self._prepared.feed.slips):
            self._looked = self._clock()
        self._live.set(phase=Phase.RUNNING, looked=None)
        self._timer.start()

    # -- frames

    def tick(self) -> None:
        """Take in what has arrived by now."""
        if self._prepared is None:
            self._wait_for_rate()
            return
        now = self._clock()
        passed = now - self._looked
        self._looked = now
        live, feed = self._prepared.live, self._prepared.feed
        if feed.slips:
            self._played += min(passed, _LONGEST_STEP) * self._bridge.ui.speed
        else:
            self._played += passed
        changes = self._take_in(live, feed, now + _BUDGET)
        if feed.ended:
            self._timer.stop()
            changes["phase"] = Phase.ENDED
        if changes:
            self._live.set(**changes)
            self._go(self._live.shown)

    def _take_in(self, live: LiveAlignment, feed: Feed, until: float) -> dict[str, object]:
        """Align frames until none is due or the time is up; returns what has changed."""
        changes: dict[str, object] = {}
        latest: Arrived | None = None
        shown = self._live.shown
        frames, faults = shown.frames, shown.faults
        try:
            while (one := feed.due(self._played)) is not None:
                if isinstance(one, FileError):
                    faults += 1
                    changes |= {"faults": faults, "fault": f"line {one.line}: {one.cause}"}
                else:
                    frames += 1
                    latest = one
                    changes |= self._aligned(live, live.feed(one.pose, one.time))
                if self._clock() > until:
                    if feed.slips and latest is not None and latest.time is not None:
                        self._played = min(self._played, latest.time + 1e-6)
                    break
        except MocapError as error:
            self._fail(error)
            return {}
        if latest is not None:
            seconds = latest.time if latest.time is not None else shown.seconds
            changes |= {"frames": frames, "seconds": seconds, "notes": self._noted()}
            self._frame = latest.frame
            if latest.joints is not None:
                self.posed.emit(latest)
        return changes

    def _aligned(self, live: LiveAlignment, state: LiveState) -> dict[str, object]:
        history = self._live.shown.history
        assert history is not None
        if state.note is not None:
            self._notes[state.note] += 1
        anew = state.note is Note.RESTARTED or state.action != self._action
        self._action = state.action
        if anew:
            history.clear()
        changes: dict[str, object] = {"now": state}
        if state.step is not None:
            history.add(state.step, live.aligner.pose_costs)
            changes["step"] = state.step
        elif anew:
            changes["step"] = None
        return changes

    def _go(self, shown: LiveShown) -> None:
        """Move both play heads to where the performer is."""
        sitting, state = self._bridge.sitting, self._bridge.state
        frame = state.frame if shown.step is None else shown.step.reference_frame
        if self._frame is None:
            sitting.go_both(frame, state.source_frame)
        else:
            sitting.go_both(frame, self._frame)

    # -- within

    def _wait_for_rate(self) -> None:
        """Wait until a stream tells how fast it comes."""
        assert self._stream is not None
        told = self._stream.rate()
        if told is not None:
            self._timer.stop()
            self._prepare(None, self._stream_rate or told or None)

    def _forget(self, **changes: object) -> None:
        self._notes.clear()
        self._action, self._frame = 0, None
        self._live.set(
            now=None,
            step=None,
            seconds=None,
            frames=0,
            looked=None,
            notes=(),
            faults=0,
            fault="",
            **changes,
        )

    def _noted(self) -> tuple[tuple[Note, int], ...]:
        return tuple((note, self._notes[note]) for note in Note if self._notes[note])

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
