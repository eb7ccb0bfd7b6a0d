"""The commands of the Contacts workspace."""

from __future__ import annotations

from mocapstudio.gui.command import SEPARATOR, Command

CONTACTS = (
    Command("contacts-detect", "&Detect", "Find what feet and hands touch; what was drawn stays",
            ("F5",), "analyse"),
    Command("contacts-solve", "&Solve",
            "Bend the motion so that every contact is met; one step to undo", ("Ctrl+Return",),
            "solve"),
    Command("contacts-around", "Solve Aro&und Repairs",
            "Meet contacts only around accepted repairs; they are detected first if there are none",
            ("Ctrl+Shift+Return",)),
    Command("contacts-unsolve", "&Remove What Was Solved",
            "Take out all edits that meet contacts; the contacts stay"),
    SEPARATOR,
    Command("contacts-next", "&Next Contact", "Go to the next contact", ("N",), "next"),
    Command("contacts-previous", "&Previous Contact", "Go to the previous contact", ("P",),
            "previous"),
    Command("contacts-begin", "&Begin Here", "Let the chosen contact begin at this frame", (",",)),
    Command("contacts-end", "&End Here", "Let the chosen contact end with this frame", (".",)),
    Command("contacts-split", "Spli&t Here", "Cut the chosen contact in two at this frame", ("S",)),
    Command("contacts-merge", "&Merge", "Make one of the chosen contacts of one point", ("M",)),
    Command("contacts-delete", "De&lete", "Delete the chosen contacts", ("Del",), "delete"),
    SEPARATOR,
    Command("contacts-snap", "Sn&ap",
            "Let a dragged target snap to the floor and to a partner's joints", ("Shift+S",),
            "snap", checkable=True),
    Command("contacts-pose", "&Key Pose",
            "Drag hands and feet themselves in the viewport: an edit that fades out in time",
            ("B",), "edit", checkable=True),
    SEPARATOR,
    Command("contacts-load", "L&oad Contacts…", "Take the contacts from a JSON file",
            ("Ctrl+Shift+I",)),
    Command("contacts-save", "Sa&ve Contacts As…", "Write the contacts as a JSON file",
            ("Ctrl+Shift+E",)),
)  # fmt: skip
