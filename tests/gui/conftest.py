"""A desk in a real window, with settings and state of its own."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from pathlib import Path

import pytest
from hands import CTRL, Hands
from PySide6.QtCore import QEvent, QEventLoop, QSettings
from PySide6.QtWidgets import QApplication

from mocapstudio import formats


@dataclass(frozen=True)
class Generated:
    """Files of a generated take with errors."""

    take: Path
    context: tuple[Path, ...]


@pytest.fixture(scope="session")
def generated_source(tmp_path_factory) -> Path:
    """Twenty seconds of the demo take with errors, and as much of a clean one, as BVH."""
    from mocapstudio.evaluation.demo import demo_context, demo_with_errors

    folder = tmp_path_factory.mktemp("generated")
    take, _ = demo_with_errors()
    clean = demo_context()[0]
    for one in (take, clean):
        part = replace(one, rotations=one.rotations[:1200], translations=one.translations[:1200])
        formats.write(part, folder / f"{one.name}.bvh")
    (folder / f"{take.name}.bvh").rename(folder / "take.bvh")
    (folder / f"{clean.name}.bvh").rename(folder / "clean.bvh")
    return folder


@pytest.fixture
def generated(generated_source, tmp_path) -> Generated:
    """The generated files in a folder that a test may write to."""
    context = tmp_path / "context"
    context.mkdir()
    take, clean = tmp_path / "take.bvh", context / "clean.bvh"
    take.write_bytes((generated_source / "take.bvh").read_bytes())
    clean.write_bytes((generated_source / "clean.bvh").read_bytes())
    return Generated(take, (clean,))


@pytest.fixture
def own_settings(tmp_path_factory, monkeypatch) -> Path:
    """Settings and state in a folder of the test's own."""
    folder = tmp_path_factory.mktemp("home")
    QSettings.setPath(QSettings.Format.IniFormat, QSettings.Scope.UserScope, str(folder / "config"))
    monkeypatch.setenv("XDG_STATE_HOME", str(folder / "state"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(folder / "cache"))
    monkeypatch.setenv("XDG_DATA_HOME", str(folder / "data"))
    return folder


@pytest.fixture
def open_desk(qapp, qtbot, own_settings):
    """Opens desks, and closes them at the end without a question."""
    from mocapstudio.gui.application import make_application
    from mocapstudio.gui.main_window import MainWindow

    make_application()
    windows: list[MainWindow] = []

    def open_one(width: int = 1440, height: int = 900) -> MainWindow:
        window = MainWindow()
        windows.append(window)
        window.resize(width, height)
        window.move(0, 0)
        with qtbot.waitSignal(window.workspace.filled, timeout=60_000):
            window.start()
        window.activateWindow()
        qtbot.waitUntil(window.isActiveWindow)
        return window

    yield open_one
    for window in windows:
        window.close_without_asking()
        window.deleteLater()
    qapp.processEvents()
    # Outside an event loop nothing else deletes them, and the next change of theme would still
    # style what is left of them.
    qapp.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    qapp.processEvents()


@pytest.fixture
def desk(open_desk):
    """One desk, nothing open."""
    return open_desk()


@pytest.fixture
def hands(desk, qtbot) -> Hands:
    """A user at that desk."""
    return Hands(desk, qtbot)


@pytest.fixture(scope="module")
def window(qapp, tmp_path_factory):
    """One desk for all tests of this file, with settings of its own: opening one takes seconds."""
    from mocapstudio.gui.application import make_application
    from mocapstudio.gui.main_window import MainWindow

    home = tmp_path_factory.mktemp("home")
    QSettings.setPath(QSettings.Format.IniFormat, QSettings.Scope.UserScope, str(home / "config"))
    with pytest.MonkeyPatch.context() as patch:
        for name in ("STATE_HOME", "CACHE_HOME", "DATA_HOME"):
            patch.setenv(f"XDG_{name}", str(home / name))
        make_application()
        made = MainWindow()
        made.resize(1440, 900)
        made.move(0, 0)
        filled = []
        made.workspace.filled.connect(lambda: filled.append(True))
        made.start()
        while not filled:
            qapp.processEvents(QEventLoop.ProcessEventsFlag.AllEvents, 50)
        yield made
        made.close_without_asking()
        made.deleteLater()
        qapp.processEvents()
        qapp.sendPostedEvents(None, QEvent.Type.DeferredDelete)


@pytest.fixture
def compare_hands(window, qtbot):
    """A user at that shared desk, who finds it empty and in the Compare workspace."""
    from mocapstudio.comparison.parameters import ComparisonParameters
    from mocapstudio.gui.compare.bridge import CompareUi
    from mocapstudio.gui.compare.live_bridge import LiveShown
    from mocapstudio.review.document import Document

    user = Hands(window, qtbot)
    window.jobs.cancel()
    window.bridge.replace(Document())
    window.activateWindow()
    qtbot.waitUntil(window.isActiveWindow, timeout=20_000)
    user.press("3", CTRL)
    workspace = window.switching.front
    workspace.live_mode.hang_up()
    workspace.live_mode.stop()
    workspace.live.set(**vars(LiveShown()))
    workspace.bridge.sitting.clear()
    workspace.bridge.sitting.set_parameters(ComparisonParameters())
    workspace.bridge.set_ui(**asdict(CompareUi()))
    yield user
    # What one test leaves open must not stand in the way of the next.
    while (modal := QApplication.activeModalWidget()) is not None:
        modal.close()


@pytest.fixture(scope="session")
def slipping(tmp_path_factory) -> Path:
    """A walk that begins standing; the whole body slips along x at 0.15 m/s."""
    from contacts_user import write_slipping

    return write_slipping(tmp_path_factory.mktemp("slipping") / "walk.bvh")
