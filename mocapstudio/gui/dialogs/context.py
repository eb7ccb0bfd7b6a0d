"""Chooses the takes that are searched for neighbours."""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QListWidget,
    QListWidgetItem,
    QMenu,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from mocapstudio.formats import find_takes
from mocapstudio.gui import icons, settings
from mocapstudio.gui.dialogs.files import FileRequest, ask_for_files, ask_for_folder
from mocapstudio.gui.widgets.parts import Hint, label
from mocapstudio.motion.errors import MocapError


class ContextDialog(QDialog):
    """A list of folders and files, to be added to and taken from.

    Parameters
    ----------
    paths
        The context as it is.
    parent
        The window.
    """

    chosen = Signal(object)
    """Emitted with the tuple of paths when the user confirms."""

    def __init__(self, paths: Iterable[Path], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("context-dialog")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle("Context")
        self.resize(620, 400)
        self._list = QListWidget()
        self._list.setObjectName("context-list")
        self._list.setSelectionMode(QListWidget.SelectionMode.ExtendedSelection)
        self._list.itemSelectionChanged.connect(self._follow)
        self._hint = Hint(self._list.viewport(), "context-hint")
        self._count = label("", "muted", "context-count")
        column = QVBoxLayout(self)
        column.setContentsMargins(18, 16, 18, 14)
        column.setSpacing(10)
        words = "Takes that are searched for motion like the one under review, beside itself."
        column.addWidget(label(words, "muted", wrap=True))
        row = QHBoxLayout()
        row.setSpacing(10)
        row.addWidget(self._list, 1)
        row.addLayout(self._buttons())
        column.addLayout(row, 1)
        column.addWidget(self._count)
        box = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Ok | QDialogButtonBox.StandardButton.Cancel
        )
        box.button(QDialogButtonBox.StandardButton.Ok).setText("Use")
        box.button(QDialogButtonBox.StandardButton.Ok).setObjectName("context-ok")
        box.accepted.connect(self.accept)
        box.rejected.connect(self.reject)
        self.accepted.connect(lambda: self.chosen.emit(self.paths))
        column.addWidget(box)
        self.add(paths)

    @property
    def paths(self) -> tuple[Path, ...]:
        """The folders and files listed."""
        items = (self._list.item(row) for row in range(self._list.count()))
        return tuple(item.data(Qt.ItemDataRole.UserRole) for item in items)

    def add(self, paths: Iterable[Path], _checked: bool = False) -> None:
        """Put folders and files on the list, each once."""
        for path in paths:
            if path in self.paths:
                continue
            item = QListWidgetItem(icons.icon("folder" if path.is_dir() else "take"), str(path))
            item.setData(Qt.ItemDataRole.UserRole, path)
            item.setToolTip(_contents(path))
            self._list.addItem(item)
        self._follow()

    def _buttons(self) -> QVBoxLayout:
        column = QVBoxLayout()
        column.setSpacing(6)
        specs = (
            ("context-add-folder", "Add folder…", "folder", self._add_folder),
            ("context-add-files", "Add takes…", "take", self._add_files),
        )
        for name, text, icon, slot in specs:
            button = QPushButton(icons.icon(icon), text)
            button.setObjectName(name)
            button.setAutoDefault(False)
            button.clicked.connect(slot)
            column.addWidget(button)
        recent = QPushButton("Recent")
        recent.setObjectName("context-recent")
        recent.setAutoDefault(False)
        menu = QMenu(recent)
        for path in settings.recent("contexts"):
            menu.addAction(str(path)).triggered.connect(partial(self.add, [path]))
        recent.setMenu(menu)
        recent.setEnabled(not menu.isEmpty())
        column.addWidget(recent)
        column.addStretch(1)
        self._remove = QPushButton(icons.icon("delete"), "Remove")
        self._remove.setObjectName("context-remove")
        self._remove.setAutoDefault(False)
        self._remove.clicked.connect(self._drop_selected)
        column.addWidget(self._remove)
        return column

    def _add_folder(self) -> None:
        ask_for_folder(self, "Add a folder of takes", "context", lambda path: self.add([path]))

    def _add_files(self) -> None:
        request = FileRequest("Add takes", "context", several=True)
        ask_for_files(self, request, self.add)

    def _drop_selected(self) -> None:
        for item in self._list.selectedItems():
            self._list.takeItem(self._list.row(item))
        self._follow()

    def _follow(self) -> None:
        self._remove.setEnabled(bool(self._list.selectedItems()))
        self._hint.say("" if self.paths else "No context: the take is compared with itself only.")
        files = {one.resolve() for path in self.paths for one in _takes(path)}
        self._count.setText(f"{len(files)} takes" if len(files) != 1 else "1 take")


def _takes(path: Path) -> list[Path]:
    try:
        return find_takes([path])
    except MocapError:
        return []


def _contents(path: Path) -> str:
    if not path.exists():
        return f"{path}\nno longer there"
    return f"{path}\n{len(_takes(path))} takes" if path.is_dir() else str(path)
