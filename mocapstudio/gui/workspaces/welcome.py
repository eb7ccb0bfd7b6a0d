"""What the window shows before anything is open."""

from __future__ import annotations

from datetime import datetime
from functools import partial
from pathlib import Path

from PySide6.QtCore import Qt, Signal, SignalInstance
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from mocapstudio.gui import icons, settings, theme
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.widgets.parts import ElidedLabel, label, panel

_RECENT_SHOWN = 6


class Welcome(QWidget):
    """A place to drop a take, the recent files, and what an earlier crash left.

    Parameters
    ----------
    actions
        The commands behind the buttons.
    """

    wanted = Signal(object)
    """Emitted with a recent path that was clicked."""

    demo_wanted = Signal()
    recovery_wanted = Signal(object)
    """Emitted with the journal to recover."""

    discard_wanted = Signal(object)
    """Emitted with the journal to forget."""

    def __init__(self, actions: Actions) -> None:
        super().__init__()
        self.setObjectName("welcome")
        self._picture = QLabel()
        self._recent = QVBoxLayout()
        self._recent.setSpacing(2)
        self._left = QVBoxLayout()
        self._left.setSpacing(8)
        area = QFrame()
        area.setObjectName("welcome-drop")
        area.setFixedWidth(560)
        self._area = area
        column = QVBoxLayout(area)
        column.setContentsMargins(40, 36, 40, 32)
        column.setSpacing(10)
        words = (
            self._picture,
            label("Drop a take here", "heading", "welcome-hint"),
            label("BVH, AMC, C3D, TRC or a table, or a whole session", "muted"),
        )
        for one in words:
            one.setAlignment(Qt.AlignmentFlag.AlignCenter)
            column.addWidget(one)
        column.addSpacing(10)
        column.addLayout(self._make_buttons(actions))
        whole = QVBoxLayout(self)
        whole.addStretch(2)
        whole.addLayout(self._left)
        whole.addSpacing(12)
        whole.addWidget(area, 0, Qt.AlignmentFlag.AlignHCenter)
        whole.addSpacing(18)
        whole.addLayout(self._recent)
        whole.addStretch(3)
        self.refresh()

    def _make_buttons(self, actions: Actions) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(8)
        row.addStretch(1)
        opening = actions.push_button("open", "Open…")
        opening.setObjectName("welcome-open")
        opening.setProperty("role", "primary")
        opening.setMinimumWidth(120)
        self._open = opening
        demo = QPushButton("Try the demo take")
        demo.setObjectName("welcome-demo")
        demo.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        demo.setToolTip("Two minutes of generated motion with errors at known places")
        demo.clicked.connect(self.demo_wanted)
        row.addWidget(opening)
        row.addWidget(demo)
        row.addStretch(1)
        return row

    def refresh(self) -> None:
        """Show the recent files and the colours of now."""
        now = theme.current()
        self._picture.setPixmap(icons.pixmap("drop", 56, now.accent))
        self._open.setIcon(icons.icon("open", now.accent_text))
        self._area.setStyleSheet(
            f"#welcome-drop {{ border: 2px dashed {now.border}; border-radius: 14px;"
            f" background: {now.panel}; }}"
        )
        _empty(self._recent)
        paths = [path for path in settings.recent("files") if path.exists()][:_RECENT_SHOWN]
        if paths:
            title = label("RECENT", "section")
            title.setFixedWidth(560)
            self._recent.addWidget(title, 0, Qt.AlignmentFlag.AlignHCenter)
        for path in paths:
            self._recent.addWidget(self._recent_row(path), 0, Qt.AlignmentFlag.AlignHCenter)

    def offer_recovery(self, journal: Path) -> None:
        """Offer what a crash left of a sitting that was never saved."""
        when = datetime.fromtimestamp(journal.stat().st_mtime).strftime("%d %B %Y, %H:%M")
        card = panel("welcome-left", "card")
        card.setFixedWidth(560)
        row = QHBoxLayout(card)
        row.addWidget(label(f"A session of {when} was never saved.", wrap=True), 1)
        specs = (
            ("welcome-discard", "Discard", "Forget its decisions", self.discard_wanted),
            ("welcome-recover", "Recover", "Go on where it ended", self.recovery_wanted),
        )
        for name, text, tip, signal in specs:
            button = QPushButton(text)
            button.setObjectName(name)
            button.setToolTip(tip)
            button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
            button.clicked.connect(partial(self._answer, card, signal, journal))
            row.addWidget(button)
        self._left.addWidget(card, 0, Qt.AlignmentFlag.AlignHCenter)

    def _answer(self, card: QFrame, signal: SignalInstance, journal: Path, _: bool = False) -> None:
        card.hide()
        card.deleteLater()
        signal.emit(journal)

    def _recent_row(self, path: Path) -> QFrame:
        row = _Row(path)
        row.clicked.connect(lambda: self.wanted.emit(path))
        return row


class _Row(QFrame):
    clicked = Signal()

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.setObjectName("welcome-recent")
        self.setFixedWidth(560)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setToolTip(str(path))
        now = theme.current()
        self.setStyleSheet(
            "#welcome-recent { border-radius: 5px; }"
            f" #welcome-recent:hover {{ background: {now.raised}; }}"
        )
        row = QHBoxLayout(self)
        row.setContentsMargins(8, 4, 8, 4)
        picture = QLabel()
        picture.setPixmap(icons.pixmap("take", 16, now.muted))
        where = ElidedLabel(Qt.TextElideMode.ElideMiddle)
        where.setProperty("role", "faint")
        where.setAlignment(Qt.AlignmentFlag.AlignRight)
        where.show_text(str(path.parent))
        row.addWidget(picture)
        row.addWidget(label(path.name))
        row.addSpacing(20)
        row.addWidget(where, 1)

    def mouseReleaseEvent(self, event: object) -> None:
        """Open it."""
        self.clicked.emit()


def _empty(layout: QVBoxLayout) -> None:
    while (item := layout.takeAt(0)) is not None:
        widget = item.widget()
        if widget is not None:
            widget.deleteLater()
