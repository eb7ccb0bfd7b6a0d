"""What the Compare workspace shows before there is anything to compare."""

from __future__ import annotations

from mocapstudio.gui.actions import Actions
from mocapstudio.gui.widgets.invitation import Invitation


class EmptyCompare(Invitation):
    """Says what is compared with what, and how to begin.

    Parameters
    ----------
    actions
        The commands behind the buttons.
    """

    def __init__(self, actions: Actions) -> None:
        buttons = (
            ("compare-reference", "Reference…"),
            ("compare-sources", "Sources…"),
            ("compare-scene", "From the review"),
        )
        made = {name: actions.push_button(name, text) for name, text in buttons}
        super().__init__("compare", 620, 3, list(made.values()))
        self._buttons = made
        self.tell("")

    def tell(self, reference: str) -> None:
        """Say what is missing: everything, or what to compare with the reference."""
        title = "Set a performance beside another"
        words = (
            "Drop the reference here first, then up to eight performances of the same movement:"
            " joints (BVH, ASF/AMC) or markers (C3D, TRC). They are aligned in time, and shown"
            " early, late and different, moment by moment."
        )
        primary = "compare-reference"
        if reference:
            title = f"Compare with {reference}"
            words = "Drop performances of the same movement here, up to eight of them."
            primary = "compare-sources"
        self.say(title, words)
        for name, button in self._buttons.items():
            button.setProperty("role", "primary" if name == primary else "")
            button.style().unpolish(button)
            button.style().polish(button)
