"""Contacts as files: loaded and saved by hand."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QWidget

from mocapstudio.cleaning.contacts.files import read_contacts, write_contacts
from mocapstudio.gui import settings
from mocapstudio.gui.contacts.bridge import ContactsBridge
from mocapstudio.gui.contacts.measuring import CENTI, measured
from mocapstudio.gui.contacts.reading import Readings
from mocapstudio.gui.dialogs.files import FileRequest, ask_for_files, ask_where_to_write
from mocapstudio.gui.messages import Messages
from mocapstudio.motion.errors import MocapError

_FILTER = "Contacts (*.json)"


class Filing(QObject):
    """Reads and writes the contacts of the take under review.

    Parameters
    ----------
    window
        Parent of the dialogs.
    bridge
        To the document.
    readings
        Points of the take under review.
    messages
        Is told what came of it.
    """

    def __init__(
        self, window: QWidget, bridge: ContactsBridge, readings: Readings, messages: Messages
    ) -> None:
        super().__init__(bridge)
        self._window, self._bridge = window, bridge
        self._readings, self._messages = readings, messages

    def ask_load(self) -> None:
        """Ask for a file of contacts and take them from it."""
        request = FileRequest("Load Contacts", "contacts", filters=_FILTER)
        ask_for_files(self._window, request, lambda paths: self.load(paths[0]))

    def ask_save(self) -> None:
        """Ask where to write the contacts."""
        take = self._bridge.desk.state.take
        if take is None:
            return
        folder = settings.folder("contacts")
        start = Path(folder) / f"{take.name}.contacts.json"
        ask_where_to_write(self._window, "Save Contacts", start, _FILTER, self.save)

    def load(self, path: Path) -> None:
        """Take the contacts from a file."""
        take, reading = self._bridge.desk.state.take, self._readings.now
        if take is None or reading is None:
            return
        try:
            found = read_contacts(path, take, reading.points)
            self._bridge.desk.document.load_contacts(found.contacts, found.points)
        except MocapError as error:
            self._messages.complain(error, "The contacts could not be loaded")
            return
        settings.set_folder("contacts", path.parent)
        self._messages.tell(f"{len(found.contacts)} contacts loaded.", path)

    def save(self, path: Path) -> None:
        """Write the contacts to a file."""
        reading, contacts = self._readings.now, self._bridge.kept
        if reading is None:
            return
        usable = [one for one in contacts if not reading.trouble(one)]
        before = measured(reading, usable, after=False)
        after = measured(reading, usable, after=True)
        slide = {"before": before.mean_slide / CENTI, "after": after.mean_slide / CENTI}
        sources = [one.take.source for one in self._bridge.desk.state.scene.performers]
        try:
            write_contacts(
                path,
                reading.before,
                usable,
                reading.points,
                slide=slide if reading.solved else None,
                others=reading.others,
                inputs=[one.path for one in sources if one is not None],
            )
        except MocapError as error:
            self._messages.complain(error, "The contacts could not be saved")
            return
        settings.set_folder("contacts", path.parent)
        left = len(contacts) - len(usable)
        words = f"; {left} without their partner left out" if left else ""
        self._messages.tell(f"{len(usable)} contacts saved{words}.", path)
