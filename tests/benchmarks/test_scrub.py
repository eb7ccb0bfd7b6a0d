"""How long a frame takes while the play head is dragged through a take, drawn in software.

Run with ``pytest tests/benchmarks/test_scrub.py --benchmark-enable -s``; each line printed is the
time from moving the play head until the window is painted. The figure to hold is 50 ms at the 95th
percentile for the salsa session (``test_the_desk_on_the_salsa_session``).
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QEventLoop
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication, QWidget

from mocapstudio.cleaning.detection import detect
from mocapstudio.cleaning.proposals import propose
from mocapstudio.formats import read
from mocapstudio.gui import theme
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.motion.progress import run
from mocapstudio.motion.take import Take
from mocapstudio.review.document import Document

SIZE = (1440, 900)
FRAMES = 20_000
ROUNDS, WARM = 240, 20


def salsa(data: Path, name: str, frames: int) -> Take:
    """A take of the salsa dancers, run forth and back until it is `frames` long."""
    take = read(data / "cmu_salsa_pairs_bvh" / f"{name}_scaled.bvh")[0][0]
    there = np.arange(take.frames)
    at = np.resize(np.concatenate([there, there[::-1]]), frames)
    return replace(take, rotations=take.rotations[at], translations=take.translations[at])


def dancers(data: Path) -> Document:
    """Two dancers of 20,000 frames."""
    document = Document(author="benchmark")
    document.open_take(salsa(data, "60_10", FRAMES))
    document.open_take(salsa(data, "61_10", FRAMES), partner=True)
    return document


def session(data: Path) -> Document:
    """The dancers with their map, the worst flag selected and its proposal made."""
    document = dancers(data)
    performer = document.state.active
    generation = document.begin_analysis(performer)
    analysis = run(detect(document.source(performer)))
    assert document.finish_analysis(performer, generation, analysis)
    flag = document.state.queue[0].flag
    document.select_flag(flag.id)
    document.set_proposal(flag.id, None, propose(analysis, flag))
    return document


def scrub(window: QWidget, viewport: QWidget, go: Callable[[int], None], label: str) -> list[float]:
    """Drag through the take in steps of all sizes; milliseconds from each step to its picture."""
    app = QApplication.instance()
    painted = []
    canvas = viewport._canvas
    prepare = canvas._prepare
    canvas._prepare = lambda: (prepare(), painted.append(1))
    steps = np.cumsum(np.random.default_rng(1).integers(-90, 110, ROUNDS + WARM)) % FRAMES
    took = []
    busy = time.process_time()
    for frame in steps:
        painted.clear()
        started = time.perf_counter()
        go(int(frame))
        while not painted:
            app.processEvents(QEventLoop.ProcessEventsFlag.AllEvents, 5)
        app.processEvents()
        took.append(1000 * (time.perf_counter() - started))
    busy = 1000 * (time.process_time() - busy) / len(steps)
    canvas._prepare = prepare
    took = took[WARM:]
    print(
        f"\n{label}: {len(took)} frames, median {np.median(took):.1f} ms,"
        f" p95 {np.percentile(took, 95):.1f} ms, worst {max(took):.1f} ms;"
        f" processor {busy:.1f} ms a frame (all threads, whatever else the machine does)"
    )
    return took


def shows_a_skeleton(viewport: QWidget) -> bool:
    """Whether the picture holds more than background: a speed without it would mean nothing."""
    image = viewport.grab().toImage().convertToFormat(QImage.Format.Format_RGB888)
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), -1)
    return int((rows[80:-60] > 110).sum()) > 1500


def measure(benchmark, window, viewport, go, label) -> None:
    times: list[float] = []
    benchmark.pedantic(
        lambda: times.extend(scrub(window, viewport, go, label)), rounds=1, iterations=1
    )
    benchmark.extra_info["p95_ms"] = float(np.percentile(times, 95))
    benchmark.extra_info["median_ms"] = float(np.median(times))
    assert shows_a_skeleton(viewport)


@pytest.mark.parametrize("size", [(1440, 900), (720, 460)], ids=lambda s: f"{s[0]}x{s[1]}")
def test_the_viewport_alone(benchmark, qtbot, data, size):
    from mocapstudio.gui.views.viewport import Viewport

    theme.apply(QApplication.instance(), theme.DARK)
    document = session(data)
    view = Viewport(DocumentBridge(document))
    qtbot.addWidget(view)
    view.resize(*size)
    with qtbot.waitExposed(view):
        view.show()
    qtbot.wait(300)
    measure(benchmark, view, view, document.set_frame, f"viewport alone, {size[0]}x{size[1]}")


def test_the_desk_on_the_salsa_session(benchmark, qtbot, data, tmp_path, monkeypatch):
    from mocapstudio.gui import settings
    from mocapstudio.gui.main_window import MainWindow

    monkeypatch.setattr(settings, "layout", lambda _: None)
    monkeypatch.setattr(settings, "set_layout", lambda *_: None)
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    theme.apply(QApplication.instance(), theme.DARK)
    window = MainWindow()
    qtbot.addWidget(window, before_close_func=lambda one: one.bridge.replace(Document()))
    window.resize(*SIZE)
    window.start()
    qtbot.waitUntil(lambda: window.workspace.viewport is not None, timeout=20_000)
    document = dancers(data)
    window.bridge.replace(document)
    # The desk analyses by itself what it is given.
    qtbot.waitUntil(lambda: bool(document.state.queue), timeout=60_000)
    document.select_flag(document.state.queue[0].flag.id)
    qtbot.waitUntil(lambda: bool(document.state.proposals), timeout=20_000)
    # It goes on refining the map for a minute; here the desk itself is measured.
    window.jobs.cancel()
    qtbot.waitUntil(lambda: not window.jobs.running, timeout=20_000)
    qtbot.wait(500)
    assert (window.width(), window.height()) == SIZE
    measure(benchmark, window, window.workspace.viewport, document.set_frame, "the desk, 1440x900")
