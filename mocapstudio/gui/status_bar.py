"""The status bar: the latest note at the left, facts of the take at the right."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt, QTimer, QUrl
from PySide6.QtGui import QDesktopServices
from PySide6.QtWidgets import QLabel, QPushButton, QStatusBar

from mocapstudio.gui import wording
from mocapstudio.gui.document import DocumentBridge, only_frame_differs
from mocapstudio.gui.messages import Link, Messages
from mocapstudio.gui.widgets.parts import ElidedLabel, label
from mocapstudio.review.state import DocumentState

_SHOWN_MS = 12_000


class DeskStatusBar(QStatusBar):
    """Notes and facts.

    Parameters
    ----------
    bridge
        The document's door.
    messages
        Where notes come from.
    """

    def __init__(self, bridge: DocumentBridge, messages: Messages) -> None:
        super().__init__()
        self.setObjectName("status")
        self.setSizeGripEnabled(False)
        self.setFixedHeight(28)
        self._note = ElidedLabel()
        self._note.setObjectName("note")
        self._link = QPushButton("Show in folder")
        self._link.setObjectName("note-link")
        self._link.setProperty("role", "link")
        self._link.setToolTip("Open the folder that the file lies in")
        self._link.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._link.setCursor(Qt.CursorShape.PointingHandCursor)
        self._link.clicked.connect(self._go)
        self._link.hide()
        self._about: Path | Link | None = None
        self._facts: QLabel = label("", "", "facts")
        self.addWidget(self._note, 1)
        self.addWidget(self._link)
        self.addPermanentWidget(self._facts)
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(lambda: self._tell("", None))
        messages.told.connect(self._tell)
        bridge.changed.connect(self._follow)
        self._show(bridge.state)

    def _tell(self, text: str, about: Path | Link | None) -> None:
        self._note.show_text(text)
        self._about = about
        words, tip = "Show in folder", "Open the folder that the file lies in"
        if isinstance(about, Link):
            words, tip = about.text, about.tip
        self._link.setText(words)
        self._link.setToolTip(tip)
        self._link.setVisible(about is not None)
        if text:
            self._timer.start(_SHOWN_MS)

    def _go(self) -> None:
        if isinstance(self._about, Link):
            self._about.go()
        elif self._about is not None:
            QDesktopServices.openUrl(QUrl.fromLocalFile(str(self._about.parent)))

    def _follow(self, old: DocumentState, new: DocumentState) -> None:
        if not only_frame_differs(old, new):
            self._show(new)

    def _show(self, state: DocumentState) -> None:
        take = state.take
        if take is not None:
            facts = [f"{take.frames} frames", wording.rate(take), f"{len(take.skeleton)} joints"]
            trim = dict(state.sitting.trims).get(state.active)
            if trim is not None and trim != (0, take.frames):
                first, last = wording.number(take, trim[0]), wording.number(take, trim[1] - 1)
                facts.append(f"trimmed to {first}–{last}")
        elif len(state.markers) == 1:
            one = state.markers[0].take
            facts = [f"{one.frames} frames", wording.rate(one), f"{len(one.labels)} markers"]
        elif state.markers:
            facts = [f"{len(state.markers)} takes of markers"]
        else:
            self._facts.setText("")
            return
        session = "no session" if state.path is None else state.path.name
        facts.append(f"{session}, unsaved" if state.dirty else session)
        self._facts.setText("   ·   ".join(facts))
