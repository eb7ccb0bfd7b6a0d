"""Pages behind a narrow row of tabs; a page is made when it is first shown."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import QStackedWidget, QTabBar, QVBoxLayout, QWidget


@dataclass(frozen=True)
class Page:
    """One page.

    Parameters
    ----------
    text
        On its tab.
    tip
        What it shows, with its key.
    make
        Makes it.
    """

    text: str
    tip: str
    make: Callable[[], QWidget]


class PageTabs(QWidget):
    """Shows one of several pages."""

    chosen = Signal(int)
    """Which page the user chose."""

    def __init__(self, name: str, pages: tuple[Page, ...]) -> None:
        super().__init__()
        self._pages = pages
        self._made: dict[int, QWidget] = {}
        self.bar = QTabBar()
        self.bar.setObjectName(name)
        self.bar.setProperty("role", "narrow")
        self.bar.setDrawBase(False)
        self.bar.setExpanding(False)
        self.bar.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        for page in pages:
            self.bar.setTabToolTip(self.bar.addTab(page.text), page.tip)
        self._stack = QStackedWidget()
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.bar)
        column.addWidget(self._stack, 1)
        self.bar.currentChanged.connect(self._choose)

    def show_page(self, number: int) -> None:
        """Show a page; it is made if this is the first time."""
        with QSignalBlocker(self.bar):
            self.bar.setCurrentIndex(number)
        if number not in self._made:
            self._made[number] = self._pages[number].make()
            self._stack.addWidget(self._made[number])
        self._stack.setCurrentWidget(self._made[number])

    def _choose(self, number: int) -> None:
        self.show_page(number)
        self.chosen.emit(number)
