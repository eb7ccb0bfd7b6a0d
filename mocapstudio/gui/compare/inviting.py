"""Brings the performer of a stream on stage, and keeps her standing beside the reference."""

from __future__ import annotations

from PySide6.QtCore import QObject

from mocapstudio.gui.compare.bridge import Alignment, CompareBridge
from mocapstudio.gui.compare.guest import Guest
from mocapstudio.gui.compare.live_bridge import LiveBridge, LiveShown
from mocapstudio.gui.compare.live_mode import LiveMode
from mocapstudio.gui.compare.stage import StageView
from mocapstudio.motion.take import Take
from mocapstudio.review.live_feeds import Arrived


class Inviting(QObject):
    """Poses a guest as frames of a stream arrive.

    Parameters
    ----------
    bridge, live, mode
        Tell of the reference, of what is aligned, and of frames.
    stage
        Where she is drawn.
    """

    def __init__(
        self, bridge: CompareBridge, live: LiveBridge, mode: LiveMode, stage: StageView
    ) -> None:
        super().__init__(stage)
        self._bridge, self._live, self._stage = bridge, live, stage
        self._guest: Guest | None = None
        self._stood: tuple[object, ...] | None = None
        mode.posed.connect(self._pose)
        live.changed.connect(self._follow)

    def _pose(self, frame: Arrived) -> None:
        if self._guest is not None and frame.joints is not None:
            self._guest.pose(frame.joints, frame.root)
            self._guest.seconds = frame.time

    def _follow(self, old: LiveShown, new: LiveShown) -> None:
        wanted = new.on and new.streams
        reference = self._bridge.state.reference
        if not wanted and self._guest is not None:
            self._invite(None)
        there = None if self._guest is None else self._guest.take
        if wanted and isinstance(reference, Take) and there is not reference:
            self._invite(self._stage.guest_of(reference, new.name))
        if self._guest is not None and new.now is not old.now:
            self._stand(new)
            self._stage.stir()

    def _invite(self, guest: Guest | None) -> None:
        self._guest, self._stood = guest, None
        self._stage.invite(guest)

    def _stand(self, shown: LiveShown) -> None:
        assert self._guest is not None
        alignment = self._bridge.ui.alignment
        at = 0 if shown.step is None else shown.step.reference_frame
        if alignment is Alignment.THROUGHOUT:
            self._guest.stand(at)
            return
        # Once an action, so that where she goes can be seen.
        action = None if shown.now is None else shown.now.action
        key = (alignment, self._bridge.ui.anchor, action, shown.step is None)
        if key != self._stood:
            self._stood = key
            self._guest.stand(None if alignment is Alignment.RECORDED else at)
