"""What the Compare workspace shows before there is anything to compare."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from mocapstudio.gui import icons, theme
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.widgets.parts import label

_WIDTH = 620


class EmptyCompare(QWidget):
    """Says what is compared with what, and how to begin.

    Parameters
    ----------
    actions
        The commands behind the buttons.
    """

    def __init__(self, actions: Actions) -> None:
        super().__init__()
        self.setObjectName("compare-empty")
        self._picture = QLabel()
        self._area = QFrame()
        self._area.setObjectName("compare-drop")
        self._area.setFixedWidth(_WIDTH)
        column = QVBoxLayout(self._area)
        column.setContentsMargins(40, 34, 40, 30)
        column.setSpacing(10)
        self._title = label("", "heading", "compare-hint")
        self._words = label("", "muted", "compare-words", wrap=True)
        for one in (self._picture, self._title, self._words):
            one.setAlignment(Qt.AlignmentFlag.AlignCenter)
            column.addWidget(one)
        # A layout that is aligned in another one does not ask for the height of wrapped words.
        self._words.setMinimumHeight(3 * self._words.fontMetrics().lineSpacing() + 6)
        column.addSpacing(10)
        row = QHBoxLayout()
        row.setSpacing(8)
        row.addStretch(1)
        specs = (
            ("compare-reference", "Reference…"),
            ("compare-sources", "Sources…"),
            ("compare-scene", "From the review"),
        )
        self._buttons = {name: actions.push_button(name, text) for name, text in specs}
        for button in self._buttons.values():
            row.addWidget(button)
        row.addStretch(1)
        column.addLayout(row)
        whole = QVBoxLayout(self)
        whole.addStretch(2)
        whole.addWidget(self._area, 0, Qt.AlignmentFlag.AlignHCenter)
        whole.addStretch(3)
        self.tell("")

    def tell(self, reference: str) -> None:
        """Say what is missing: everything, or what to compare with the reference."""
        title = "Set a performance beside another"
        words = (
            "Drop the reference here first, then up to eight performances of the same movement:"
            " joints (BVH, ASF/AMC) or markers (C3D, TRC). They are aligned in time, and shown"
            " early, late and different, moment by moment."
        )
        primary = "compare-reference"
        if reference:
            title = f"Compare with {reference}"
            words = "Drop performances of the same movement here, up to eight of them."
            primary = "compare-sources"
        self._title.setText(title)
        self._words.setText(words)
        for name, button in self._buttons.items():
            button.setProperty("role", "primary" if name == primary else "")
            button.style().unpolish(button)
            button.style().polish(button)
        self.restyle()

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        now = theme.current()
        self._picture.setPixmap(icons.pixmap("compare", 56, now.accent))
        self._area.setStyleSheet(
            f"#compare-drop {{ border: 2px dashed {now.border}; border-radius: 14px;"
            f" background: {now.panel}; }}"
        )
