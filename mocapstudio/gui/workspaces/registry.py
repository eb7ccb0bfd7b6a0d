"""Which workspaces there are. One entry a workspace."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mocapstudio.gui.main_window import MainWindow
    from mocapstudio.gui.workspaces.workspace import Workspace


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
    make
        Builds it, the first time it is entered.
    """

    name: str
    text: str
    tip: str
    key: str
    icon: str
    make: Callable[[MainWindow], Workspace]


def _review(window: MainWindow) -> Workspace:
    return window.workspace


def _contacts(window: MainWindow) -> Workspace:
    from mocapstudio.gui.workspaces.contacts import ContactsWorkspace

    return ContactsWorkspace(window)


def _compare(window: MainWindow) -> Workspace:
    from mocapstudio.gui.workspaces.compare import CompareWorkspace

    return CompareWorkspace(window)


# The order is that of the switch.
WORKSPACES = (
    Entry("review", "&Review", "See what is wrong in a take, decide, export",
          "Ctrl+1", "flag", _review),
    Entry("contacts", "C&ontacts", "Plant the feet, join the hands",
          "Ctrl+2", "link", _contacts),
    Entry("compare", "&Compare", "Set performances beside a reference",
          "Ctrl+3", "compare", _compare),
)  # fmt: skip
