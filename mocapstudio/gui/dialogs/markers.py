"""What to do with markers that have no skeleton: solve them, or compare them as they are."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QHBoxLayout,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from mocapstudio.gui import icons
from mocapstudio.gui.dialogs.files import FileRequest, ask_for_files
from mocapstudio.gui.imports import facts
from mocapstudio.gui.widgets.parts import label, rule
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take

_LISTED = 5

Template = Take | Path


class MarkersDialog(QDialog):
    """Says what was opened, and offers what can be done with it.

    Parameters
    ----------
    markers
        At least one.
    templates
        Takes that are open, the likeliest template first.
    parent
        The window.
    """

    solve_wanted = Signal(object)
    """Emitted with the template: a take that is open, or a path."""

    compare_wanted = Signal()
    """Emitted when the markers are to be compared as they are."""

    def __init__(
        self,
        markers: Sequence[MarkerTake],
        templates: Sequence[Take],
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("markers-dialog")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle("Markers")
        self.setFixedWidth(620)
        self._templates: list[Template] = []
        column = QVBoxLayout(self)
        column.setContentsMargins(22, 20, 22, 16)
        column.setSpacing(11)
        one = len(markers) == 1
        title = (
            f"{markers[0].name} holds markers and no skeleton"
            if one
            else f"{len(markers)} takes hold markers and no skeleton"
        )
        column.addWidget(label(title, "heading", "markers-title", wrap=True))
        for take in markers[:_LISTED]:
            words = facts([take]) if one else f"{take.name}  ·  {facts([take])}"
            column.addWidget(label(words, "muted", wrap=True))
        if len(markers) > _LISTED:
            column.addWidget(label(f"and {len(markers) - _LISTED} more", "muted"))
        column.addWidget(rule())
        column.addWidget(label("SOLVE TO A SKELETON", "section"))
        words = (
            "Joints are fitted to the markers, so that the motion can be reviewed and cleaned like"
            " any other. The template is a take of the same performer, or of a similar one, in"
            " whatever format: its skeleton is fitted to the markers' lengths."
        )
        column.addWidget(label(words, "", wrap=True))
        column.addLayout(self._template_row(templates))
        column.addWidget(rule())
        column.addWidget(label("COMPARE AS THEY ARE", "section"))
        words = "The Compare workspace sets markers beside those of another performance."
        column.addWidget(label(words, "", wrap=True))
        column.addSpacing(4)
        column.addLayout(self._buttons())
        self._follow()

    def add_template(self, path: Path) -> None:
        """Offer a file as template, and choose it."""
        self._templates.append(path)
        self._box.addItem(icons.icon("take"), path.name)
        self._box.setItemData(self._box.count() - 1, str(path), Qt.ItemDataRole.ToolTipRole)
        self._box.setCurrentIndex(self._box.count() - 1)
        self._follow()

    def _template_row(self, templates: Sequence[Take]) -> QHBoxLayout:
        self._box = QComboBox()
        self._box.setObjectName("markers-template")
        self._box.setToolTip("Whose skeleton the markers are solved to")
        self._box.setPlaceholderText("no take is open: choose a file")
        for take in templates:
            self._templates.append(take)
            self._box.addItem(icons.icon("take"), f"{take.name} (open)")
        # With a placeholder the first entry is not chosen by itself.
        self._box.setCurrentIndex(0 if templates else -1)
        browse = _button("markers-browse", "Choose a File…", "A take whose skeleton fits")
        browse.clicked.connect(self._browse)
        row = QHBoxLayout()
        row.setSpacing(10)
        row.addWidget(label("Template", "muted"))
        row.addWidget(self._box, 1)
        row.addWidget(browse)
        return row

    def _buttons(self) -> QHBoxLayout:
        cancel = _button("markers-cancel", "Cancel", "Leave the markers alone")
        cancel.clicked.connect(self.reject)
        compare = _button("markers-compare", "Compare", "Open them in the Compare workspace")
        compare.setIcon(icons.icon("compare"))
        compare.clicked.connect(self._compare)
        self._solve = _button("markers-solve", "Solve", "Solve them and open what comes of it")
        self._solve.setProperty("role", "primary")
        self._solve.clicked.connect(self._solve_now)
        row = QHBoxLayout()
        row.setSpacing(8)
        row.addWidget(cancel)
        row.addStretch(1)
        row.addWidget(compare)
        row.addWidget(self._solve)
        return row

    def _browse(self) -> None:
        request = FileRequest("Choose a template", "template")
        ask_for_files(self, request, lambda paths: self.add_template(paths[0]))

    def _follow(self) -> None:
        self._solve.setEnabled(self._box.currentIndex() >= 0)

    def _compare(self) -> None:
        self.accept()
        self.compare_wanted.emit()

    def _solve_now(self) -> None:
        self.accept()
        self.solve_wanted.emit(self._templates[self._box.currentIndex()])


def _button(name: str, text: str, tip: str) -> QPushButton:
    made = QPushButton(text)
    made.setObjectName(name)
    made.setToolTip(tip)
    made.setAutoDefault(False)
    return made
