"""What live mode knows at one moment, and the Qt signal that tells of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any

from PySide6.QtCore import QObject, Signal

from mocapstudio.comparison.live import LiveAlignment, LiveState, Note
from mocapstudio.comparison.live_history import LiveHistory
from mocapstudio.comparison.online import AlignmentStep
from mocapstudio.comparison.weights import JointWeights


class Phase(StrEnum):
    """What live mode is doing."""

    OFF = "off"
    PREPARING = "preparing"
    RUNNING = "running"
    PAUSED = "paused"
    ENDED = "ended"


@dataclass(frozen=True, eq=False)
class LiveShown:
    """What live mode shows.

    Parameters
    ----------
    phase
        What it is doing.
    name
        Who performs.
    streams
        Whether she comes by standard input, and is not a take.
    wait
        Whether the action's beginning is waited for.
    weights, weights_file
        What joints count, and the name of the file that says so; None for no difference.
    weights_shown
        Whether they are shown on the skeleton and in a panel.
    alignment, history
        What is fed, and the course of the action so far; None before they are prepared.
    now
        What the latest frame gave, or None before the first.
    step
        Where the performer was when she was last seen in this action, or None.
    seconds
        On the performer's own clock, or None.
    frames
        How many arrived.
    looked
        Seconds of the action that are looked back at while it stands still, or None.
    notes
        How often something was odd about a frame, by what.
    faults, fault
        How many lines could not be read; which was the latest, and what is wrong with it.
    """

    phase: Phase = Phase.OFF
    name: str = ""
    streams: bool = False
    wait: bool = True
    weights: JointWeights | None = None
    weights_file: str = ""
    weights_shown: bool = False
    alignment: LiveAlignment | None = None
    history: LiveHistory | None = None
    now: LiveState | None = None
    step: AlignmentStep | None = None
    seconds: float | None = None
    frames: int = 0
    looked: float | None = None
    notes: tuple[tuple[Note, int], ...] = ()
    faults: int = 0
    fault: str = ""

    @property
    def on(self) -> bool:
        """Whether live mode is what the workspace shows."""
        return self.phase is not Phase.OFF


class LiveBridge(QObject):
    """Holds what live mode shows; views read `shown` and follow `changed`."""

    changed = Signal(object, object)
    """Emitted with the old and the new `LiveShown`."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._shown = LiveShown()

    @property
    def shown(self) -> LiveShown:
        """What live mode shows now."""
        return self._shown

    def set(self, **changes: Any) -> None:
        """Show something else; equal values are not announced."""
        old = self._shown
        if all(getattr(old, name) == value for name, value in changes.items()):
            return
        self._shown = replace(old, **changes)
        self.changed.emit(old, self._shown)
