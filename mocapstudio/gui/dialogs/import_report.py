"""The import report: what was odd about the files that are open, and how else to read them."""

from __future__ import annotations

from pathlib import Path
from typing import cast

from PySide6.QtCore import QEvent, QSignalBlocker, Qt, Signal
from PySide6.QtGui import QCloseEvent
from PySide6.QtWidgets import (
    QDialog,
    QHBoxLayout,
    QListWidget,
    QListWidgetItem,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from mocapstudio.formats import ReadOptions
from mocapstudio.gui import icons
from mocapstudio.gui.dialogs.problem_table import ProblemTable
from mocapstudio.gui.dialogs.question import confirm
from mocapstudio.gui.dialogs.reading_form import ReadingForm
from mocapstudio.gui.imports import Imported, Imports
from mocapstudio.gui.rereading import Rereading
from mocapstudio.gui.widgets.parts import ElidedLabel, label, rule
from mocapstudio.motion.errors import ParameterError

_PATH = Qt.ItemDataRole.UserRole


class ImportReportDialog(QDialog):
    """Stays open beside the desk and follows it.

    Parameters
    ----------
    imports
        What is known of the files.
    rereading
        Reads a file again.
    parent
        The desk.
    """

    closed = Signal()
    """Emitted when the user is done with it."""

    def __init__(self, imports: Imports, rereading: Rereading, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("import-report")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle("Import Report")
        self.resize(940, 600)
        self._imports, self._rereading = imports, rereading
        self._shown: Imported | None = None
        self._asked: set[Path] = set()
        self._list = QListWidget()
        self._list.setObjectName("import-files")
        self._list.setFixedWidth(220)
        self._list.setTextElideMode(Qt.TextElideMode.ElideMiddle)
        self._name = label("", "heading", "import-name")
        self._facts = label("", "muted", "import-facts", wrap=True)
        self._where = ElidedLabel(Qt.TextElideMode.ElideMiddle)
        self._where.setProperty("role", "faint")
        self._table = ProblemTable()
        self._form = ReadingForm()
        self._wrong = label("", "guess", "import-wrong", wrap=True)
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        row.addWidget(self._list)
        row.addLayout(self._page(), 1)
        self._list.currentItemChanged.connect(self._choose)
        self._table.override_wanted.connect(self._form.point_to)
        imports.changed.connect(self._fill)
        self._fill()

    def show_file(self, path: Path | None) -> None:
        """Show what was odd about a file."""
        for at in range(self._list.count()):
            if self._list.item(at).data(_PATH) == path:
                self._list.setCurrentRow(at)

    def _page(self) -> QVBoxLayout:
        column = QVBoxLayout()
        column.setContentsMargins(20, 18, 20, 16)
        column.setSpacing(10)
        head = QVBoxLayout()
        head.setSpacing(3)
        for one in (self._name, self._facts, self._where):
            head.addWidget(one)
        column.addLayout(head)
        column.addWidget(self._table, 1)
        column.addWidget(rule())
        column.addWidget(label("READ OTHERWISE", "section"))
        column.addWidget(self._form)
        column.addLayout(self._buttons())
        return column

    def _buttons(self) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(8)
        self._plain = _button(
            "import-plain", "All Automatic", "Leave all to what the file says, or to a guess"
        )
        self._plain.clicked.connect(self._empty)
        tip = "Read the file anew, as the fields say"
        self._again = _button("import-again", "Read Again", tip)
        self._again.setProperty("role", "primary")
        self._again.clicked.connect(self._read)
        close = _button("import-close", "Close", "Close the report")
        close.clicked.connect(self.close)
        row.addWidget(self._plain)
        row.addWidget(self._wrong, 1)
        row.addWidget(self._again)
        row.addWidget(close)
        return row

    def _fill(self) -> None:
        item = self._list.currentItem()
        wanted = self._imports.active if item is None else item.data(_PATH)
        files = self._imports.files
        blocker = QSignalBlocker(self._list)
        self._list.clear()
        for path in files:
            made = QListWidgetItem(icons.icon("take"), _entry(path, self._imports.of(path)))
            made.setData(_PATH, path)
            made.setToolTip(str(path))
            self._list.addItem(made)
        blocker.unblock()
        self._list.setVisible(len(files) > 1)
        self._list.setCurrentRow(files.index(wanted) if wanted in files else min(0, len(files) - 1))
        self._show(self._path)

    @property
    def _path(self) -> Path | None:
        item = self._list.currentItem()
        return None if item is None else cast("Path", item.data(_PATH))

    def _choose(self) -> None:
        self._wrong.setText("")
        self._show(self._path)

    def _show(self, path: Path | None) -> None:
        one = None if path is None else self._imports.of(path)
        self._again.setEnabled(one is not None)
        self._plain.setEnabled(one is not None)
        self._form.setEnabled(one is not None)
        self._name.setText("No file is open" if path is None else path.name)
        self._where.show_text("" if path is None else str(path.parent))
        self._facts.setText("" if one is None else f"{one.report.format.upper()}  ·  {one.facts}")
        if path is not None and one is None and path not in self._asked:
            self._asked.add(path)
            self._rereading.look(path)
        if one is None:
            self._table.show_problems((), "" if path is None else "reading …")
        elif one is not self._shown:
            problems = one.report.problems
            self._table.show_problems(problems, "Nothing was odd about this file.")
            self._form.show_options(one.options, one.report.format, problems)
        self._shown = one

    def _empty(self) -> None:
        one = self._shown
        if one is not None:
            plain = ReadOptions(skeleton=one.options.skeleton)
            self._form.show_options(plain, one.report.format, one.report.problems)

    def _read(self) -> None:
        path = self._path
        if path is None:
            return
        self._wrong.setText("")
        try:
            options = self._form.options()
        except ParameterError as error:
            self._wrong.setText(str(error))
            return
        lost = self._rereading.touched(path)
        if not lost:
            self._rereading.read(path, options)
            return
        names = ", ".join(lost)
        words = f"What was decided and repaired in {names} goes with it; this cannot be undone."
        title = f"Read {path.name} again?"
        confirm(self, title, words, "Read Again", lambda: self._rereading.read(path, options))

    def closeEvent(self, event: QCloseEvent) -> None:
        """Say so."""
        super().closeEvent(event)
        self.closed.emit()

    def changeEvent(self, event: QEvent) -> None:
        """Follow the theme: icons are drawn in its colours."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.PaletteChange and hasattr(self, "_shown"):
            for row in range(self._list.count()):
                self._list.item(row).setIcon(icons.icon("take"))


def _entry(path: Path, one: Imported | None) -> str:
    return path.name if one is None else f"{path.name}\n{one.counts or 'nothing odd'}"


def _button(name: str, text: str, tip: str) -> QPushButton:
    made = QPushButton(text)
    made.setObjectName(name)
    made.setToolTip(tip)
    made.setAutoDefault(False)
    return made
