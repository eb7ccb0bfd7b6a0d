"""Who is compared: the reference above, the sources below it, the most alike first."""

from __future__ import annotations

from typing import Any

import numpy as np
from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, Qt
from PySide6.QtGui import QColor, QPainter, QPixmap
from PySide6.QtWidgets import QFrame, QScrollArea, QVBoxLayout

from mocapstudio.gui import theme
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.compare import colours as kinds
from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.naming import short_names
from mocapstudio.gui.widgets.parts import ElidedLabel, header, label, panel
from mocapstudio.gui.widgets.tables import column_header, make_table
from mocapstudio.review.comparing import Compared, ComparingState
from mocapstudio.review.comparing_state import only_view_differs

Index = QModelIndex | QPersistentModelIndex

_SAID = 92
"""Pixels for what makes a comparison doubtful; more of it is scrolled to."""

_BUTTONS = ("compare-swap", "compare-reference", "compare-parameters")

_COLUMNS = (
    ("", "Rank: the most alike first"),
    ("Source", "Name of the performance"),
    ("Unlike", "Dissimilarity: mean distance of poses along the warping path, in box units"),
    ("Off", "How far off in time on average, seconds, the overall tempo left aside"),
)


class RankingModel(QAbstractTableModel):
    """The sources by rank.

    Parameters
    ----------
    bridge
        Where state comes from.
    """

    def __init__(self, bridge: CompareBridge) -> None:
        super().__init__()
        self._bridge = bridge
        self._rows: tuple[Compared, ...] = ()
        self._short: dict[str, str] = {}

    def show(self, state: ComparingState) -> None:
        """Show other sources."""
        self.beginResetModel()
        self._rows = state.ranking
        self._short = short_names([one.id for one in state.sources])
        self.endResetModel()

    def source(self, row: int) -> Compared:
        """Return the source in a row."""
        return self._rows[row]

    def row_of(self, source: str) -> int:
        """Row of a source, -1 for none."""
        return next((i for i, one in enumerate(self._rows) if one.id == source), -1)

    def rowCount(self, _parent: Index = QModelIndex()) -> int:  # noqa: B008
        """How many sources there are."""
        return len(self._rows)

    def columnCount(self, _parent: Index = QModelIndex()) -> int:  # noqa: B008
        """Rank, name, dissimilarity, offset."""
        return len(_COLUMNS)

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = 0) -> Any:
        """Name a column."""
        return column_header(_COLUMNS, 2, section, orientation, role)

    def data(self, index: Index, role: int = 0) -> Any:
        """Say what stands in a cell."""
        one, column = self._rows[index.row()], index.column()
        if role == Qt.ItemDataRole.DisplayRole:
            return self._short[one.id] if column == 1 else _text(one, index.row(), column)
        if role == Qt.ItemDataRole.ToolTipRole:
            return _tip(one)
        if role == Qt.ItemDataRole.TextAlignmentRole and column > 1:
            return int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        if role == Qt.ItemDataRole.DecorationRole and column == 1:
            number = self._bridge.state.sources.index(one)
            return _dot(kinds.source(theme.current(), number))
        if role == Qt.ItemDataRole.ForegroundRole and (one.failure or one.linked is None):
            return QColor(theme.current().faint)
        return None


def _text(one: Compared, row: int, column: int) -> str:
    if column == 0:
        return str(row + 1) if one.linked is not None else ""
    if one.comparison is None:
        return ("failed" if one.failure else "…") if column == 2 else ""
    if column == 2:
        doubtful = " ?" if one.comparison.warnings else ""
        return f"{one.comparison.dissimilarity:.3f}{doubtful}"
    return f"{np.abs(one.comparison.misalignment_relative).mean():.2f} s"


def _tip(one: Compared) -> str:
    take = one.take
    lines = [f"{one.id}: {take.duration:.2f} s, {take.frames} frames at {float(take.rate):g} Hz"]
    if take.source is not None:
        lines.append(str(take.source.path))
    if one.failure:
        lines.append(one.failure)
    if one.comparison is not None:
        lines += one.comparison.warnings
    return "\n".join(lines)


