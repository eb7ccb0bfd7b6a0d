"""Starts the desk."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import FrameType, TracebackType
from typing import TYPE_CHECKING

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication

from mocapstudio.gui import icons, settings, theme
from mocapstudio.motion.errors import MocapError

if TYPE_CHECKING:
    from mocapstudio.formats import ReadOptions
    from mocapstudio.gui.compare.live_opening import LiveRequest

# Threads that hold the interpreter give it to the desk after this many seconds.
_SWITCH = 0.002

_INTERRUPTED = 130


def run(
    paths: Sequence[Path] = (),
    context: Sequence[Path] = (),
    partners: Sequence[Path] = (),
    options: ReadOptions | None = None,
    renamed: Mapping[str, str] | None = None,
    live: LiveRequest | None = None,
) -> int:
    """Open the desk and return the exit code when it is closed.

    Parameters
    ----------
    paths
        Takes, folders of takes, or one session.
    context
        Takes and folders that are searched for neighbours.
    partners
        Takes of other performers in the same scene.
    options
        What replaces the files' own rate, unit and up axis.
    renamed
        Joints of the context, by name, and what they are called in the take.
    live
        A live performance to begin with, in the Compare workspace.

    Raises
    ------
    MocapError
        If there is no display.
    """
    app = make_application()
    from mocapstudio.gui.main_window import MainWindow
    from mocapstudio.review.manner import Manner

    with _ending_at_interrupts():
        window = MainWindow()
        _catch_faults(window.messages.complain)
        window.start()
        manner = Manner(options, renamed or {})
        window.open(list(paths), list(context), list(partners), manner)
        if live is not None:
            from mocapstudio.gui.compare.live_opening import open_live

            open_live(window, live)
        code = app.exec()
    sys.excepthook = sys.__excepthook__
    return code


def make_application() -> QApplication:
    """Set up the application with name, icon and theme; an existing one is used again.

    Raises
    ------
    MocapError
        If there is no display.
    """
    existing = QApplication.instance()
    if isinstance(existing, QApplication):
        app = existing
    else:
        _check_display()
        app = QApplication(sys.argv[:1])
    app.setApplicationName("mocapstudio")
    app.setApplicationDisplayName("mocapstudio")
    app.setDesktopFileName("mocapstudio")
    sys.setswitchinterval(_SWITCH)
    theme.apply(app, theme.THEMES.get(settings.text("theme", "dark"), theme.DARK))
    app.setWindowIcon(icons.application_icon())
    return app


def _check_display() -> None:
    if not sys.platform.startswith("linux") or os.environ.get("QT_QPA_PLATFORM"):
        return
    if not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
        raise MocapError("no display: neither DISPLAY nor WAYLAND_DISPLAY is set")


@contextmanager
def _ending_at_interrupts() -> Iterator[None]:
    """End the desk at Ctrl-C without an exception, at which Qt or VTK would end the process."""
    before = signal.getsignal(signal.SIGINT)
    if before is signal.SIG_IGN:
        yield
        return

    def end(_number: int, _frame: FrameType | None) -> None:
        # By a timer: what is said before the event loop runs would be lost.
        QTimer.singleShot(0, lambda: QApplication.exit(_INTERRUPTED))

    signal.signal(signal.SIGINT, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _catch_faults(complain: Callable[[BaseException, str], None]) -> None:
    """Show exceptions that nobody caught; the desk stays open."""
    told: set[str] = set()

    def hook(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
        if isinstance(error, MocapError):
            complain(error, "This could not be done")
            return
        sys.__excepthook__(kind, error, trace)
        # What goes wrong at every frame must not fill the screen with dialogs.
        fault = f"{kind.__name__}: {error}"
        if fault not in told:
            told.add(fault)
            complain(error, "Internal fault")

    sys.excepthook = hook
