"""Hands on a real window: mouse and key events, nothing else."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QPoint, QRect, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractItemView,
    QApplication,
    QComboBox,
    QFileDialog,
    QLineEdit,
    QMainWindow,
    QMenu,
    QWidget,
)

NONE = Qt.KeyboardModifier.NoModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier
CTRL = Qt.KeyboardModifier.ControlModifier
LEFT = Qt.MouseButton.LeftButton


class Hands:
    """One user at one window.

    Parameters
    ----------
    window
        The window; it must be shown.
    qtbot
        Waits.
    """

    def __init__(self, window: QMainWindow, qtbot) -> None:
        self.window, self.qtbot = window, qtbot

    def find(self, name: str, kind: type = QWidget):
        """The one visible widget of that name, in the window or a dialog over it."""
        for root in (QApplication.activeModalWidget(), self.window):
            if root is None:
                continue
            if root.objectName() == name:
                return root
            found = [one for one in root.findChildren(kind, name) if one.isVisible()]
            if found:
                return found[0]
        raise AssertionError(f"no visible {kind.__name__} named {name!r}")

    def see(self, condition, seconds: float = 20.0) -> None:
        """Look on until something is so."""
        self.qtbot.waitUntil(condition, timeout=int(seconds * 1000))

    def shows(self, name: str) -> bool:
        """Whether a visible widget has that name."""
        try:
            self.find(name)
        except AssertionError:
            return False
        return True

    def click(self, name: str, modifier=NONE) -> None:
        """Click the middle of a widget."""
        self.see(lambda: self.shows(name))
        widget = self.find(name)
        assert widget.isEnabled(), f"{name} is disabled"
        self._hit(widget, widget.rect().center(), modifier)

    def _hit(self, widget: QWidget, at: QPoint, modifier=NONE) -> None:
        """Click what lies uppermost there, as a mouse does."""
        target = widget.childAt(at) or widget
        QTest.mouseClick(target, LEFT, modifier, target.mapFrom(widget, at))

    def press(self, keys: str, modifier=NONE) -> None:
        """Press keys one after the other, wherever the focus is."""
        for key in keys:
            self.key(Qt.Key(ord(key.upper())), modifier)

    def key(self, key: Qt.Key, modifier=NONE) -> None:
        """Press one key wherever the focus is."""
        target = QApplication.focusWidget() or QApplication.activeModalWidget() or self.window
        QTest.keyClick(target, key, modifier)

    def type(self, name: str, text: str, *, enter: bool = True) -> None:
        """Click into a text field, replace what is in it, and press Enter."""
        field = self.find(name)
        self._hit(field, QPoint(8, field.height() // 2))
        # A window that has just opened is given the focus a moment later.
        self.see(lambda: QApplication.focusWidget() is not None)
        target = QApplication.focusWidget()
        QTest.keyClick(target, Qt.Key.Key_A, CTRL)
        QTest.keyClick(target, Qt.Key.Key_Delete)
        QTest.keyClicks(target, text)
        if enter:
            QTest.keyClick(target, Qt.Key.Key_Return)

    def menu(self, *path: str) -> None:
        """Choose an entry of the menus by the mouse, by what it says up to its … and label."""
        bar = self.window.menuBar()
        action = _entry(bar.actions(), path[0])
        QTest.mouseClick(bar, LEFT, NONE, bar.actionGeometry(action).center())
        for words in path[1:]:
            popup = action.menu()
            assert isinstance(popup, QMenu)
            self.see(popup.isVisible)
            action = _entry(popup.actions(), words)
            assert action.isEnabled(), f"{words} is disabled"
            QTest.mouseClick(popup, LEFT, NONE, popup.actionGeometry(action).center())

    def choose(self, name: str, text: str) -> None:
        """Choose an entry of a combo box by the mouse."""
        combo = self.find(name, QComboBox)
        QTest.mouseClick(combo, LEFT, NONE, combo.rect().center())
        view = combo.view()
        self.see(lambda: view.isVisible())
        index = view.model().index(combo.findText(text), 0)
        assert index.isValid(), f"{name} offers no {text!r}"
        self.click_cell(view, view.visualRect(index))

    def click_cell(self, view: QAbstractItemView, cell: QRect, modifier=NONE) -> None:
        """Click a cell of a table or list."""
        QTest.mouseMove(view.viewport(), cell.center())
        QTest.mouseClick(view.viewport(), LEFT, modifier, cell.center())

    def click_row(self, row: int, modifier=NONE) -> None:
        """Click a row of the queue."""
        table = self.find("queue-table")
        self.click_cell(table, table.visualRect(table.model().index(row, 1)), modifier)

    def answer_file_dialog(self, *paths: Path) -> None:
        """Type paths into the file dialog that is open, and press Enter."""
        self.see(lambda: isinstance(QApplication.activeModalWidget(), QFileDialog))
        dialog = QApplication.activeModalWidget()
        field = dialog.findChild(QLineEdit, "fileNameEdit")
        text = str(paths[0]) if len(paths) == 1 else " ".join(f'"{path}"' for path in paths)
        self.qtbot.wait(300)
        QTest.keyClick(field, Qt.Key.Key_A, CTRL)
        QTest.keyClicks(field, text)
        # Its completer looks into the folder in the background; nobody types this fast.
        self.qtbot.wait(300)
        assert field.text() == text
        QTest.keyClick(field, Qt.Key.Key_Return)
        self.see(lambda: QApplication.activeModalWidget() is not dialog)
        self.come_back()

    def come_back(self) -> None:
        """Do what a window manager does when a dialog closes: there is none under Xvfb."""
        (QApplication.activeModalWidget() or self.window).activateWindow()
        self.see(lambda: QApplication.activeWindow() is not None)

    # What the user sees

    def rows(self) -> list[list[str]]:
        """The queue as it is shown: the text of each cell."""
        model = self.find("queue-table").model()
        columns = range(model.columnCount())
        return [[model.index(r, c).data() for c in columns] for r in range(model.rowCount())]

    def selected_rows(self) -> list[int]:
        """Rows of the queue that are selected."""
        selection = self.find("queue-table").selectionModel()
        return sorted(index.row() for index in selection.selectedRows())

    def text(self, name: str) -> str:
        """What a label, a field or a button says."""
        widget = self.find(name)
        return getattr(widget, "full", None) or widget.text()


def _entry(actions, words: str):
    for action in actions:
        text = action.text().replace("&", "").rstrip("…")
        if text == words or text.startswith(f"{words} "):
            return action
    raise AssertionError(f"no entry {words!r} among {[one.text() for one in actions]}")
