"""What each command does: the one table between commands and parts."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QMenu, QMessageBox

from mocapstudio import __version__
from mocapstudio.cleaning.parameters import CALIBRATED, PAPER
from mocapstudio.gui import settings
from mocapstudio.gui.dialogs.shortcuts import ShortcutsDialog
from mocapstudio.gui.import_link import ImportLink
from mocapstudio.gui.journalling import discard

if TYPE_CHECKING:
    from mocapstudio.gui.main_window import MainWindow

_THRESHOLD_STEP = 0.02


def wire(window: MainWindow) -> None:
    """Connect all commands of a window with its parts."""
    _wire_files(window)
    _wire_decisions(window)
    _wire_play(window)
    _wire_view(window)
    _wire_recent(window)


def _wire_files(window: MainWindow) -> None:
    on, files = window.actions_.on, window.files
    on("open", files.ask_open)
    on("new", files.begin_anew)
    on("partner", files.ask_partner)
    on("context", files.ask_context)
    on("save", files.save)
    on("save-as", files.save_as)
    on("export", files.export)
    on("report", files.report)
    on("import-report", files.show_import_report)
    window.statusBar().addPermanentWidget(ImportLink(window.bridge, files.opening))
    on("close-take", files.close_take)
    on("quit", window.close)
    window.welcome.wanted.connect(lambda path: files.open_paths([path]))
    window.welcome.demo_wanted.connect(files.open_demo)
    window.welcome.recovery_wanted.connect(files.recover)
    window.welcome.discard_wanted.connect(discard)
    on("analyse", window.analysing.again)
    on("cancel", window.jobs.cancel)
    on("learning", window.analysing.toggle_learning)
    on("threshold-up", partial(window.toolbar.step_threshold, _THRESHOLD_STEP))
    on("threshold-down", partial(window.toolbar.step_threshold, -_THRESHOLD_STEP))
    on("calibrated", lambda: _set_mode(window, CALIBRATED))
    on("paper", lambda: _set_mode(window, PAPER))


def _wire_decisions(window: MainWindow) -> None:
    on, deciding, bridge = window.actions_.on, window.deciding, window.bridge
    on("undo", lambda: bridge.document.undo())
    on("redo", lambda: bridge.document.redo())
    on("find", window.workspace.queue.focus_filter)
    on("select-all", window.workspace.queue.select_all)
    on("deselect", lambda: bridge.document.clear_selection())
    on("next", partial(deciding.go, 1))
    on("previous", partial(deciding.go, -1))
    for name in ("accept", "reject", "defer", "reopen", "protect", "unprotect", "edit"):
        on(name, getattr(deciding, name))
    on("reject-like", deciding.reject_like)
    on("keep-ends", lambda: bridge.document.set_keep_ends(not bridge.state.keep_ends))
    on("trim-in", partial(deciding.trim, start=True))
    on("trim-out", partial(deciding.trim, start=False))
    on("trim-clear", deciding.clear_trim)
    deciding.edit_wanted.connect(lambda flag: _show_edit(window, flag))
    for k in range(1, 6):
        on(f"neighbour-{k}", partial(window.reasons.choose, k - 1))
    on("neighbour-0", partial(window.reasons.choose, None))
    on("neighbour-alignment", partial(_show_alignment, window))


def _wire_play(window: MainWindow) -> None:
    on, bridge = window.actions_.on, window.bridge

    def step(by: int) -> None:
        bridge.document.set_frame(bridge.state.frame + by)

    def last() -> None:
        take = bridge.state.take
        bridge.document.set_frame(0 if take is None else take.frames - 1)

    on("play", window.playback.toggle)
    on("frame-back", partial(step, -1))
    on("frame-on", partial(step, 1))
    on("ten-back", partial(step, -10))
    on("ten-on", partial(step, 10))
    on("first", lambda: bridge.document.set_frame(0))
    on("last", last)
    on("loop", window.playback.toggle_loop)
    on("slower", partial(window.workspace.transport.step_speed, -1))
    on("faster", partial(window.workspace.transport.step_speed, 1))


def _wire_view(window: MainWindow) -> None:
    on, bridge, workspace = window.actions_.on, window.bridge, window.workspace
    on("ghosts", lambda: bridge.set_ui(ghosts=not bridge.ui.ghosts))
    on("follow", lambda: bridge.set_ui(follow=not bridge.ui.follow))
    on("onion", lambda: bridge.set_ui(onion=not bridge.ui.onion))
    on("trails", lambda: bridge.set_ui(trails=not bridge.ui.trails))
    on("frame-joint", workspace.frame_joint)
    on("zoom-flag", workspace.zoom_to_flag)
    on("whole-take", workspace.show_whole_take)
    on("distances", lambda: bridge.set_ui(distances=not bridge.ui.distances))
    for name in ("texture", "map"):
        on(f"beside-{name}", partial(_toggle_beside, window, name))
    on("reset-layout", workspace.reset_layout)
    on("theme", lambda: bridge.set_ui(theme="dark" if bridge.ui.theme == "light" else "light"))
    on("full-screen", lambda: window.setWindowState(
        window.windowState() ^ Qt.WindowState.WindowFullScreen))  # fmt: skip
    on("shortcuts", partial(_show_keys, window))
    on("about", lambda: _about(window))


def _show_keys(window: MainWindow) -> None:
    switching = window.switching
    ShortcutsDialog(switching.name, switching.front.answers(), window).open()


def _toggle_beside(window: MainWindow, what: str) -> None:
    window.bridge.set_ui(beside="" if window.bridge.ui.beside == what else what)


def _wire_recent(window: MainWindow) -> None:
    action: QAction = window.actions_["recent"]
    menu = QMenu(window)
    menu.setObjectName("menu-recent")
    menu.setToolTipsVisible(True)
    action.setMenu(menu)

    def fill() -> None:
        menu.clear()
        for path in settings.recent("files"):
            entry = menu.addAction(path.name)
            entry.setToolTip(str(path))
            entry.setEnabled(path.exists())
            entry.triggered.connect(partial(_open, window, path))
        menu.addSeparator()
        clear = menu.addAction("Clear This List")
        clear.setEnabled(bool(settings.recent("files")))
        clear.triggered.connect(lambda: settings.forget_recent("files"))

    menu.aboutToShow.connect(fill)
    fill()


def _open(window: MainWindow, path: Path, _checked: bool = False) -> None:
    window.switching.open_paths([path])


def _set_mode(window: MainWindow, mode: str) -> None:
    window.bridge.document.set_mode(mode)
    # A click on the mode that is in force would otherwise uncheck it.
    window.actions_.follow_state(window.bridge.state)


def _show_edit(window: MainWindow, flag: str) -> None:
    window.actions_["view-inspector"].setChecked(True)
    window.workspace.inspector.show_edit(flag)


def _show_alignment(window: MainWindow) -> None:
    if not window.workspace.inspector.show_alignment():
        window.messages.tell("No neighbour of this flag is known.")


def _about(window: MainWindow) -> None:
    box = QMessageBox(window)
    box.setObjectName("about")
    box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    box.setWindowTitle("About mocapstudio")
    box.setIconPixmap(window.windowIcon().pixmap(64, 64))
    box.setText(f"<b>mocapstudio {__version__}</b>")
    box.setInformativeText(
        "Review and clean motion capture: see where a take contradicts itself and its library,"
        " decide, export.\n\nBSD-3-Clause licence."
    )
    box.open()
