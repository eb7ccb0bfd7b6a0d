"""The transport of the workspace: play, step, frame and time, how fast."""

from __future__ import annotations

from mocapstudio.gui.actions import Actions
from mocapstudio.gui.markers.bridge import MarkersBridge, MarkersShown
from mocapstudio.gui.widgets.speeds import next_speed
from mocapstudio.gui.widgets.transport_bar import TransportBar


class MarkersTransport(TransportBar):
    """The bar below the viewport.

    Parameters
    ----------
    bridge
        What is shown.
    actions
        The commands behind the buttons.
    """

    def __init__(self, bridge: MarkersBridge, actions: Actions) -> None:
        super().__init__(actions, bridge.go, lambda speed: bridge.set(speed=speed), "markers-")
        self._bridge = bridge
        bridge.changed.connect(lambda _old, new: self._show(new))
        self._show(bridge.shown)

    def step_speed(self, by: int) -> None:
        """Play slower or faster."""
        self._bridge.set(speed=next_speed(self._bridge.shown.speed, by))

    def _show(self, new: MarkersShown) -> None:
        self.show_frame(new.result, new.frame)
        self.show_speed(new.speed)
