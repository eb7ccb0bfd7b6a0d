"""The queue: flags, worst first, with their verdicts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from PySide6.QtCore import QItemSelectionModel, QModelIndex, Qt
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QAbstractItemView, QFrame, QHeaderView, QTableView, QVBoxLayout

from mocapstudio.gui import theme
from mocapstudio.gui.document import DocumentBridge, UiState, only_frame_differs
from mocapstudio.gui.queue.delegate import QueueDelegate
from mocapstudio.gui.queue.filter_bar import FilterBar
from mocapstudio.gui.queue.model import Column, QueueFilter, QueueModel
from mocapstudio.gui.queue.take_chooser import TakeChooser
from mocapstudio.gui.widgets.parts import Hint, header, label
from mocapstudio.motion.facing import ROOT_HEADING, ROOT_POSITION
from mocapstudio.motion.take import Take
from mocapstudio.motion.topology import topology
from mocapstudio.review.model import QueueItem, Verdict
from mocapstudio.review.state import DocumentState

_WIDTHS = {
    Column.RANK: 36,
    Column.TIME: 72,
    Column.FRAME: 52,
    Column.SCORE: 46,
    Column.KIND: 92,
    Column.VERDICT: 84,
}
_JOINT_WIDTH = 90
_DISPENSABLE = (Column.FRAME, Column.KIND)
"""Left out where the queue is too narrow for all columns, the first one first."""


class _Table(QTableView):
    """A table without type-ahead: letters are commands of the desk."""

    def keyboardSearch(self, search: str) -> None:
        """Leave letters alone; Ctrl+F filters."""


class QueueView(QFrame):
    """Lists the flags; selecting a row selects the flag everywhere.

    Parameters
    ----------
    bridge
        The document's door.
    """

    def __init__(self, bridge: DocumentBridge) -> None:
        super().__init__()
        self.setObjectName("queue")
        self.setProperty("role", "panel")
        self.setMinimumWidth(300)
        self._bridge = bridge
        self._take: Take | None = None
        self._limbs: dict[str, str] = {}
        self._model = QueueModel(self)
        self._shown = QueueFilter(self)
        self._shown.setSourceModel(self._model)
        self._count = label("", "muted", "queue-count")
        self._filters = FilterBar()
        self._table = self._make_table()
        self._hint = Hint(self._table.viewport(), "queue-hint")
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(header("Queue", self._count, TakeChooser(bridge)))
        column.addWidget(self._filters)
        column.addWidget(self._table, 1)
        self._filters.changed.connect(self._filter_again)
        self._table.selectionModel().currentRowChanged.connect(self._current_changed)
        bridge.changed.connect(self.show_state)
        bridge.ui_changed.connect(self._show_ui)
        self.show_state(None, bridge.state)

    @property
    def selected(self) -> tuple[str, ...]:
        """Ids of the selected flags, top to bottom; the document's own where no row is."""
        rows = sorted(index.row() for index in self._table.selectionModel().selectedRows())
        ids = tuple(self._id(row) for row in rows)
        flag = self._bridge.state.selection.flag
        if flag is not None and flag not in ids:
            return (flag,)
        return ids

    def beside(self, step: int) -> str | None:
        """Id of the flag `step` rows below the selected one, around the ends."""
        rows = self._shown.rowCount()
        if not rows:
            return None
        at = self._row(self._bridge.state.selection.flag)
        if at is None:
            return self._id(0 if step > 0 else rows - 1)
        return self._id((at + step) % rows)

    def following(self, decided: Iterable[str]) -> str | None:
        """Id of the next open flag below those, around the end; None where none is left."""
        ids = set(decided)
        order = [self._id(row) for row in range(self._shown.rowCount())]
        last = max((row for row, one in enumerate(order) if one in ids), default=-1)
        state = self._bridge.state
        for one in [*order[last + 1 :], *order[: last + 1]]:
            item = state.item(one)
            if one not in ids and item and item.current and item.verdict is Verdict.OPEN:
                return one
        return None

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Leave out columns that there is no room for."""
        super().resizeEvent(event)
        left = event.size().width() - _JOINT_WIDTH - sum(_WIDTHS.values())
        for column in _DISPENSABLE:
            self._table.setColumnHidden(column, left < 0)
            left += _WIDTHS[column] if left < 0 else 0

    def select_all(self) -> None:
        """Select every row that is shown."""
        self._table.selectAll()

    def focus_filter(self) -> None:
        """Put the cursor in the filter's text."""
        self._filters.search.setFocus(Qt.FocusReason.ShortcutFocusReason)
        self._filters.search.selectAll()

    def show_state(self, old: DocumentState | None, new: DocumentState) -> None:
        """Show the queue and the selection of a state."""
        if new.take is not self._take:
            self._take = new.take
            self._limbs = {} if new.take is None else _limb_names(new.take)
        if old is None or old.queue is not new.queue or old.active != new.active:
            self._model.show(new.queue, new.take)
            present = {self._limbs.get(item.flag.joint, "") for item in new.queue}
            limbs = [name for name in dict.fromkeys(self._limbs.values()) if name in present]
            self._filters.offer(sorted({str(i.flag.kind) for i in new.queue}), limbs)
            self._shown.set_filter(self._filters.filter, self._limbs)
            self._count.setText(_summary(new.queue))
        if old is None or old.selection != new.selection or old.queue is not new.queue:
            self._select(new.selection.flag)
        if old is None or not only_frame_differs(old, new):
            self._show_hint()

    def _show_ui(self, old: UiState, new: UiState) -> None:
        if old.theme != new.theme:
            self._filters.recolour()
            self._model.show(self._model.items, self._take)
        self._show_hint()

    def _show_hint(self) -> None:
        state = self._bridge.state
        if self._shown.rowCount():
            self._hint.say("")
        elif self._model.items:
            self._hint.say("No flag passes the filter.")
        elif state.take is None:
            self._hint.say("The flags of a take are listed here, worst first.")
        elif self._bridge.ui.analysing:
            self._hint.say("Looking for flags…")
        elif state.analysis is None:
            self._hint.say("Not analysed yet.\nPress F5 to look for flags.")
        else:
            self._hint.say("No flag above the threshold.\nLower it to see more.")

    def _filter_again(self) -> None:
        self._shown.set_filter(self._filters.filter, self._limbs)
        self._select(self._bridge.state.selection.flag)
        self._show_hint()

    def _current_changed(self, current: QModelIndex, _: QModelIndex) -> None:
        if not current.isValid():
            return
        flag = self._id(current.row())
        if flag != self._bridge.state.selection.flag and self._bridge.state.item(flag):
            self._bridge.document.select_flag(flag)

    def _select(self, flag: str | None) -> None:
        row = self._row(flag)
        selection = self._table.selectionModel()
        if row is None:
            if flag is None:
                selection.clear()
            return
        index = self._shown.index(row, 0)
        # Leave a selection of several rows alone while the flag is among them.
        if not selection.isRowSelected(row, QModelIndex()):
            flags = QItemSelectionModel.SelectionFlag
            selection.setCurrentIndex(index, flags.ClearAndSelect | flags.Rows)
        elif selection.currentIndex().row() != row:
            selection.setCurrentIndex(index, QItemSelectionModel.SelectionFlag.NoUpdate)
        self._table.scrollTo(index)

    def _id(self, row: int) -> str:
        source = self._shown.mapToSource(self._shown.index(row, 0)).row()
        return self._model.items[source].flag.id

    def _row(self, flag: str | None) -> int | None:
        source = self._model.row_of(flag)
        if source is None:
            return None
        index = self._shown.mapFromSource(self._model.index(source, 0))
        return index.row() if index.isValid() else None

    def _make_table(self) -> QTableView:
        table = _Table()
        table.setObjectName("queue-table")
        table.setModel(self._shown)
        table.setItemDelegate(QueueDelegate(table))
        table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        table.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        table.setShowGrid(False)
        table.setWordWrap(False)
        table.setTabKeyNavigation(False)
        table.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        table.verticalHeader().hide()
        table.verticalHeader().setDefaultSectionSize(26)
        table.setFont(theme.numbers_font())
        head = table.horizontalHeader()
        head.setObjectName("queue-header")
        head.setHighlightSections(False)
        head.setMinimumSectionSize(24)
        head.setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        head.setSectionResizeMode(Column.JOINT, QHeaderView.ResizeMode.Stretch)
        for column, width in _WIDTHS.items():
            table.setColumnWidth(column, width)
        table.setSortingEnabled(True)
        table.sortByColumn(Column.RANK, Qt.SortOrder.AscendingOrder)
        return table


def _limb_names(take: Take) -> dict[str, str]:
    names = take.skeleton.names
    limbs = {names[j]: limb.name for limb in topology(take.skeleton).limbs for j in limb.joints}
    return {ROOT_POSITION: "root", ROOT_HEADING: "root", **limbs}


def _summary(queue: tuple[QueueItem, ...]) -> str:
    if not queue:
        return ""
    counts = Counter(item.verdict for item in queue)
    return f"{counts[Verdict.OPEN]} of {len(queue)} open"
