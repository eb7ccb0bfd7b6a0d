"""The commands of live mode and of the weights."""

from __future__ import annotations

from mocapstudio.gui.command import SEPARATOR, Command

LIVE = (
    Command("compare-live", "&Live Mode",
            "Play the source as if it arrived now, and show where in the reference it is",
            ("Shift+L",), "live", checkable=True),
    Command("live-restart", "&Restart", "Forget the action and begin anew", ("Backspace",),
            "first"),
    Command("live-wait", "&Wait for the Beginning",
            "Wait until the action begins, and after its end for the next; off, the first frame"
            " is its first", ("B",), "defer", checkable=True),
    SEPARATOR,
    Command("weights-open", "Open We&ights…", "Align live with weights that were learnt",
            ("Ctrl+Shift+W",), "open"),
    Command("weights-none", "Without Wei&ghts", "Let all joints count the same", (), "delete"),
    Command("weights-show", "&Show Weights",
            "Show how much each joint counts, on the skeleton and in a panel", ("Shift+W",),
            "weights", checkable=True),
)  # fmt: skip
