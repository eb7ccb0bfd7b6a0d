"""The window: it owns the parts and connects commands with what they do."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QSize, Qt, QTimer
from PySide6.QtGui import QCloseEvent, QGuiApplication, QMouseEvent
from PySide6.QtOpenGLWidgets import QOpenGLWidget
from PySide6.QtWidgets import QAbstractSpinBox, QApplication, QLineEdit, QMainWindow

from mocapstudio.gui import icons, settings, theme
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.analysing import Analysing
from mocapstudio.gui.deciding import Deciding
from mocapstudio.gui.dialogs.trouble import TroubleDialog
from mocapstudio.gui.document import DocumentBridge, UiState, only_frame_differs
from mocapstudio.gui.files_desk import FilesDesk
from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.journalling import Journalling, left_behind
from mocapstudio.gui.messages import Messages
from mocapstudio.gui.playback import Playback
from mocapstudio.gui.reasons import Reasons
from mocapstudio.gui.second_map import SecondMap
from mocapstudio.gui.status_bar import DeskStatusBar
from mocapstudio.gui.switching import Switching
from mocapstudio.gui.trouble import Trouble
from mocapstudio.gui.views.toolbar import DeskToolBar
from mocapstudio.gui.widgets.drop_zones import DropZones
from mocapstudio.gui.wiring import wire
from mocapstudio.gui.workspaces.review import ReviewWorkspace
from mocapstudio.gui.workspaces.welcome import Welcome
from mocapstudio.review.document import Document
from mocapstudio.review.manner import AS_THEY_ARE, Manner
from mocapstudio.review.state import DocumentState

_SIZE = QSize(1440, 900)


class MainWindow(QMainWindow):
    """The desk."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("desk")
        self.setWindowIcon(icons.application_icon())
        self.setMinimumSize(1000, 640)
        self.bridge = DocumentBridge(Document(), self)
        # Before all views, which ask for its colours when they hear of it.
        self.bridge.ui_changed.connect(_put_theme_in_force)
        self.jobs = Jobs(self)
        self.messages = Messages(self)
        self.actions_ = Actions(self)
        self.reasons = Reasons(self.bridge, self.jobs, self)
        self.playback = Playback(self.bridge, self)
        second = SecondMap(self.bridge, self.jobs, self)
        self.workspace = ReviewWorkspace(self.bridge, self.reasons, second, self.actions_)
        self.analysing = Analysing(self.bridge, self.jobs, self.messages, self)
        self.deciding = Deciding(self.bridge, self.workspace.queue, self.jobs, self.messages, self)
        self.journalling = Journalling(self.bridge, self.messages, self)
        self.files = FilesDesk(self)
        self.welcome = Welcome(self.actions_)
        self.toolbar = DeskToolBar(self.bridge, self.jobs, self.actions_)
        self.addToolBar(self.toolbar)
        self.setStatusBar(DeskStatusBar(self.bridge, self.messages))
        self.drops = DropZones(self)
        self.switching = Switching(self)
        self.setCentralWidget(self.switching.pages)
        self.drops.raise_()
        # A window that gets its first OpenGL child only later is torn down and built anew.
        self._opengl = QOpenGLWidget(self)
        self._opengl.setGeometry(0, 0, 1, 1)
        self._opengl.lower()
        self.menus = self.actions_.fill(self.menuBar())
        wire(self)
        self.bridge.changed.connect(self._follow)
        self.bridge.ui_changed.connect(self._follow_ui)
        self.messages.troubled.connect(self._show_troubles)
        self._sure = False
        self._restore()
        self._follow(self.bridge.state, self.bridge.state)
        self.actions_.follow_ui(self.bridge.ui)
        self.switching.restore()

    def start(self) -> None:
        """Show the window, then load what takes longer."""
        for journal in left_behind():
            self.welcome.offer_recovery(journal)
        self.show()
        QTimer.singleShot(0, self.workspace.fill)

    def leave_text_field(self) -> None:
        """Give the keys back to the desk."""
        focus = QApplication.focusWidget()
        if isinstance(focus, QLineEdit | QAbstractSpinBox):
            focus.clearFocus()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Leave a text field by a click beside it."""
        self.leave_text_field()
        super().mousePressEvent(event)

    def closeEvent(self, event: QCloseEvent) -> None:
        """Ask about what is not saved, then remember the layout and end the jobs."""
        if self.bridge.state.dirty and not self._sure:
            event.ignore()
            self.files.save_first(self.close_without_asking)
            return
        if not self._sure and self.switching.hold_back(self.close_without_asking):
            event.ignore()
            return
        self.bridge.set_ui(playing=False)
        settings.set_layout("window", self.saveGeometry())
        self.switching.remember()
        self.jobs.cancel()
        self.jobs.wait(5)
        self.journalling.close()
        super().closeEvent(event)

    def close_without_asking(self) -> None:
        """Close; what was not saved is lost."""
        self._sure = True
        self.close()

    def _restore(self) -> None:
        geometry = settings.layout("window")
        if geometry is None or not self.restoreGeometry(geometry):
            screen = QGuiApplication.primaryScreen().availableGeometry()
            self.resize(_SIZE.boundedTo(screen.size()))
            self.move(screen.topLeft())
        self.workspace.restore()
        self.bridge.set_ui(theme=theme.current().name, learning=settings.flag("learning", True))

    def _follow(self, old: DocumentState, new: DocumentState) -> None:
        if old is not new and only_frame_differs(old, new):
            return
        self.actions_.follow_state(new)
        takes = [one.take for one in new.markers] if new.take is None else [new.take]
        name = takes[0].name if takes else ""
        if new.path is not None:
            name = f"{name} – {new.path.name}" if name else new.path.name
        self.setWindowTitle(f"{name}[*] – mocapstudio" if name else "mocapstudio")
        self.setWindowModified(new.dirty)

    def _follow_ui(self, old: UiState, new: UiState) -> None:
        if old.theme != new.theme:
            self.actions_.recolour()
            self.welcome.refresh()
        self.actions_.follow_ui(new)

    def _show_troubles(self, troubles: tuple[Trouble, ...]) -> None:
        dialog = TroubleDialog(troubles, self)
        dialog.setWindowModality(Qt.WindowModality.WindowModal)
        dialog.open()

    def open(
        self,
        paths: list[Path],
        context: list[Path],
        partners: list[Path],
        manner: Manner = AS_THEY_ARE,
    ) -> None:
        """Open what the command line named, read as it asks."""
        self.files.opening.ask_for(manner)
        if context:
            self.files.opening.set_context(context)
        if paths or partners:
            self.files.open_paths(paths, partners)


def _put_theme_in_force(old: UiState, new: UiState) -> None:
    if old.theme != new.theme:
        app = QApplication.instance()
        assert isinstance(app, QApplication)
        theme.apply(app, theme.THEMES[new.theme])
        settings.set_text("theme", new.theme)
