"""What is done with segments: new ones, names, suggestions, and their files."""

from __future__ import annotations

from collections.abc import Callable, Generator
from pathlib import Path

from mocapstudio.comparison.labels import Labels, labels_of, read_labels, write_labels
from mocapstudio.comparison.model import Segment
from mocapstudio.comparison.segments import suggested
from mocapstudio.gui import settings
from mocapstudio.gui.compare.part import WorkspacePart
from mocapstudio.gui.dialogs.files import FileRequest, ask_for_files, ask_where_to_write
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.progress import Progress

_FILTER = "Segments (*.json)"


class Segmenting(WorkspacePart):
    """Makes, names and stores segments."""

    def slots(self) -> dict[str, Callable[[], object]]:
        """What it does, by command."""
        return {
            "segment-new": self.new,
            "segment-rename": self.rename,
            "segment-delete": self.delete,
            "segment-next": lambda: self.step(1),
            "segment-previous": lambda: self.step(-1),
            "segment-suggest": self.suggest,
            "segment-load": self.ask_load,
            "segment-save": self.ask_save,
            "segment-carry": self.ask_carry,
        }

    def new(self) -> None:
        """Name the second that begins at the play head."""
        state = self._bridge.state
        if state.reference is not None:
            end = state.frame + max(round(float(state.reference.rate)), 1)
            self._bridge.sitting.add_segment(state.frame, min(end, state.reference.frames))

    def rename(self) -> None:
        """Let the name of the selected segment be typed."""
        state = self._bridge.state
        if state.segment is None:
            return
        if self._bridge.ui.matrix:
            self._workspace.desk.pictures.rename(state.segment)
        else:
            self._workspace.desk.segments.edit_name()

    def delete(self) -> None:
        """Delete the selected segment."""
        if self._bridge.state.segment is not None:
            self._bridge.sitting.delete_segment(self._bridge.state.segment)

    def step(self, by: int) -> None:
        """Select the next segment after the play head, or the one before it."""
        state = self._bridge.state
        if state.segment is not None:
            wanted = state.segment + by
        else:
            later = sum(one.start <= state.frame for one in state.segments)
            wanted = later if by > 0 else later - 1
        if 0 <= wanted < len(state.segments):
            self._bridge.sitting.select_segment(wanted)

    def suggest(self) -> None:
        """Suggest segments from the reference's own motion; they take the place of all others."""
        reference = self._bridge.state.reference
        if reference is None:
            return

        def work() -> Generator[Progress, None, tuple[Segment, ...]]:
            yield Progress(0.0, "looking for segments")
            return suggested(reference)

        def done(segments: tuple[Segment, ...]) -> None:
            if reference is not self._bridge.state.reference:
                return
            if segments:
                self._bridge.sitting.set_segments(segments, "Suggested Segments")
            count = len(segments)
            self._messages.tell(f"{count} segments suggested." if count else "No segments found.")

        self._window.jobs.start(
            "Looking for segments",
            work(),
            done,
            lambda error: self._messages.complain(error, "No segments could be suggested"),
            key="segments",
        )

    def ask_load(self) -> None:
        """Ask for a file of segments."""
        request = FileRequest("Load segments", "labels", filters=_FILTER)
        ask_for_files(self._window, request, lambda paths: self.load(paths[0]))

    def load(self, path: Path) -> None:
        """Read the reference's segments from a file."""
        reference = self._bridge.state.reference
        if reference is None:
            return
        try:
            every = read_labels(path)
            found = labels_of(reference.name, every) or (every[0] if len(every) == 1 else None)
            if found is None:
                raise MocapError(f"{path.name} holds no segments of {reference.name}")
            segments = found.at_rate(reference.rate).segments
            self._bridge.sitting.set_segments(segments, f"Load {path.name}")
        except MocapError as error:
            self._messages.complain(error, "The segments could not be read")
            return
        self._bridge.sitting.mark_saved(path)
        settings.set_folder("labels", path)

    def ask_save(self) -> None:
        """Ask where the reference's segments are written."""
        reference = self._bridge.state.reference
        if reference is not None:
            start = self._bridge.state.labels or self._beside(f"{reference.name}.segments.json")
            words = "Save the segments of the reference"
            ask_where_to_write(self._window, words, start, _FILTER, self.save)

    def save(self, path: Path) -> None:
        """Write the reference's segments."""
        state = self._bridge.state
        if state.reference is not None:
            labels = Labels(state.reference.name, state.reference.rate, state.segments)
            if self._write(labels, path):
                self._bridge.sitting.mark_saved(path)

    def ask_carry(self) -> None:
        """Ask where the segments as carried over to the source are written."""
        source = self._bridge.state.source
        if source is not None:
            start = self._beside(f"{source.take.name}.segments.json")
            words = "Save the segments as carried over to the source"
            ask_where_to_write(self._window, words, start, _FILTER, self.save_carried)

    def save_carried(self, path: Path) -> None:
        """Write the segments as the chosen source performs them."""
        state = self._bridge.state
        source, linked = state.source, state.linked
        if source is None or linked is None:
            return
        carried, last = [], 0
        for one in (both.source for both in linked.carried(state.segments)):
            start = max(one.start, last)
            last = max(one.end, start + 1)
            carried.append(Segment(one.name, start, last))
        self._write(Labels(source.take.name, source.take.rate, tuple(carried)), path)

    def _write(self, labels: Labels, path: Path) -> bool:
        try:
            write_labels(labels, path)
        except MocapError as error:
            self._messages.complain(error, "The segments could not be written")
            return False
        settings.set_folder("labels", path)
        self._messages.tell(f"{len(labels.segments)} segments were written.", path)
        return True

    def _beside(self, name: str) -> Path:
        return Path(settings.folder("labels")) / name
