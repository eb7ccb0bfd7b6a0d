"""How long the plots of the desk take: a map of 24 rows x 20,000 frames at the desk's size."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from PySide6.QtWidgets import QApplication, QVBoxLayout, QWidget

from mocapstudio.gui import theme as themes
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.gui.views.curves import CurvesView
from mocapstudio.gui.views.digression_map import DigressionMapView

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "gui"))
import plot_scene

FRAMES = 20_000
# A fixed number: the first step may cost nothing, and calibration would ask for thousands.
ROUNDS = 60


@pytest.fixture
def desk(qtbot):
    themes.apply(QApplication.instance(), themes.DARK)
    document = plot_scene.sitting(plot_scene.walking(FRAMES))
    bridge, shared = DocumentBridge(document), TimeRange()
    window = QWidget()
    column = QVBoxLayout(window)
    column.setContentsMargins(0, 0, 0, 0)
    # Held by the window, so that they live as long as it does.
    window.views = (DigressionMapView(bridge, shared), CurvesView(bridge, shared))
    for view, height in zip(window.views, (230, 160), strict=True):
        column.addWidget(view, height)
    window.resize(1440, 392)
    qtbot.addWidget(window)
    window.show()
    qtbot.waitExposed(window)
    document.select_flag(document.state.queue[0].flag.id)
    QApplication.processEvents()
    window.document, window.shared = document, shared
    return window


def test_move_the_play_head(benchmark, desk):
    frames = iter(range(10**9))

    def step():
        desk.document.set_frame(137 * next(frames) % FRAMES)
        QApplication.processEvents()

    benchmark.pedantic(step, rounds=ROUNDS, warmup_rounds=5)
    assert desk.views[0].plot.play_head.isVisible()


def test_set_a_map(benchmark, desk):
    document = desk.document
    take, performer = document.state.take, document.state.active

    def prepare():
        return (plot_scene.analysis_of(take), document.begin_analysis(performer)), {}

    def put(analysis, generation):
        assert document.finish_analysis(performer, generation, analysis)
        QApplication.processEvents()

    benchmark.pedantic(put, setup=prepare, rounds=5)
    assert desk.views[0].plot.isVisible()


def test_zoom(benchmark, desk):
    turns = iter(range(10**9))

    def turn():
        desk.shared.zoom(0.8 if next(turns) % 8 < 4 else 1.25, 9000.0)
        QApplication.processEvents()

    benchmark.pedantic(turn, rounds=ROUNDS, warmup_rounds=5)
    assert desk.shared.length <= FRAMES


def test_step_through_the_flags(benchmark, desk):
    steps = iter(range(10**9))
    ids = [item.flag.id for item in desk.document.state.queue]

    def step():
        desk.document.select_flag(ids[next(steps) % len(ids)])
        QApplication.processEvents()

    benchmark.pedantic(step, rounds=ROUNDS, warmup_rounds=5)
    assert desk.views[1].row is not None


def test_drag_the_threshold(benchmark, desk):
    steps = iter(range(10**9))

    def move():
        desk.document.set_threshold(0.3 + 0.001 * (next(steps) % 400))
        QApplication.processEvents()

    benchmark.pedantic(move, rounds=ROUNDS, warmup_rounds=5)
    assert desk.views[0].bar.threshold == desk.document.state.threshold
