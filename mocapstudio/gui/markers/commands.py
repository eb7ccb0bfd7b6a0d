"""The commands of the Markers workspace."""

from __future__ import annotations

from mocapstudio.gui.command import SEPARATOR, Command
from mocapstudio.review.marker_fills import METHODS

FILLS = tuple(
    Command(f"markers-fill-{one.name}", f"Fill by &{number} {one.words.capitalize()}",
            f"Fill this gap: {one.tip}", (str(number),),
            "curves" if number == 1 else "")
    for number, one in enumerate(METHODS, 1)
)  # fmt: skip
"""One command a method."""

MARKERS = (
    Command("markers-next", "&Next Gap", "Go to the next gap in time", ("N",), "next"),
    Command("markers-previous", "&Previous Gap", "Go to the gap before", ("P",), "previous"),
    SEPARATOR,
    *FILLS,
    Command("markers-fill-all", "Fill All S&hort Gaps",
            "Fill every gap up to the length that stands in the inspector, by the best available",
            ("Shift+A",), "accept"),
    SEPARATOR,
    Command("markers-exchange", "E&xchange with…",
            "Exchange the labels of this marker and another one", ("X",), "swap"),
    Command("markers-clear", "Take &Away",
            "Take the samples of this marker away in the selected span, which leaves a gap",
            ("Del",), "delete"),
    Command("markers-take-back", "Take &Back", "Undo what was edited of this marker here",
            ("U",), "reopen"),
    Command("markers-protect", "Pro&tect",
            "Let nothing change the chosen marker, or all, in the chosen span", ("Shift+P",),
            "protect"),
    Command("markers-unprotect", "&Unprotect",
            "Lift the protection of the chosen marker, in the chosen span or everywhere",
            ("Shift+U",), "unprotect"),
    SEPARATOR,
    Command("markers-solve", "&Solve to a Skeleton…",
            "Fit the joints of a skeleton to the markers and open them for review",
            ("F5",), "solve"),
    Command("markers-compare", "&Compare…", "Set these markers beside another performance",
            icon="compare"),
)  # fmt: skip