def _dot(colour: str) -> QPixmap:
    made = QPixmap(12, 12)
    made.fill(Qt.GlobalColor.transparent)
    p = QPainter(made)
    p.setRenderHint(QPainter.RenderHint.Antialiasing)
    p.setPen(Qt.PenStyle.NoPen)
    p.setBrush(QColor(colour))
    p.drawEllipse(2, 2, 8, 8)
    p.end()
    return made


def _weight(warning: str) -> int:
    """Doubts about the alignment come first, then what its path does, then what was compared."""
    ways = ("doubtful", "answer to", "times as long")
    return next((at for at, words in enumerate(ways) if words in warning), len(ways))


class PerformancesView(QFrame):
    """Reference, ranking of the sources, and what makes the chosen one doubtful.

    Parameters
    ----------
    bridge
        Where state comes from and intents go.
    actions
        The commands behind the buttons.
    """

    def __init__(self, bridge: CompareBridge, actions: Actions) -> None:
        super().__init__()
        self.setObjectName("compare-performances")
        self.setProperty("role", "panel")
        self.setMinimumWidth(250)
        self._bridge = bridge
        self._reference = ElidedLabel()
        self._reference.setProperty("role", "title")
        self._reference.setObjectName("reference-name")
        self._facts = label("", "muted", "reference-facts")
        self._warnings = label("", "muted", "compare-warnings", wrap=True)
        self.model = RankingModel(bridge)
        self.table = make_table("ranking", self.model, (26, 0, 66, 62), 26)
        self.table.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        buttons = [actions.tool_button(n) for n in _BUTTONS]
        column.addWidget(header("Reference", *buttons))
        card = panel("", "")
        inner = QVBoxLayout(card)
        inner.setContentsMargins(12, 6, 12, 8)
        inner.setSpacing(1)
        inner.addWidget(self._reference)
        inner.addWidget(self._facts)
        column.addWidget(card)
        adding = [actions.tool_button(n) for n in ("compare-remove", "compare-sources")]
        column.addWidget(header("Sources", *adding))
        column.addWidget(self.table, 1)
        self._warnings.setContentsMargins(12, 6, 8, 8)
        self._warnings.setAlignment(Qt.AlignmentFlag.AlignTop)
        self._said = QScrollArea()
        self._said.setObjectName("warnings-scroll")
        self._said.setWidgetResizable(True)
        self._said.setFrameShape(QFrame.Shape.NoFrame)
        self._said.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._said.setFixedHeight(_SAID)
        self._said.setWidget(self._warnings)
        column.addWidget(self._said)
        self.table.clicked.connect(lambda index: self._choose(index))
        bridge.changed.connect(self._follow)
        self._show(bridge.state)

    def _choose(self, index: QModelIndex) -> None:
        self._bridge.sitting.choose(self.model.source(index.row()).id)

    def _follow(self, old: ComparingState, new: ComparingState) -> None:
        if not only_view_differs(old, new):
            self._show(new)

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        self._show(self._bridge.state)

    def _show(self, state: ComparingState) -> None:
        take = state.reference
        self._reference.show_text("none yet" if take is None else take.name)
        words = "what the others are compared with"
        if take is not None:
            words = f"{take.duration:.1f} s · {float(take.rate):g} Hz · {take.frames} frames"
        self._facts.setText(words)
        self.model.show(state)
        row = self.model.row_of(state.chosen)
        if row >= 0:
            self.table.selectRow(row)
        comparison, failure = state.comparison, "" if state.source is None else state.source.failure
        doubts = [] if comparison is None else sorted(comparison.warnings, key=_weight)
        text = failure and f"Not compared: {failure}"
        if doubts:
            text = "\n".join(one[:1].upper() + one[1:] + "." for one in doubts)
        self._warnings.setText(text)
        self._said.setVisible(bool(text))
        self._said.verticalScrollBar().setValue(0)
