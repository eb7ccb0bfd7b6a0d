"""What is wrong with a contact, in words."""

from __future__ import annotations

from collections.abc import Iterable

from mocapstudio.cleaning.contacts.model import Contact
from mocapstudio.cleaning.ik.foot_skate import Unreached
from mocapstudio.gui.contacts.lanes import key_of


def unmet_words(short: Unreached) -> str:
    """Say how far a contact is from being met, and for how long."""
    return f"out of reach by {short.millimetres:.0f} mm in {frames_words(short.frames)}"


def contradicted(contact: Contact, contacts: Iterable[Contact]) -> str:
    """Say where another contact of the same point asks for something else; nothing where none."""
    frames = 0
    for other in contacts:
        if other.id == contact.id or key_of(other) != key_of(contact):
            continue
        if other.target != contact.target:
            frames += max(0, min(contact.end, other.end) - max(contact.start, other.start))
    if not frames:
        return ""
    return f"another contact of this point asks for another place in {frames_words(frames)}"


def frames_words(count: int) -> str:
    """Write a number of frames."""
    return "1 frame" if count == 1 else f"{count} frames"
