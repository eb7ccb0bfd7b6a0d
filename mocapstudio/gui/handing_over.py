"""Writing sessions, clean takes and reports in the background."""

from __future__ import annotations

import copy
from collections.abc import Generator
from pathlib import Path

from PySide6.QtCore import Signal

from mocapstudio.gui import settings
from mocapstudio.gui.worker import Worker
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.progress import Progress
from mocapstudio.review.session_file import SUFFIX, save


class HandingOver(Worker):
    """Writes what the sitting has come to, and tells where the file lies."""

    about_to_save = Signal()
    """Emitted before the session is written: what else lasts can be handed to the document."""

    def clean_path(self) -> Path:
        """Return the name offered for the clean take: beside its source, ``_clean`` added."""
        take = self._bridge.state.take
        assert take is not None
        if take.source is None:
            return Path(settings.folder("export")) / f"{take.name}_clean.bvh"
        return take.source.path.with_name(f"{take.source.path.stem}_clean.bvh")

    def session_path(self) -> Path:
        """Return the name offered for the session."""
        state = self._bridge.state
        if state.path is not None:
            return state.path
        takes = [one.take for one in state.markers] if state.take is None else [state.take]
        source = takes[0].source if takes else None
        if source is None:
            return Path(settings.folder("session")) / f"session{SUFFIX}"
        return source.path.with_suffix(SUFFIX)

    def report_path(self) -> Path:
        """Return the name offered for the report."""
        return self.session_path().with_suffix(".html")

    def export(self, path: Path) -> None:
        """Write the take under review with its accepted repairs."""
        # A shallow copy holds the frozen state of now, whatever is decided meanwhile.
        document, performer = copy.copy(self._bridge.document), self._bridge.state.active

        def work() -> Generator[Progress, None, int]:
            yield Progress(0.0, f"writing {path.name}")
            from mocapstudio.review.export import export

            export(document, performer, path)
            return len(document.declared(performer))

        def done(count: int) -> None:
            changed = "nothing was changed"
            if count:
                changed = f"{count} changed spans" if count > 1 else "1 changed span"
            self._messages.tell(f"Exported {path.name}: {changed}.", path)

        self._have_done(
            f"Exporting {path.name}", work(), done, f"{path.name} could not be exported"
        )

    def save(self, path: Path) -> bool:
        """Write the session; tell whether that went well.

        At once, not in the background: the document announces that it was saved.
        """
        self.about_to_save.emit()
        try:
            save(self._bridge.document, path)
        except (MocapError, OSError) as error:
            self._messages.complain(error, "The session could not be saved")
            return False
        settings.add_recent("files", path)
        settings.set_folder("session", path)
        self._messages.tell(f"Saved {path.name}.", path)
        return True

    def report(self, path: Path) -> None:
        """Write the report."""
        document = copy.copy(self._bridge.document)

        def work() -> Generator[Progress, None, None]:
            yield Progress(0.0, f"writing {path.name}")
            from mocapstudio.review.report import write_report

            write_report(document, path)

        def done(_: object) -> None:
            self._messages.tell(f"Wrote {path.name}.", path)

        self._have_done(f"Writing {path.name}", work(), done, "The report could not be written")
