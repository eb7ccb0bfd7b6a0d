"""The system's own dialogs for files and folders, asked without waiting for the answer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QWidget

from mocapstudio.formats.registry import readable_suffixes
from mocapstudio.gui import settings
from mocapstudio.gui.dialogs.question import confirm


@dataclass(frozen=True)
class FileRequest:
    """What is asked of the user.

    Parameters
    ----------
    title
        Title of the dialog.
    purpose
        Under which name its folder is remembered.
    several
        Whether more than one file may be chosen.
    filters
        Name filters; by default what can be read.
    """

    title: str
    purpose: str
    several: bool = False
    filters: str = ""


def takes_filter() -> str:
    """Return the name filter of all takes that can be read."""
    patterns = " ".join(f"*{suffix} *{suffix.upper()}" for suffix in readable_suffixes())
    return f"Takes ({patterns})"


def ask_for_files(
    parent: QWidget, request: FileRequest, done: Callable[[list[Path]], object]
) -> None:
    """Ask for files that exist."""
    dialog = _dialog(parent, request.title, request.purpose)
    several = QFileDialog.FileMode.ExistingFiles
    dialog.setFileMode(several if request.several else QFileDialog.FileMode.ExistingFile)
    dialog.setNameFilters([*(request.filters or takes_filter()).split(";;"), "All files (*)"])
    dialog.filesSelected.connect(lambda names: done([Path(name) for name in names]))
    dialog.open()


def ask_for_folder(
    parent: QWidget, title: str, purpose: str, done: Callable[[Path], object]
) -> None:
    """Ask for a folder that exists."""
    dialog = _dialog(parent, title, purpose)
    dialog.setFileMode(QFileDialog.FileMode.Directory)
    dialog.setOption(QFileDialog.Option.ShowDirsOnly, True)
    dialog.fileSelected.connect(lambda name: done(Path(name)))
    dialog.open()


def ask_where_to_write(
    parent: QWidget, title: str, start: Path, filters: str, done: Callable[[Path], object]
) -> None:
    """Ask for a file to write, and again before one is replaced."""

    def chosen(name: str) -> None:
        path = Path(name)
        if path.exists():
            words = f"It lies in {path.parent}. What is in it will be lost."
            confirm(parent, f"Replace {path.name}?", words, "Replace", lambda: done(path))
        else:
            done(path)

    dialog = _dialog(parent, title, "")
    dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
    dialog.setFileMode(QFileDialog.FileMode.AnyFile)
    dialog.setNameFilters(filters.split(";;"))
    dialog.setDefaultSuffix(start.suffix.lstrip("."))
    dialog.setDirectory(str(start.parent))
    dialog.selectFile(start.name)
    # Its own question would nest an event loop.
    dialog.setOption(QFileDialog.Option.DontConfirmOverwrite)
    dialog.fileSelected.connect(chosen)
    dialog.open()


def _dialog(parent: QWidget, title: str, purpose: str) -> QFileDialog:
    dialog = QFileDialog(parent, title)
    dialog.setObjectName("file-dialog")
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    if purpose:
        dialog.setDirectory(settings.folder(purpose))
    return dialog
