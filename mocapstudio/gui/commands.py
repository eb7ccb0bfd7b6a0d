"""Every command of the desk: its words, keys and icon, and the menu it stands in."""

from __future__ import annotations

from mocapstudio.gui.command import SEPARATOR, Command
from mocapstudio.gui.compare.commands import COMPARE, SEGMENTS
from mocapstudio.gui.compare.live_commands import LIVE
from mocapstudio.gui.contacts.commands import CONTACTS
from mocapstudio.gui.markers.commands import MARKERS
from mocapstudio.gui.workspaces.registry import WORKSPACES

__all__ = ["COMMANDS", "HOMES", "MENUS", "SEPARATOR", "Command"]

FILE = (
    Command("open", "&Open…", "Open takes or a session", ("Ctrl+O",), "open"),
    Command("recent", "Open &Recent", "Open something from before"),
    Command("new", "&New Session", "Close everything and begin anew", ("Ctrl+N",)),
    Command("partner", "Add &Partner…", "Show another performer in the same scene",
            ("Ctrl+Shift+O",), "partner"),
    Command("context", "Conte&xt…", "Choose the takes that are searched for neighbours",
            ("Ctrl+K",), "context"),
    SEPARATOR,
    Command("save", "&Save Session", "Save decisions and edits as a session", ("Ctrl+S",), "save"),
    Command("save-as", "Save Session &As…", "Save the session under another name",
            ("Ctrl+Shift+S",)),
    Command("export", "&Export Clean Take…",
            "Write the take with the accepted repairs; nothing else changes",
            ("Ctrl+E",), "export"),
    Command("report", "Wri&te Report…", "Write what was found and decided as a web page",
            icon="report"),
    SEPARATOR,
    Command("import-report", "&Import Report…",
            "See what was odd about the files that are open, and read them otherwise",
            ("Ctrl+I",), "info"),
    Command("close-take", "&Close Take", "Remove the take under review from the scene",
            ("Ctrl+W",)),
    Command("quit", "&Quit", "Leave the desk", ("Ctrl+Q",)),
)  # fmt: skip

EDIT = (
    Command("undo", "&Undo", "Take the last decision back", ("Ctrl+Z",), "undo"),
    Command("redo", "&Redo", "Do again what was taken back", ("Ctrl+Y", "Ctrl+Shift+Z"), "redo"),
    SEPARATOR,
    Command("find", "&Find in Queue", "Type to filter the queue", ("Ctrl+F",), "search"),
    Command("select-all", "Select &All in Queue", "Select every flag that the queue shows",
            ("Ctrl+A",)),
    Command("deselect", "&Deselect", "Select nothing", ("Esc",)),
)  # fmt: skip

FLAG = (
    Command("next", "&Next", "Go to the next flag in the queue", ("N",), "next"),
    Command("previous", "&Previous", "Go to the previous flag in the queue", ("P",), "previous"),
    SEPARATOR,
    Command("accept", "&Accept", "Accept the proposal and go on to the next open flag",
            ("A",), "accept"),
    Command("reject", "&Reject", "Reject the flag, the motion is right; go on to the next open one",
            ("R",), "reject"),
    Command("defer", "&Defer", "Leave the flag for later and go on to the next open flag",
            ("D",), "defer"),
    Command("reopen", "Re&open", "Take the verdict back; an accepted repair is removed",
            ("U",), "reopen"),
    Command("reject-like", "Reject &Like This",
            "Reject all open flags of this joint and kind with a similar score",
            ("Shift+R",), "reject-like"),
    SEPARATOR,
    Command("keep-ends", "&Keep Hands and Feet",
            "Bend proposals so that hands and feet stay where they were, or on their contacts",
            ("H",), checkable=True),
    SEPARATOR,
    Command("protect", "Pro&tect", "Let nothing change the selected joints in the selected span",
            ("Shift+P",), "protect"),
    Command("unprotect", "&Unprotect", "Lift the protection of the selected joints and span",
            ("Shift+U",), "unprotect"),
    Command("edit", "&Edit Repair", "Show the repair in the list of edits: mute or delete it",
            ("E",), "edit"),
)  # fmt: skip

NEIGHBOURS = (
    *(
        Command(f"neighbour-{k}", f"Neighbour &{k}",
                f"Preview the motion of neighbour {k} as the proposal", (str(k),))
        for k in range(1, 6)
    ),
    Command("neighbour-0", "Best &Proposal", "Go back to the proposal the analysis would choose",
            ("0",)),
    SEPARATOR,
    Command("neighbour-alignment", "Show the &Alignment…",
            "Show how the previewed neighbour answers to the flagged span, pose by pose", ("X",),
            "matrix"),
)  # fmt: skip

ANALYSIS = (
    Command("analyse", "&Analyse", "Look for flags in the take under review", ("F5",), "analyse"),
    Command("cancel", "&Cancel", "Stop what is running", ("Ctrl+.",), "cancel"),
    SEPARATOR,
    Command("threshold-up", "&Raise Threshold", "Flag less (by 0.02)", ("+", "=")),
    Command("threshold-down", "&Lower Threshold", "Flag more (by 0.02)", ("-",)),
    SEPARATOR,
    Command("learning", "L&earn from the Context",
            "Refine the first map by what is learnt from the context; takes a while once",
            checkable=True),
    SEPARATOR,
    Command("calibrated", "Cali&brated",
            "Scale each joint by what is normal for it in this context", checkable=True),
    Command("paper", "As in the &Paper",
            "Scale each joint by its mean departure, as published; flags far more", checkable=True),
)  # fmt: skip

