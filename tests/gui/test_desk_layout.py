"""How the desk looks: sizes, themes, what it remembers, what it says while it is empty."""

from __future__ import annotations

import pytest
from hands import CTRL, Hands
from PySide6.QtCore import Qt
from PySide6.QtOpenGLWidgets import QOpenGLWidget
from PySide6.QtWidgets import QLabel, QPushButton, QSplitter, QWidget

from mocapstudio.gui import theme
from mocapstudio.gui.workspaces.registry import WORKSPACES


def open_take(hands: Hands, path) -> None:
    # What is learnt meanwhile would rearrange the queue under these hands.
    if hands.window.bridge.ui.learning:
        hands.menu("Analysis", "Learn from the Context")
    hands.press("O", CTRL)
    hands.answer_file_dialog(path)
    hands.see(lambda: len(hands.rows()) > 2, 60)


def cut_texts(window) -> list[str]:
    """What stands on buttons and labels that are too small for it."""
    cut = [
        button.text()
        for button in window.findChildren(QPushButton)
        if button.isVisible() and button.width() < button.minimumSizeHint().width()
    ]
    for one in window.findChildren(QLabel):
        words = one.text()
        shortened = one.wordWrap() or hasattr(one, "full") or "<" in words
        if not one.isVisible() or shortened or not words:
            continue
        if one.fontMetrics().horizontalAdvance(words) > one.width():
            cut.append(words)
    return cut


@pytest.mark.parametrize("size", [(1440, 900), (1280, 720)])
@pytest.mark.parametrize("name", ["dark", "light"])
def test_nothing_is_cut_off(open_desk, qtbot, generated, size, name):
    hands = Hands(open_desk(*size), qtbot)
    if name == "light":
        hands.menu("View", "Light Theme")
        assert theme.current() is theme.LIGHT
    open_take(hands, generated.take)
    hands.press("N")
    hands.see(lambda: hands.shows("neighbour-1") or hands.shows("neighbours-note"))
    assert (hands.window.width(), hands.window.height()) == size
    hands.see(lambda: cut_texts(hands.window) == [])
    if name == "light":
        hands.menu("View", "Light Theme")


def test_native_windows_hold_plots_alone_in_every_workspace(hands, generated):
    open_take(hands, generated.take)
    for one in WORKSPACES:
        hands.window.switching.show(one.name)
        page = hands.window.switching.front
        hands.see(page.isVisible)
        native = [widget for widget in page.findChildren(QWidget) if widget.internalWinId()]
        assert native or one.name in ("compare", "markers")  # which are empty here
        assert not page.internalWinId()
        for widget in native:
            assert not isinstance(widget, QSplitter)
            assert not widget.findChildren(QOpenGLWidget)


def test_the_viewport_shows_a_skeleton_in_the_window(hands, generated):
    open_take(hands, generated.take)
    viewport = hands.find("viewport")

    def colours() -> int:
        picture = viewport.grab().toImage()
        width, height = picture.width(), picture.height()
        middle = {
            picture.pixel(x, y)
            for x in range(width // 4, 3 * width // 4, 3)
            for y in range(height // 4, 3 * height // 4, 3)
        }
        return len(middle)

    hands.see(lambda: colours() > 200)


def test_layout_and_theme_are_remembered(open_desk, qtbot, generated):
    hands = Hands(open_desk(), qtbot)
    open_take(hands, generated.take)
    hands.key(Qt.Key.Key_F9)
    hands.see(lambda: not hands.shows("curves"))
    splitter = hands.find("columns", QSplitter)
    splitter.setSizes([400, 700, 340])
    sizes = splitter.sizes()
    hands.menu("View", "Light Theme")
    hands.window.close()

    other = Hands(open_desk(1000, 700), qtbot)
    assert (other.window.width(), other.window.height()) != (1440, 900)
    other.window.resize(1440, 900)
    open_take(other, generated.take)
    assert not other.shows("curves")
    assert other.find("columns", QSplitter).sizes() == sizes
    assert other.window.bridge.ui.theme == "light"
    other.menu("View", "Reset Layout")
    other.see(lambda: other.shows("curves"))
    other.menu("View", "Light Theme")


def test_another_theme_recolours_what_already_stands_there(hands, generated):
    open_take(hands, generated.take)
    hands.press("N")

    def ink(name: str) -> set[str]:
        picture = hands.find(name).grab().toImage()
        places = ((x, y) for x in range(picture.width()) for y in range(picture.height()))
        return {picture.pixelColor(x, y).name() for x, y in places}

    for old, new in ((theme.LIGHT, theme.DARK), (theme.DARK, theme.LIGHT)):
        hands.see(lambda new=new: new.open in ink("inspector-verdict"))
        assert old.open not in ink("inspector-verdict")
        assert old.text not in ink("active-take")
        hands.menu("View", "Light Theme")


def test_the_frame_box_speaks_the_files_numbers_and_gives_the_keys_back(hands, generated):
    open_take(hands, generated.take)
    first = hands.find("frame").minimum()
    hands.type("frame", str(first + 120))
    hands.see(lambda: hands.text("time") == "2.00 s")
    hands.key(Qt.Key.Key_Right)
    hands.see(lambda: hands.find("frame").value() == first + 121)
    hands.key(Qt.Key.Key_Left, Qt.KeyboardModifier.ShiftModifier)
    hands.see(lambda: hands.find("frame").value() == first + 111)
    hands.key(Qt.Key.Key_Home)
    hands.see(lambda: hands.find("frame").value() == first)


def test_space_plays_wherever_the_focus_is(hands, generated):
    open_take(hands, generated.take)
    for widget in ("queue-table", "digression-map", "viewport"):
        hands.find(widget).setFocus()
        before = hands.find("frame").value()
        hands.key(Qt.Key.Key_Space)
        hands.see(lambda before=before: hands.find("frame").value() > before + 3)
        hands.key(Qt.Key.Key_Space)
        hands.see(lambda: not hands.window.bridge.ui.playing)


def test_the_threshold_flags_again_at_once(hands, generated):
    open_take(hands, generated.take)
    count = len(hands.rows())
    for _ in range(10):
        hands.key(Qt.Key.Key_Minus)
    assert hands.text("threshold-value") == "0.30"
    assert len(hands.rows()) > count
    for _ in range(30):
        hands.key(Qt.Key.Key_Plus)
    assert hands.text("threshold-value") == "0.90"
    assert len(hands.rows()) < count


def test_trim_in_and_out(hands, generated):
    open_take(hands, generated.take)
    first = hands.find("frame").minimum()
    hands.type("frame", str(first + 100))
    hands.press("I")
    hands.type("frame", str(first + 999))
    hands.press("O")
    hands.see(lambda: f"trimmed to {first + 100}–{first + 999}" in hands.text("facts"))
    hands.press("Z", CTRL)
    hands.see(lambda: f"trimmed to {first + 100}–{first + 1199}" in hands.text("facts"))
    hands.press("I", Qt.KeyboardModifier.ShiftModifier)
    hands.see(lambda: "trimmed" not in hands.text("facts"))
