"""The fields above the queue that choose what it shows."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QGridLayout, QSizePolicy, QWidget

from mocapstudio.gui import icons, theme
from mocapstudio.gui.queue.model import VERDICT_ICONS, Filter
from mocapstudio.gui.widgets.fields import SearchField
from mocapstudio.review.model import Verdict


class FilterBar(QWidget):
    """Text, verdict, kind and limb."""

    changed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("queue-filters")
        self.search = SearchField()
        self.search.setObjectName("queue-filter-text")
        self.search.setPlaceholderText("Filter: joint, kind, verdict")
        self.search.setToolTip("Show only flags with these words (Ctrl+F; Esc empties it)")
        self.search.setClearButtonEnabled(True)
        self.search.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self._verdict = _combo("queue-filter-verdict", "Show only flags of this verdict")
        self._kind = _combo("queue-filter-kind", "Show only flags of this kind")
        self._limb = _combo("queue-filter-limb", "Show only flags of this limb")
        self.recolour()
        self.offer((), ())
        grid = QGridLayout(self)
        grid.setContentsMargins(10, 8, 10, 8)
        grid.setSpacing(6)
        grid.addWidget(self.search, 0, 0, 1, 3)
        for column, combo in enumerate((self._verdict, self._kind, self._limb)):
            grid.addWidget(combo, 1, column)
            grid.setColumnStretch(column, 1)
            combo.currentIndexChanged.connect(lambda _: self.changed.emit())
        self.search.textChanged.connect(lambda _: self.changed.emit())

    @property
    def filter(self) -> Filter:
        """The filter that the fields say."""
        return Filter(
            self._verdict.currentData(),
            self._kind.currentData(),
            self._limb.currentData(),
            self.search.text(),
        )

    def offer(self, kinds: Sequence[str], limbs: Sequence[str]) -> None:
        """Offer the kinds and limbs that occur; what was chosen stays chosen."""
        _fill(self._kind, "Kinds", kinds)
        _fill(self._limb, "Limbs", limbs)

    def clear(self) -> None:
        """Let everything pass."""
        self.search.clear()
        for combo in (self._verdict, self._kind, self._limb):
            combo.setCurrentIndex(0)

    def recolour(self) -> None:
        """Draw the verdicts in the colours of the theme in force."""
        if not self._verdict.count():
            self._verdict.addItem("Verdicts", None)
            for verdict in Verdict:
                self._verdict.addItem(verdict.capitalize(), verdict)
        for row, verdict in enumerate(Verdict, start=1):
            picture = icons.icon(VERDICT_ICONS[verdict], theme.current().verdict(verdict))
            self._verdict.setItemIcon(row, picture)


def _combo(name: str, tip: str) -> QComboBox:
    combo = QComboBox()
    combo.setObjectName(name)
    combo.setToolTip(tip)
    combo.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    combo.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
    return combo


def _fill(combo: QComboBox, everything: str, words: Sequence[str]) -> None:
    wanted = [everything, *words]
    if [combo.itemText(i) for i in range(combo.count())] == wanted:
        return
    chosen = combo.currentData()
    combo.clear()
    combo.addItem(everything, None)
    for word in words:
        combo.addItem(word, word)
    combo.setCurrentIndex(max(0, combo.findData(chosen)))