PLAY = (
    Command("play", "&Play", "Play or stop", ("Space",), "play"),
    Command("frame-back", "Frame &Back", "One frame back", ("Left",), "previous"),
    Command("frame-on", "Frame &On", "One frame on", ("Right",), "next"),
    Command("ten-back", "Ten Frames Back", "Ten frames back", ("Shift+Left",)),
    Command("ten-on", "Ten Frames On", "Ten frames on", ("Shift+Right",)),
    Command("first", "&First Frame", "Go to the first frame", ("Home",), "first"),
    Command("last", "&Last Frame", "Go to the last frame", ("End",), "last"),
    SEPARATOR,
    Command("loop", "Loop the Fla&g", "Play the flag and half a second around it, over and over",
            ("L",), "loop", checkable=True),
    Command("slower", "&Slower", "Play at ½, then at ¼ of real time", ("[",)),
    Command("faster", "F&aster", "Play at ½, then in real time", ("]",)),
    SEPARATOR,
    Command("trim-in", "Trim &In", "Start analysis and report at this frame", ("I",), "trim-in"),
    Command("trim-out", "Trim O&ut", "End analysis and report with this frame", ("O",), "trim-out"),
    Command("trim-clear", "&Clear Trim", "Look at the whole take again", ("Shift+I",)),
)  # fmt: skip

VIEW = (
    Command("ghosts", "&Ghosts", "Show the proposal beside the take", ("G",), "ghost",
            checkable=True),
    Command("follow", "F&ollow", "Keep the performer in the middle of the viewport", ("C",),
            "follow", checkable=True),
    Command("trails", "&Trails", "Show the paths of hands and feet", ("T",), "curves",
            checkable=True),
    Command("onion", "Onion S&kins",
            "Show the selected limb, or the body, some frames before and after", ("Shift+G",),
            "onion", checkable=True),
    Command("frame-joint", "&Frame the Joint", "Move the camera to the selected joint", ("F",),
            "frame"),
    Command("zoom-flag", "&Zoom to the Flag", "Zoom map and curves to the selected flag", ("Z",),
            "search"),
    Command("whole-take", "&Whole Take", "Show the whole take on map and curves", ("Shift+Z",)),
    SEPARATOR,
    Command("view-queue", "&Queue", "Show the queue", ("F6",), checkable=True),
    Command("view-inspector", "&Inspector", "Show the inspector", ("F7",), checkable=True),
    Command("view-map", "Digression &Map", "Show the digression map", ("F8",), checkable=True),
    Command("view-curves", "&Curves", "Show the curves", ("F9",), checkable=True),
    SEPARATOR,
    Command("distances", "&Distance over Time",
            "Show how far the flagged span is from every other place, in the place of the curves",
            ("Shift+F9",), "neighbours", checkable=True),
    Command("beside-texture", "Motion Te&xture",
            "Show the rotations of the joints as colours under the map", ("Shift+F8",),
            checkable=True),
    Command("beside-map", "Map of &Another Context",
            "Show what the map would be with another context, under the map", ("Ctrl+F8",),
            checkable=True),
    SEPARATOR,
    Command("reset-layout", "&Reset Layout", "Put all parts back where they came from"),
    SEPARATOR,
    Command("theme", "&Light Theme", "Switch between dark and light", (), "theme", checkable=True),
    Command("full-screen", "F&ull Screen", "Fill the screen", ("F11",), checkable=True),
)  # fmt: skip

WORKSPACE = tuple(
    Command(f"workspace-{one.name}", one.text, one.tip, (one.key,), one.icon, checkable=True)
    for one in WORKSPACES
)

HELP = (
    Command("shortcuts", "&Keyboard Shortcuts", "Show all keys", ("F1", "?"), "keyboard"),
    Command("about", "&About mocapstudio", "Version and licence", (), "info"),
)

MENUS = {
    "&File": FILE,
    "&Edit": EDIT,
    "Fla&g": FLAG,
    "&Neighbour": NEIGHBOURS,
    "&Analysis": ANALYSIS,
    "Co&ntacts": CONTACTS,
    "&Compare": COMPARE,
    "&Segments": SEGMENTS,
    "&Live": LIVE,
    "&Markers": MARKERS,
    "&Play": PLAY,
    "&View": VIEW,
    "&Workspace": WORKSPACE,
    "&Help": HELP,
}

HOMES = {"Fla&g": ("review",), "&Neighbour": ("review",), "&Analysis": ("review",),
         "Co&ntacts": ("contacts",),
         "&Markers": ("markers",),
         "&Compare": ("compare",), "&Segments": ("compare",), "&Live": ("compare",)}  # fmt: skip
"""Menus that belong to some workspaces only, by title."""

COMMANDS = {one.name: one for menu in MENUS.values() for one in menu if one is not SEPARATOR}
