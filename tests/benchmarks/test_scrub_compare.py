"""How long a frame takes while the play head is dragged through a comparison, in software.

Run with ``pytest tests/benchmarks/test_scrub_compare.py --benchmark-enable -s``; each line printed
is the time from moving the play head until viewports and pictures are painted. The figure to hold
is 50 ms at the 95th percentile for the whole workspace with two viewports.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from made_takes import paced
from PySide6.QtCore import QEventLoop
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication, QWidget

from mocapstudio.formats import read_any
from mocapstudio.gui import theme
from mocapstudio.motion.take import Take

SIZE = (1440, 900)
ROUNDS, WARM = 200, 20


def pupils(take: Take, count: int) -> list[Take]:
    """The same kata at other paces, early and late in turns."""
    at = np.arange(2 * take.frames)
    waves = ((180.0, 77.0), (210.0, 60.0), (150.0, 90.0), (260.0, 70.0))
    made = []
    for number in range(count):
        slow, quick = waves[number % len(waves)]
        pace = 1.0 + 0.4 * np.sin(at / slow + number) + 0.3 * np.sin(at / quick)
        made.append(replace(paced(take, pace), name=f"pupil {number + 1}", source=None))
    return made


def workspace(qtbot, data: Path, tmp_path: Path, monkeypatch, count: int):
    """The desk with the kata compared to so many pupils; returns window and workspace."""
    from mocapstudio.gui import settings
    from mocapstudio.gui.main_window import MainWindow

    monkeypatch.setattr(settings, "layout", lambda _: None)
    monkeypatch.setattr(settings, "set_layout", lambda *_: None)
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    theme.apply(QApplication.instance(), theme.DARK)
    window = MainWindow()
    qtbot.addWidget(window)
    window.resize(*SIZE)
    window.start()
    qtbot.waitUntil(lambda: window.workspace.viewport is not None, timeout=60_000)
    window.actions_["workspace-compare"].trigger()
    compare = window.switching.front
    take = read_any(data / "karate_rmocap_GPL3" / "heian.nidan.bvh")[0][0]
    compare.working.take_in([take, *pupils(take, count)])
    sources = lambda: compare.bridge.state.sources  # noqa: E731
    qtbot.waitUntil(
        lambda: len(sources()) == count and all(one.linked for one in sources()), timeout=120_000
    )
    qtbot.waitUntil(lambda: not window.jobs.running, timeout=20_000)
    qtbot.wait(500)
    return window, compare


def scrub(compare, views: list, go: Callable[[int], None], label: str) -> list[float]:
    """Drag through the kata in steps of all sizes; milliseconds from each step to its picture."""
    app = QApplication.instance()
    painted: set[int] = set()
    kept = [(view.canvas, view.canvas._prepare) for view in views]
    for number, (canvas, prepare) in enumerate(kept):

        def seen(prepare=prepare, number=number) -> None:
            prepare()
            painted.add(number)

        canvas._prepare = seen
    # Every step goes to another frame: one that stays would wait for a paint that never comes.
    ways = np.random.default_rng(1).integers(1, 50, ROUNDS + WARM)
    signs = np.where(np.random.default_rng(2).random(len(ways)) < 0.4, -1, 1)
    frames = compare.bridge.state.source.take.frames
    steps = np.cumsum(ways * signs) % frames
    took = []
    busy = time.process_time()
    for frame in steps:
        painted.clear()
        started = time.perf_counter()
        go(int(frame))
        while len(painted) < len(views):
            app.processEvents(QEventLoop.ProcessEventsFlag.AllEvents, 5)
        app.processEvents()
        took.append(1000 * (time.perf_counter() - started))
    busy = 1000 * (time.process_time() - busy) / len(steps)
    for canvas, prepare in kept:
        canvas._prepare = prepare
    took = took[WARM:]
    print(
        f"\n{label}: {len(took)} frames, median {np.median(took):.1f} ms,"
        f" p95 {np.percentile(took, 95):.1f} ms, worst {max(took):.1f} ms;"
        f" processor {busy:.1f} ms a frame (all threads); load {os.getloadavg()[0]:.1f}"
    )
    return took


def shows_a_skeleton(view: QWidget) -> bool:
    """Whether the picture holds more than background: a speed without it would mean nothing."""
    image = view.grab().toImage().convertToFormat(QImage.Format.Format_RGB888)
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), -1)
    return int((rows[60:-40] > 110).sum()) > 800


@pytest.mark.parametrize(
    ("label", "sources", "ui"),
    [
        ("two viewports, one source", 1, {}),
        ("two viewports and the matrix", 1, {"matrix": True}),
        ("one overlay of eight sources", 8, {"overlay": True, "others": True}),
        ("strips of eight sources", 8, {"multiples": True, "matrix": True}),
    ],
)
def test_the_compare_workspace(benchmark, qtbot, data, tmp_path, monkeypatch, label, sources, ui):
    window, compare = workspace(qtbot, data, tmp_path, monkeypatch, sources)
    compare.bridge.set_ui(**ui)
    compare.bridge.sitting.select_row("LeftHand")
    qtbot.wait(600)
    assert (window.width(), window.height()) == SIZE
    views = [view for view in compare.desk.stage.views if view.isVisible()]
    times: list[float] = []
    benchmark.pedantic(
        lambda: times.extend(scrub(compare, views, compare.bridge.sitting.go_source, label)),
        rounds=1,
        iterations=1,
    )
    benchmark.extra_info["p95_ms"] = float(np.percentile(times, 95))
    assert all(shows_a_skeleton(view) for view in views)
    window.close_without_asking()
