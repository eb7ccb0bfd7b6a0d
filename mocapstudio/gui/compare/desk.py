"""How the parts of the Compare workspace are laid out."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFrame, QLabel, QSplitter, QStackedWidget, QVBoxLayout, QWidget

from mocapstudio.gui import settings
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.compare.bridge import CompareBridge, CompareUi
from mocapstudio.gui.compare.matrix_view import MatrixView
from mocapstudio.gui.compare.multiples import MultiplesView
from mocapstudio.gui.compare.performances import PerformancesView
from mocapstudio.gui.compare.pictures import PicturesView
from mocapstudio.gui.compare.segments_table import SegmentsView
from mocapstudio.gui.compare.stage import StageView
from mocapstudio.gui.compare.transport import CompareTransport
from mocapstudio.gui.widgets.parts import header, panel


class CompareDesk(QWidget):
    """Performances, viewports and segments above, pictures below.

    Parameters
    ----------
    bridge
        Where state comes from and intents go.
    actions
        The commands behind the buttons.
    """

    def __init__(self, bridge: CompareBridge, actions: Actions) -> None:
        super().__init__()
        self._bridge = bridge
        self.performances = PerformancesView(bridge, actions)
        corner = [actions[n] for n in ("compare-overlay", "compare-align-here")]
        corner += [actions[n] for n in ("compare-differences", "compare-others", "follow")]
        self.stage = StageView(bridge, [*corner, None, actions["frame-joint"]])
        self.transport = CompareTransport(bridge, actions)
        self.pictures = PicturesView(bridge)
        self.segments = SegmentsView(bridge, actions)
        self._side = QStackedWidget()
        self._side.addWidget(self.segments)
        self.matrix = MatrixView(bridge)
        self._side.addWidget(self.matrix)
        self._below = QStackedWidget()
        self._below.addWidget(self.pictures)
        self.multiples = MultiplesView(bridge)
        self._below.addWidget(self.multiples)
        self._columns = QSplitter(Qt.Orientation.Horizontal)
        self._rows = QSplitter(Qt.Orientation.Vertical)
        self._shared_out = False
        self._lay_out(actions)
        bridge.ui_changed.connect(self._show_ui)
        self._show_ui(bridge.ui, bridge.ui)

    @property
    def below(self) -> QWidget:
        """What is shown below the viewports: pictures of one source, or strips of all."""
        return self.multiples if self._bridge.ui.multiples else self.pictures

    def _lay_out(self, actions: Actions) -> None:
        centre = QFrame()
        column = QVBoxLayout(centre)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.stage, 1)
        column.addWidget(self.transport)
        side = panel("compare-side")
        inner = QVBoxLayout(side)
        inner.setContentsMargins(0, 0, 0, 0)
        inner.setSpacing(0)
        head = header("Segments", actions.tool_button("compare-matrix"))
        titles = head.findChildren(QLabel)
        self._title = titles[0]
        inner.addWidget(head)
        inner.addWidget(self._side, 1)
        for splitter, name in ((self._columns, "columns"), (self._rows, "rows")):
            splitter.setObjectName(f"compare-{name}")
            splitter.setHandleWidth(4)
            splitter.setChildrenCollapsible(False)
        for index, part in enumerate((self.performances, centre, side)):
            self._columns.addWidget(part)
            self._columns.setStretchFactor(index, int(index == 1))
        for index, row in enumerate((self._columns, self._below)):
            self._rows.addWidget(row)
            self._rows.setStretchFactor(index, 1)
        whole = QVBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.addWidget(self._rows)

    def _show_ui(self, _old: CompareUi, new: CompareUi) -> None:
        self._side.setCurrentIndex(int(new.matrix))
        self._title.setText("Matrix" if new.matrix else "Segments")
        self._below.setCurrentIndex(int(new.multiples))

    def share_out(self) -> None:
        """Share the room out as it comes."""
        self._shared_out = True
        width, height = self.width(), self.height()
        left = min(max(round(0.21 * width), 262), 320)
        right = min(max(round(0.22 * width), 290), 360)
        self._columns.setSizes([left, width - left - right, right])
        self._rows.setSizes([round(0.47 * height), round(0.53 * height)])

    def remember(self) -> None:
        """Remember sizes."""
        settings.set_layout("compare-columns", self._columns.saveState())
        settings.set_layout("compare-rows", self._rows.saveState())

    def restore(self) -> None:
        """Lay out as remembered, else as it comes."""
        if self._shared_out:
            return
        self.share_out()
        for splitter, name in ((self._columns, "columns"), (self._rows, "rows")):
            state = settings.layout(f"compare-{name}")
            if state is not None:
                splitter.restoreState(state)

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        self.performances.restyle()
        self.segments.restyle()
