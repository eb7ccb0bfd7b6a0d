"""The named parts: how long each is in the reference and in the source, and how late it comes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QFrame, QHBoxLayout, QTableView, QVBoxLayout

from mocapstudio.comparison.model import Segment
from mocapstudio.comparison.segments import CarriedSegment
from mocapstudio.gui import theme
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.compare import colours as kinds
from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.widgets.parts import Hint
from mocapstudio.gui.widgets.tables import column_header, make_table
from mocapstudio.review.comparing import ComparingState
from mocapstudio.review.comparing_state import differing

Index = QModelIndex | QPersistentModelIndex

_SHOWN = {"reference", "sources", "chosen", "segments", "segment", "parameters"}

_COLUMNS = (
    ("Name", "What is done; double click to change it"),
    ("At", "Where it begins in the reference, seconds"),
    ("Lasts", "How long it lasts in the reference, seconds"),
    ("Source", "How long it lasts in the source, seconds"),
    ("Delay", "How much later the source begins it, seconds; negative where it is ahead"),
)


class SegmentsModel(QAbstractTableModel):
    """The segments of the reference, as the chosen source performs them.

    Parameters
    ----------
    bridge
        Where state comes from and intents go.
    """

    def __init__(self, bridge: CompareBridge) -> None:
        super().__init__()
        self._bridge = bridge
        self._rows: tuple[tuple[Segment, CarriedSegment | None], ...] = ()

    def show(self, state: ComparingState) -> None:
        """Show other segments."""
        found: Sequence[CarriedSegment | None] = [None] * len(state.segments)
        if state.linked is not None:
            found = state.linked.carried(state.segments)
        rows = tuple(zip(state.segments, found, strict=True))
        if rows and len(rows) == len(self._rows):
            # Nothing moves: a name that is being typed stays open.
            self._rows = rows
            last = self.index(len(rows) - 1, len(_COLUMNS) - 1)
            self.dataChanged.emit(self.index(0, 0), last)
            return
        self.beginResetModel()
        self._rows = rows
        self.endResetModel()

    def rowCount(self, _parent: Index = QModelIndex()) -> int:  # noqa: B008
        """How many segments there are."""
        return len(self._rows)

    def columnCount(self, _parent: Index = QModelIndex()) -> int:  # noqa: B008
        """Name, begin, durations, delay."""
        return len(_COLUMNS)

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = 0) -> Any:
        """Name a column."""
        return column_header(_COLUMNS, 1, section, orientation, role)

    def flags(self, index: Index) -> Qt.ItemFlag:
        """Names can be edited."""
        known = super().flags(index)
        return known | Qt.ItemFlag.ItemIsEditable if index.column() == 0 else known

    def setData(self, index: Index, value: Any, role: int = 0) -> bool:
        """Rename a segment."""
        if role != Qt.ItemDataRole.EditRole:
            return False
        self._bridge.sitting.rename_segment(index.row(), str(value))
        return True

    def data(self, index: Index, role: int = 0) -> Any:
        """Say what stands in a cell."""
        (segment, answer), column = self._rows[index.row()], index.column()
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.EditRole):
            return self._text(segment, answer, column)
        if role == Qt.ItemDataRole.TextAlignmentRole and column:
            return int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        if role == Qt.ItemDataRole.ForegroundRole and column == 4 and answer is not None:
            late = self._delay(answer)
            tolerance = self._bridge.state.parameters.tolerance
            kind = 0 if abs(late) <= tolerance else -1 if late > 0 else 1
            return QColor(kinds.timing(theme.current(), kind))
        if role == Qt.ItemDataRole.ToolTipRole:
            return segment.name
        return None

    def _text(self, segment: Segment, answer: CarriedSegment | None, column: int) -> str:
        if column == 0:
            return segment.name
        reference = self._bridge.state.reference
        assert reference is not None
        if column < 3:
            frames = segment.start if column == 1 else segment.end - segment.start
            return f"{reference.seconds(frames):.2f}"
        if answer is None:
            return ""
        if column == 3:
            return f"{answer.source_duration:.2f}"
        return f"{self._delay(answer):+.2f}".replace("-", "−")

    def _delay(self, answer: CarriedSegment) -> float:
        true_speed = self._bridge.state.parameters.true_speed
        return answer.delay if true_speed else answer.delay_relative


class SegmentsView(QFrame):
    """The table of segments, and what can be done with all of them.

    Parameters
    ----------
    bridge
        Where state comes from and intents go.
    actions
        The commands behind the buttons.
    """

    def __init__(self, bridge: CompareBridge, actions: Actions) -> None:
        super().__init__()
        self.setObjectName("compare-segments")
        self.setProperty("role", "panel")
        self._bridge = bridge
        self.model = SegmentsModel(bridge)
        self.table = make_table("segments-table", self.model, (0, 54, 50, 54, 60), 24)
        self.table.setTextElideMode(Qt.TextElideMode.ElideRight)
        self.table.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self.table.setEditTriggers(QTableView.EditTrigger.DoubleClicked)
        self._hint = Hint(self.table.viewport(), "segments-hint")
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.table, 1)
        buttons = QHBoxLayout()
        buttons.setContentsMargins(8, 6, 8, 8)
        buttons.setSpacing(6)
        for name, text in (("suggest", "Suggest"), ("load", "Load…"), ("save", "Save…")):
            buttons.addWidget(actions.push_button(f"segment-{name}", text), 1)
        column.addLayout(buttons)
        self.table.clicked.connect(lambda at: bridge.sitting.select_segment(at.row()))
        bridge.changed.connect(self._follow)
        self._show(bridge.state)

    def edit_name(self) -> None:
        """Let the selected segment's name be typed."""
        row = self._bridge.state.segment
        if row is not None:
            self.table.edit(self.model.index(row, 0))

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        self._show(self._bridge.state)

    def _follow(self, old: ComparingState, new: ComparingState) -> None:
        # Nothing else may end the typing of a name.
        if differing(old, new) & _SHOWN:
            self._show(new)

    def _show(self, state: ComparingState) -> None:
        self.model.show(state)
        if state.segment is not None:
            self.table.selectRow(state.segment)
        empty = not state.segments and state.reference is not None
        self._hint.say(
            "Drag in the lowest lane of the pictures to name a part of the reference,"
            " or let some be suggested."
            if empty
            else ""
        )
