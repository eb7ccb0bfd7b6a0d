"""Writing pictures, tables, and the source in the reference's timing."""

from __future__ import annotations

from collections.abc import Callable, Generator
from pathlib import Path

from PySide6.QtCore import QBuffer, QIODevice, QPoint, QRect, QSize
from PySide6.QtGui import QColor, QImage, QPainter
from PySide6.QtSvg import QSvgGenerator
from PySide6.QtWidgets import QWidget

from mocapstudio import formats
from mocapstudio.formats.atomic import write_whole
from mocapstudio.gui import settings, theme
from mocapstudio.gui.compare import tables
from mocapstudio.gui.compare.part import WorkspacePart
from mocapstudio.gui.dialogs.files import ask_where_to_write
from mocapstudio.gui.plots.time_plot import TimePlot
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.progress import Progress

_FINER = 2


class Exporting(WorkspacePart):
    """Writes what the workspace shows and what came of comparing."""

    def slots(self) -> dict[str, Callable[[], object]]:
        """What it does, by command."""
        return {
            "compare-picture": self.ask_picture,
            "compare-tables": self.ask_tables,
            "compare-warped": self.ask_warped,
        }

    def ask_picture(self) -> None:
        """Ask where the pictures are written, as PNG or SVG."""
        start = self._beside(".png")
        filters = "Pictures (*.png *.svg)"
        ask_where_to_write(self._window, "Export the pictures", start, filters, self.picture)

    def picture(self, path: Path) -> None:
        """Write the pictures that are shown."""
        view = self._workspace.desk.below
        data = as_svg(view) if path.suffix.lower() == ".svg" else as_png(view)
        self._write({path: data}, "The pictures")

    def ask_tables(self) -> None:
        """Ask where the tables are written."""
        start = self._beside(".csv")
        filters = "Tables (*.csv)"
        ask_where_to_write(self._window, "Export the tables", start, filters, self.tables)

    def tables(self, path: Path) -> None:
        """Write frames, segments and ranking as three tables, named alike."""
        state = self._bridge.state
        if state.comparison is None:
            return
        files = {path: tables.frames_table(state.comparison)}
        files[path.with_suffix(".ranking.csv")] = tables.ranking_table(state)
        if state.segments:
            files[path.with_suffix(".segments.csv")] = tables.segments_table(state)
        self._write(files, "The tables")

    def ask_warped(self) -> None:
        """Ask where the source in the reference's timing is written."""
        source = self._bridge.state.source
        if source is None:
            return
        suffix = ".bvh"
        if isinstance(source.take, MarkerTake):
            own = None if source.take.source is None else source.take.source.path.suffix.lower()
            suffix = own if own in (".c3d", ".trc") else ".trc"
        start = Path(settings.folder("compare-export")) / f"{source.take.name}.warped{suffix}"
        words, filters = "Export the warped source", f"Takes (*{suffix})"
        ask_where_to_write(self._window, words, start, filters, self.warped)

    def warped(self, path: Path) -> None:
        """Write the chosen source in the reference's timing."""
        state = self._bridge.state
        source, comparison = state.source, state.comparison
        if source is None or comparison is None:
            return
        inputs = self._inputs()

        def work() -> Generator[Progress, None, Path]:
            yield Progress(0.0, f"writing {path.name}")
            from mocapstudio.comparison.warped import warped

            options = formats.WriteOptions(anew=True)
            formats.write(warped(source.take, comparison), path, options=options, inputs=inputs)
            return path

        self._window.jobs.start(
            f"Writing {path.name}",
            work(),
            lambda written: self._told(written, "The warped source"),
            lambda error: self._messages.complain(error, "The warped source was not written"),
        )

    def _write(self, files: dict[Path, bytes], what: str) -> None:
        try:
            for path, data in files.items():
                write_whole(path, [data], inputs=self._inputs())
        except MocapError as error:
            self._messages.complain(error, f"{what} could not be written")
            return
        self._told(next(iter(files)), what)

    def _told(self, path: Path, what: str) -> None:
        settings.set_folder("compare-export", path)
        verb = "was" if what.endswith("source") else "were"
        self._messages.tell(f"{what} {verb} written to {path.name}.", path)

    def _inputs(self) -> list[Path]:
        state = self._bridge.state
        takes = [state.reference, *(one.take for one in state.sources)]
        return [one.source.path for one in takes if one is not None and one.source is not None]

    def _beside(self, suffix: str) -> Path:
        state = self._bridge.state
        name = "comparison"
        if state.reference is not None and state.source is not None:
            name = f"{state.source.take.name} beside {state.reference.name}"
        return Path(settings.folder("compare-export")) / f"{name}{suffix}"


def as_png(view: QWidget) -> bytes:
    """Draw a view as PNG, twice as fine as on the screen."""
    image = QImage(view.size() * _FINER, QImage.Format.Format_RGB32)
    image.setDevicePixelRatio(_FINER)
    image.fill(QColor(theme.current().panel))
    painter = QPainter(image)
    _render(view, painter)
    painter.end()
    # Its declared types say bytes; at run time it wants a word.
    return _bytes(lambda device: image.save(device, "PNG"))  # type: ignore[call-overload]


def as_svg(view: QWidget) -> bytes:
    """Draw a view as SVG: lines as lines, colours of poses as pictures."""

    def write(device: QIODevice) -> None:
        made = QSvgGenerator()
        made.setOutputDevice(device)
        made.setSize(QSize(view.size()))
        made.setViewBox(QRect(QPoint(0, 0), view.size()))
        painter = QPainter(made)
        painter.fillRect(view.rect(), QColor(theme.current().panel))
        _render(view, painter)
        painter.end()

    return _bytes(write)


def _render(view: QWidget, painter: QPainter) -> None:
    plots = view.findChildren(TimePlot)
    for plot in plots:
        plot.draw_directly(True)
    try:
        view.render(painter, QPoint())
    finally:
        for plot in plots:
            plot.draw_directly(False)


def _bytes(write: Callable[[QIODevice], object]) -> bytes:
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    write(buffer)
    return bytes(buffer.data().data())
