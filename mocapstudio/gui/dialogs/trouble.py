"""The dialog that names file, line and cause."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtGui import QFontDatabase, QGuiApplication
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPlainTextEdit,
    QVBoxLayout,
    QWidget,
)

from mocapstudio.gui import icons, theme
from mocapstudio.gui.trouble import Trouble
from mocapstudio.gui.widgets.parts import label

_LISTED = 8


class TroubleDialog(QDialog):
    """Shows what went wrong: one trouble in full, several as a list.

    Parameters
    ----------
    troubles
        At least one.
    parent
        The window that stays as it was behind it.
    """

    def __init__(self, troubles: Sequence[Trouble], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("trouble-dialog")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle("mocapstudio")
        self.setMinimumWidth(500)
        self._text = "\n".join(one.line for one in troubles)
        internal = [one for one in troubles if one.details]
        column = QVBoxLayout(self)
        column.setContentsMargins(22, 20, 22, 16)
        column.setSpacing(14)
        row = QHBoxLayout()
        row.setSpacing(14)
        picture = QLabel()
        picture.setPixmap(icons.pixmap("warning", 32, theme.current().open))
        row.addWidget(picture, 0, Qt.AlignmentFlag.AlignTop)
        row.addLayout(self._words(troubles), 1)
        column.addLayout(row)
        if internal:
            column.addWidget(_details("\n".join(one.details for one in internal)))
            self._text += "\n" + internal[0].details
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Ok)
        buttons.button(QDialogButtonBox.StandardButton.Ok).setObjectName("trouble-ok")
        copy = buttons.addButton("Copy", QDialogButtonBox.ButtonRole.ActionRole)
        copy.setObjectName("trouble-copy")
        copy.setToolTip("Copy the message to the clipboard")
        copy.clicked.connect(lambda: QGuiApplication.clipboard().setText(self._text))
        buttons.accepted.connect(self.accept)
        column.addWidget(buttons)

    def _words(self, troubles: Sequence[Trouble]) -> QVBoxLayout:
        column = QVBoxLayout()
        column.setSpacing(8)
        first = troubles[0]
        title = first.title
        if len(troubles) > 1:
            title += f" ({len(troubles)} problems)"
        column.addWidget(label(title, "heading", "trouble-title", wrap=True))
        for one in troubles[:_LISTED]:
            column.addLayout(_facts(one))
        if len(troubles) > _LISTED:
            column.addWidget(label(f"and {len(troubles) - _LISTED} more", "muted"))
        return column


def _facts(trouble: Trouble) -> QGridLayout:
    grid = QGridLayout()
    grid.setHorizontalSpacing(12)
    grid.setVerticalSpacing(3)
    grid.setColumnStretch(1, 1)
    lines = {"File": trouble.file, "Place": trouble.place, "Cause": trouble.cause}
    for row, (caption, text) in enumerate((c, t) for c, t in lines.items() if t):
        grid.addWidget(label(caption, "muted"), row, 0, Qt.AlignmentFlag.AlignTop)
        shown = label(text, "", f"trouble-{caption.lower()}", wrap=True)
        shown.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        grid.addWidget(shown, row, 1)
    return grid


def _details(text: str) -> QPlainTextEdit:
    field = QPlainTextEdit(text)
    field.setObjectName("trouble-details")
    field.setReadOnly(True)
    field.setFont(QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont))
    field.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
    field.setMinimumHeight(180)
    return field
