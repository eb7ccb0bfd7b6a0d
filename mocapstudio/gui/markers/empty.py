"""What the Markers workspace shows before a take of markers is open."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from mocapstudio.gui import icons, theme
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.widgets.parts import label

_WIDTH = 560


class EmptyMarkers(QWidget):
    """Says what is done here, and how to begin.

    Parameters
    ----------
    actions
        The commands behind the buttons.
    """

    def __init__(self, actions: Actions) -> None:
        super().__init__()
        self.setObjectName("markers-empty")
        self._picture = QLabel()
        self._area = QFrame()
        self._area.setObjectName("markers-drop")
        self._area.setFixedWidth(_WIDTH)
        column = QVBoxLayout(self._area)
        column.setContentsMargins(40, 34, 40, 30)
        column.setSpacing(10)
        words = label(
            "C3D, TRC or tables: see where markers are missing, fill the gaps, exchange labels that"
            " were swapped, and write the take back with nothing else changed.",
            "muted",
            wrap=True,
        )
        words.setMinimumHeight(2 * words.fontMetrics().lineSpacing() + 6)
        for one in (self._picture, label("Drop markers here", "heading", "markers-hint"), words):
            one.setAlignment(Qt.AlignmentFlag.AlignCenter)
            column.addWidget(one)
        column.addSpacing(10)
        row = QHBoxLayout()
        row.addStretch(1)
        row.addWidget(actions.push_button("open", "Open…"))
        row.addStretch(1)
        column.addLayout(row)
        whole = QVBoxLayout(self)
        whole.addStretch(2)
        whole.addWidget(self._area, 0, Qt.AlignmentFlag.AlignHCenter)
        whole.addStretch(3)
        self.restyle()

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        now = theme.current()
        self._picture.setPixmap(icons.pixmap("markers", 56, now.accent))
        self._area.setStyleSheet(
            f"#markers-drop {{ border: 2px dashed {now.border}; border-radius: 14px;"
            f" background: {now.panel}; }}"
        )
