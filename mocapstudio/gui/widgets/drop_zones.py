"""Where files may be dropped, shown while they are dragged over the window."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QDragEnterEvent, QDragLeaveEvent, QDragMoveEvent, QDropEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from mocapstudio.gui import icons, theme
from mocapstudio.gui.widgets.parts import label

ZONES = {
    "open": ("open", "Open for review", "as a take of its own"),
    "partner": ("partner", "Add as partner", "into the same scene"),
    "context": ("context", "Use as context", "search it for neighbours"),
    "reference": ("flag", "Use as reference", "what the others are compared with"),
    "sources": ("compare", "Compare", "set beside the reference"),
}


class DropZones(QWidget):
    """Covers the window with one zone for each thing that can be done with files.

    Parameters
    ----------
    window
        The window that takes the drops.
    """

    dropped = Signal(str, object)
    """The zone (a key of `ZONES`) and the list of paths."""

    def __init__(self, window: QWidget) -> None:
        super().__init__(window)
        self._window = window
        self.setObjectName("drop-zones")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        # The plots are native windows: only another one can lie above them.
        self.setAttribute(Qt.WidgetAttribute.WA_DontCreateNativeAncestors)
        self.setAttribute(Qt.WidgetAttribute.WA_NativeWindow)
        self.setAcceptDrops(True)
        self._zones: dict[str, QFrame] = {}
        self._offered: tuple[str, ...] = ("open",)
        row = QHBoxLayout(self)
        row.setContentsMargins(60, 60, 60, 60)
        row.setSpacing(24)
        for name in ZONES:
            self._zones[name] = _zone(name)
            row.addWidget(self._zones[name])
        window.setAcceptDrops(True)
        window.installEventFilter(self)
        self.hide()

    def offer(self, zones: Sequence[str]) -> None:
        """Say which zones there are for files that are dropped from now on."""
        self._offered = tuple(zones)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Appear when files come over the window."""
        if isinstance(event, QDragEnterEvent) and _files(event):
            self._recolour()
            for name, zone in self._zones.items():
                zone.setVisible(name in self._offered)
            self.setGeometry(self._window.rect())
            self.raise_()
            self.show()
            event.acceptProposedAction()
            return True
        if isinstance(event, QDropEvent) and not isinstance(event, QDragMoveEvent):
            self.dropEvent(event)
            return True
        return False

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take files."""
        if _files(event):
            event.acceptProposedAction()

    def dragMoveEvent(self, event: QDragMoveEvent) -> None:
        """Light the zone under the pointer."""
        at = self._zone_at(event)
        for name, zone in self._zones.items():
            zone.setProperty("lit", name == at)
            zone.setStyleSheet(_sheet(name == at))
        event.acceptProposedAction()

    def dragLeaveEvent(self, event: QDragLeaveEvent) -> None:
        """Disappear."""
        self.hide()

    def dropEvent(self, event: QDropEvent) -> None:
        """Say where what was dropped."""
        zone, paths = self._zone_at(event), _files(event)
        self.hide()
        if paths:
            event.acceptProposedAction()
            self.dropped.emit(zone, paths)

    def _zone_at(self, event: QDropEvent) -> str:
        x = event.position().x()
        shown = [(name, self._zones[name]) for name in self._offered]
        return min(shown, key=lambda one: abs(one[1].geometry().center().x() - x))[0]

    def _recolour(self) -> None:
        now = theme.current()
        self.setStyleSheet(f"#drop-zones {{ background: {now.background}; }}")
        for name, zone in self._zones.items():
            zone.setStyleSheet(_sheet(False))
            picture = zone.findChild(QLabel, "drop-icon")
            assert picture is not None
            picture.setPixmap(icons.pixmap(ZONES[name][0], 48, now.accent))


def _zone(name: str) -> QFrame:
    _, title, words = ZONES[name]
    zone = QFrame()
    zone.setObjectName(f"drop-{name}")
    column = QVBoxLayout(zone)
    column.addStretch(1)
    for one in (label("", "", "drop-icon"), label(title, "heading"), label(words, "muted")):
        one.setAlignment(Qt.AlignmentFlag.AlignCenter)
        column.addWidget(one)
    column.addStretch(1)
    return zone


def _sheet(lit: bool) -> str:
    now = theme.current()
    edge, ground = (now.accent, now.selection) if lit else (now.border, now.panel)
    return (
        f"QFrame {{ border: 2px dashed {edge}; border-radius: 12px; background: {ground}; }}"
        " QLabel { border: none; background: transparent; }"
    )


def _files(event: QDropEvent) -> list[Path]:
    data = event.mimeData()
    return [Path(url.toLocalFile()) for url in data.urls() if url.isLocalFile()]
