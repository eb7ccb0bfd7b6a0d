"""What the Markers workspace shows before a take of markers is open."""

from __future__ import annotations

from mocapstudio.gui.actions import Actions
from mocapstudio.gui.widgets.invitation import Invitation


class EmptyMarkers(Invitation):
    """Says what is done here, and how to begin.

    Parameters
    ----------
    actions
        The commands behind the buttons.
    """

    def __init__(self, actions: Actions) -> None:
        super().__init__("markers", 560, 2, [actions.push_button("open", "Open…")])
        self.say(
            "Drop markers here",
            "C3D, TRC or tables: see where markers are missing, fill the gaps, exchange labels that"
            " were swapped, and write the take back with nothing else changed.",
        )
