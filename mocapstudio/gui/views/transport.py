"""The transport: play, step, frame and time, speed, loop."""

from __future__ import annotations

from mocapstudio.gui.actions import Actions
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.widgets.speeds import next_speed
from mocapstudio.gui.widgets.transport_bar import TransportBar
from mocapstudio.review.state import DocumentState


class TransportView(TransportBar):
    """The bar between viewport and digression map.

    Parameters
    ----------
    bridge
        The document's door.
    actions
        The commands behind the buttons.
    """

    def __init__(self, bridge: DocumentBridge, actions: Actions) -> None:
        super().__init__(
            actions,
            lambda frame: bridge.document.set_frame(frame),
            lambda speed: bridge.set_ui(speed=speed),
        )
        self._bridge = bridge
        bridge.changed.connect(lambda _old, new: self._show(new))
        bridge.ui_changed.connect(lambda _old, new: self.show_speed(new.speed))
        self._show(bridge.state)
        self.show_speed(bridge.ui.speed)

    def step_speed(self, by: int) -> None:
        """Play slower or faster."""
        self._bridge.set_ui(speed=next_speed(self._bridge.ui.speed, by))

    def _show(self, state: DocumentState) -> None:
        self.show_frame(state.take, state.frame)
