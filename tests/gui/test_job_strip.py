"""The strip that tells what runs: what was asked for last, and how much else."""

from __future__ import annotations

from collections.abc import Generator
from threading import Event

from PySide6.QtWidgets import QProgressBar, QToolButton

from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.widgets.job_strip import JobStrip
from mocapstudio.motion.progress import Progress


def _until(stop: Event, what: str) -> Generator[Progress, None, None]:
    while not stop.wait(0.01):
        yield Progress(0.4, what)


def test_what_was_asked_for_last_is_shown_first(qtbot) -> None:
    jobs, ends = Jobs(), (Event(), Event())
    strip = JobStrip(jobs, QToolButton())
    qtbot.addWidget(strip)
    strip.resize(600, 40)
    strip.show()
    bar = strip.findChild(QProgressBar)
    for title, stop in zip(("learning", "detecting"), ends, strict=True):
        jobs.start(title, _until(stop, title), lambda _: None, lambda _: None)
    qtbot.waitUntil(lambda: bar.isVisible() and "Detecting" in bar.format(), timeout=5000)
    assert "40 %" in bar.format()
    assert bar.toolTip().endswith("and 1 more")
    ends[1].set()
    qtbot.waitUntil(lambda: "Learning" in bar.format(), timeout=5000)
    assert "more" not in bar.toolTip()
    ends[0].set()
    qtbot.waitUntil(lambda: not bar.isVisible(), timeout=5000)
