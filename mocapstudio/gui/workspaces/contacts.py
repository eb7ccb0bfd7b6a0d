"""The Contacts workspace: what feet and hands touch, seen, drawn and dragged."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget

from mocapstudio.gui.contacts.answering import Answering
from mocapstudio.gui.contacts.bridge import ContactsBridge, ContactsUi
from mocapstudio.gui.contacts.curves_view import CurvesView
from mocapstudio.gui.contacts.filing import Filing
from mocapstudio.gui.contacts.inspector import ContactInspector
from mocapstudio.gui.contacts.lanes_view import LanesView
from mocapstudio.gui.contacts.reading import Readings
from mocapstudio.gui.contacts.stage import ContactsStage
from mocapstudio.gui.contacts.working import Working
from mocapstudio.gui.document import only_frame_differs
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.gui.views.transport import TransportView
from mocapstudio.gui.widgets.native import alone
from mocapstudio.gui.widgets.splitters import Splitters, above
from mocapstudio.gui.workspaces.workspace import Answers, Workspace
from mocapstudio.review.state import DocumentState

if TYPE_CHECKING:
    from mocapstudio.gui.main_window import MainWindow


class ContactsWorkspace(Workspace):
    """Viewport and inspector above, lanes and curves below, all at one frame and one choice.

    Parameters
    ----------
    window
        The desk.
    """

    def __init__(self, window: MainWindow) -> None:
        super().__init__()
        self.setObjectName("contacts")
        self._actions = window.actions_
        self.bridge = ContactsBridge(window.bridge, self)
        self.readings = Readings(self.bridge, window.jobs, window.messages)
        self.working = Working(self.bridge, self.readings, window.jobs, window.messages)
        self.time_range = TimeRange(self)
        self.stage = ContactsStage(self.bridge, self.readings)
        self.transport = TransportView(window.bridge, window.actions_)
        self.inspector = ContactInspector(self.bridge, self.readings, window.actions_)
        self.lanes = LanesView(self.bridge, self.readings, self.time_range)
        self.curves = CurvesView(self.bridge, self.readings, self.time_range)
        self._splitters = Splitters("contacts-")
        self._shared_out = self._restored = False
        self._lanes = 0
        self._lay_out()
        self.lanes.draw_wanted.connect(self.working.draw)
        self.stage.target_dropped.connect(self.working.meet)
        filing = Filing(window, self.bridge, self.readings, window.messages)
        self.answering = Answering(self, filing)
        window.bridge.changed.connect(self._follow)
        self.bridge.ui_changed.connect(self._follow_ui)
        self._answers = self.answering.answers()
        self.readings.changed.connect(self._follow_readings)

    def answers(self) -> Answers:
        """Answer the commands about contacts."""
        return self.answering.answers()

    def tools(self) -> Sequence[QWidget]:
        """What it adds to the toolbar."""
        names = {
            "contacts-detect": "Detect", "contacts-solve": "Solve",
            "contacts-snap": "Snap", "contacts-pose": "Key pose", "export": "",
        }  # fmt: skip
        return [self._actions.tool_button(name, text=text) for name, text in names.items()]

    def enter(self) -> None:
        """Begin to follow the take under review, laid out as remembered."""
        self.readings.wake(True)

    def leave(self) -> None:
        """Stop following."""
        self.readings.wake(False)
        self.bridge.set_ui(held=None)

    def share_out(self) -> None:
        """Share the room out as it comes."""
        width, height = self.width(), self.height()
        right = min(max(round(0.21 * width), 270), 340)
        self._splitters.columns.setSizes([width - right, right])
        lanes = min(self.lanes.full_height, round(0.3 * height))
        curves = min(max(round(0.19 * height), 120), 190)
        self._splitters.rows.setSizes([height - lanes - curves, lanes, curves])

    def remember(self) -> None:
        """Remember sizes."""
        self._splitters.remember()

    def showEvent(self, event: QShowEvent) -> None:
        """Lay out as remembered, else as it comes."""
        super().showEvent(event)
        if self._shared_out:
            return
        self._shared_out = True
        self.share_out()
        self._restored = self._splitters.restore()

    def changeEvent(self, event: QEvent) -> None:
        """Follow the theme."""
        super().changeEvent(event)
        if event.type() in (QEvent.Type.StyleChange, QEvent.Type.PaletteChange):
            self.lanes.restyle()
            self.curves.restyle()

    def _lay_out(self) -> None:
        self._splitters.fill(
            ((above(self.stage, self.transport), 1), (self.inspector, 0)),
            1,
            ((alone(self.lanes), 0), (alone(self.curves), 0)),
        )
        whole = QVBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.addWidget(self._splitters.rows)

    def _follow(self, old: DocumentState, new: DocumentState) -> None:
        self._tell(anyway=not only_frame_differs(old, new))

    def _follow_readings(self) -> None:
        self._tell(anyway=True)
        # How many lanes there are is known only now.
        if self._lanes != len(self.lanes.lanes) and not self._restored and self._shared_out:
            self.share_out()
        self._lanes = len(self.lanes.lanes)

    def _follow_ui(self, old: ContactsUi, new: ContactsUi) -> None:
        # Nothing that can be done depends on where something is dragged to.
        if old.held is None or new.held is None:
            self._tell(anyway=True)

    def _tell(self, anyway: bool) -> None:
        # Where the play head is decides whether a contact can be split.
        answers = self.answering.answers()
        if anyway or answers.allowed != self._answers.allowed:
            self._answers = answers
            self.answers_changed.emit()
