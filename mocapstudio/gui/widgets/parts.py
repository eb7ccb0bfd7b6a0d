"""Labels, panels and headers in the desk's style."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QSizePolicy, QWidget


def label(text: str = "", role: str = "", name: str = "", *, wrap: bool = False) -> QLabel:
    """Make a label; `role` picks its style in the style sheet."""
    made = QLabel(text)
    made.setObjectName(name)
    made.setWordWrap(wrap)
    if role:
        made.setProperty("role", role)
    return made


def panel(name: str, role: str = "panel") -> QFrame:
    """Make a panel."""
    made = QFrame()
    made.setObjectName(name)
    made.setProperty("role", role)
    return made


def header(title: str, *right: QWidget) -> QFrame:
    """Make the title bar of a panel, with what stands at its right end."""
    made = panel("", "header")
    made.setFixedHeight(34)
    row = QHBoxLayout(made)
    row.setContentsMargins(12, 0, 10, 0)
    row.setSpacing(6)
    row.addWidget(label(title, "title"))
    row.addStretch(1)
    for one in right:
        row.addWidget(one)
    return made


def rule() -> QFrame:
    """Make a thin line between parts of a panel."""
    return panel("", "rule")


class ElidedLabel(QLabel):
    """A label that ends in … where there is no room, and tells all in its tooltip."""

    def __init__(self, mode: Qt.TextElideMode = Qt.TextElideMode.ElideRight) -> None:
        super().__init__()
        self._full = ""
        self._mode = mode
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)

    @property
    def full(self) -> str:
        """The whole text."""
        return self._full

    def show_text(self, text: str) -> None:
        """Show a text, shortened where it must be."""
        self._full = text
        self._elide()

    def resizeEvent(self, event: QEvent) -> None:
        """Shorten anew."""
        self._elide()

    def _elide(self) -> None:
        shown = self.fontMetrics().elidedText(self._full, self._mode, self.width())
        self.setText(shown)
        self.setToolTip(self._full if shown != self._full else "")


class Hint(QLabel):
    """Words over the middle of a view that has nothing to show yet.

    Parameters
    ----------
    over
        The view; the hint keeps to its size.
    name
        Object name.
    """

    def __init__(self, over: QWidget, name: str) -> None:
        super().__init__(over)
        self._over = over
        self.setObjectName(name)
        self.setProperty("role", "hint")
        self.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.setWordWrap(True)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setMargin(20)
        over.installEventFilter(self)
        self.hide()

    def say(self, text: str) -> None:
        """Show the words, or nothing for an empty text."""
        self.setText(text)
        self.setVisible(bool(text))
        self.setGeometry(self._over.rect())

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Keep to the size of the view."""
        if event.type() == QEvent.Type.Resize:
            self.setGeometry(self._over.rect())
        return False
