"""What a command is."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Command:
    """One thing the user can do.

    Parameters
    ----------
    name
        How the code calls it; the QAction's object name is ``action-<name>``.
    text
        As the menu shows it.
    tip
        What it does, for the tooltip and the status bar.
    keys
        Shortcuts, the first one shown.
    icon
        Name of an icon, or "".
    checkable
        Whether it switches something on and off.
    """

    name: str
    text: str
    tip: str
    keys: tuple[str, ...] = ()
    icon: str = ""
    checkable: bool = False


SEPARATOR = Command("", "", "")
