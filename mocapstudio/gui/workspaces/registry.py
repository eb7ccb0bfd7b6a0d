"""Which workspaces there are. One entry a workspace."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Entry:
    """One workspace, as the switch and the menu show it.

    Parameters
    ----------
    name
        How the code calls it; its command is ``workspace-<name>``.
    text
        As the menu shows it.
    tip
        What is done there.
    key
        Its shortcut.
    icon
        Name of an icon.
    made_by
        ``module:class`` that is called with the window, the first time the workspace is entered;
        empty for the one that is there from the start. A name instead of the class itself: menus
        and views know the workspaces, which know the views.
    """

    name: str
    text: str
    tip: str
    key: str
    icon: str
    made_by: str = ""


# The order is that of the switch.
WORKSPACES = (
    Entry("review", "&Review", "See what is wrong in a take, decide, export",
          "Ctrl+1", "flag"),
    Entry("contacts", "C&ontacts", "Plant the feet, join the hands",
          "Ctrl+2", "link", "mocapstudio.gui.workspaces.contacts:ContactsWorkspace"),
    Entry("compare", "&Compare", "Set performances beside a reference",
          "Ctrl+3", "compare", "mocapstudio.gui.workspaces.compare:CompareWorkspace"),
    Entry("markers", "&Markers", "Fill the gaps of markers, mend their labels",
          "Ctrl+4", "markers", "mocapstudio.gui.workspaces.markers:MarkersWorkspace"),
)  # fmt: skip
