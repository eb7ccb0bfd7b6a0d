"""What is running, how far it is, how long it still takes, and a way to stop it."""

from __future__ import annotations

import time

from PySide6.QtCore import Qt, QTimer
from PySide6.QtWidgets import QHBoxLayout, QProgressBar, QSizePolicy, QToolButton, QWidget

from mocapstudio.gui import wording
from mocapstudio.gui.jobs import Job, Jobs

_PATIENCE = 0.3
"""Work shorter than this many seconds is not shown: it would only flicker."""


class JobStrip(QWidget):
    """Shows what was asked for last and is under way; takes no room in the layout while idle.

    Parameters
    ----------
    jobs
        The jobs.
    cancel
        The button that stops them.
    """

    def __init__(self, jobs: Jobs, cancel: QToolButton) -> None:
        super().__init__()
        self.setObjectName("job-strip")
        self._jobs = jobs
        self._since: dict[Job, float] = {}
        self._bar = QProgressBar()
        self._bar.setObjectName("job-progress")
        self._bar.setRange(0, 1000)
        self._bar.setMinimumWidth(120)
        self._bar.setMaximumWidth(330)
        self._bar.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self._cancel = cancel
        row = QHBoxLayout(self)
        row.setContentsMargins(6, 0, 0, 0)
        row.setSpacing(4)
        row.addWidget(self._bar, 1, Qt.AlignmentFlag.AlignVCenter)
        row.addWidget(cancel)
        row.addStretch(0)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
        self._timer = QTimer(self)
        self._timer.setInterval(100)
        self._timer.timeout.connect(self._follow)
        jobs.changed.connect(self._follow)
        self._follow()

    def _follow(self) -> None:
        running = self._jobs.running
        now = time.monotonic()
        self._since = {job: self._since.get(job, now) for job in running}
        shown = [job for job in running if now - self._since[job] >= _PATIENCE]
        self._bar.setVisible(bool(shown))
        self._cancel.setVisible(bool(shown))
        if running and not self._timer.isActive():
            self._timer.start()
        elif not running:
            self._timer.stop()
        if shown:
            self._show(shown[-1], len(shown))

    def _show(self, job: Job, count: int) -> None:
        progress = job.progress
        left = wording.time_left(job.seconds_left())
        words = [progress.what.capitalize(), f"{100 * progress.done:.0f} %"]
        if left:
            words.append(left)
        if count > 1:
            words.append(f"+{count - 1}")
        text = " · ".join(words)
        self._bar.setValue(round(1000 * progress.done))
        room = self._bar.width() - 12
        metrics = self._bar.fontMetrics()
        self._bar.setFormat(metrics.elidedText(text, Qt.TextElideMode.ElideRight, room))
        more = f"\nand {count - 1} more" if count > 1 else ""
        self._bar.setToolTip(f"{job.title}\n{text}{more}")
