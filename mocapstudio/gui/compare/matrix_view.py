"""The matrix of the chosen source: after the fact or online, distances or accumulated costs."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass

from PySide6.QtCore import QSignalBlocker
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QVBoxLayout, QWidget

from mocapstudio.comparison.online_path import OnlinePath
from mocapstudio.comparison.weights import JointWeights
from mocapstudio.gui.compare.bridge import CompareBridge, CompareUi
from mocapstudio.gui.compare.live_bridge import LiveBridge, LiveShown
from mocapstudio.gui.compare.matrix_plot import Box, MatrixPlot
from mocapstudio.gui.compare.parameter_fields import quiet_box
from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.widgets.parts import Hint
from mocapstudio.motion.progress import Progress
from mocapstudio.review.comparing import Compared, ComparingState, Linked, Recording
from mocapstudio.review.comparing_state import only_heads_differ
from mocapstudio.review.matrix_model import (
    ComparedMatrix,
    KnownMatrix,
    Matrix,
    Picture,
    online_matrix,
)

_JOB = "online matrix"


@dataclass(frozen=True, eq=False)
class Asked:
    """Who is followed, and by which weights."""

    reference: Recording
    source: Compared
    weights: JointWeights | None

    def same(self, other: Asked | None) -> bool:
        """Whether the answer is the same."""
        return (
            other is not None
            and other.reference is self.reference
            and other.source.take is self.source.take
            and other.weights is self.weights
        )


class MatrixView(QFrame):
    """Shows the stretch of time that the pictures show, and goes where it is clicked.

    Parameters
    ----------
    bridge
        Where state comes from and intents go.
    live
        Tells the weights in force online.
    jobs
        Runs the online alignment.
    """

    def __init__(self, bridge: CompareBridge, live: LiveBridge, jobs: Jobs) -> None:
        super().__init__()
        self.setObjectName("compare-matrix-panel")
        self.setProperty("role", "panel")
        self._bridge, self._live, self._jobs = bridge, live, jobs
        self._compared: tuple[Linked, ComparedMatrix] | None = None
        self._online: tuple[Asked, KnownMatrix | str] | None = None
        self._wanted: Asked | None = None
        self._shown: Matrix | None = None
        self.plot = MatrixPlot()
        self.plot.setObjectName("compare-matrix-view")
        self._hint = Hint(self.plot, "matrix-hint")
        self._kind, self._picture = quiet_box(), quiet_box()
        self._lay_out()
        self.plot.picked.connect(bridge.sitting.go_both)
        self.plot.zoomed.connect(bridge.sitting.show)
        bridge.changed.connect(self._follow)
        bridge.ui_changed.connect(self._follow_ui)
        live.changed.connect(self._follow_live)

    @property
    def shown(self) -> Matrix | None:
        """What is drawn, None while there is nothing."""
        return self._shown

    def _lay_out(self) -> None:
        self._kind.setObjectName("matrix-kind")
        self._kind.setToolTip(
            "After the fact: the path that the pictures show.\n"
            "Online: the path found frame by frame, as live mode does, with the weights that are"
            " open;\nthe picture is its costs."
        )
        self._kind.addItems(("after the fact", "online"))
        self._kind.activated.connect(self._choose_kind)
        self._picture.setObjectName("matrix-picture")
        self._picture.setToolTip(
            "Distance of every pose of the source (across) from every pose of the reference (up),\n"
            "or the accumulated cost of the cheapest path to each pair. Dark is alike, or cheap;\n"
            "the line is the warping path, and a click goes to its nearest step."
        )
        self._picture.addItems(("distances", "accumulated"))
        self._picture.activated.connect(
            lambda at: self._bridge.set_ui(matrix_picture=list(Picture)[at])
        )
        bar = QHBoxLayout()
        bar.setContentsMargins(8, 6, 8, 2)
        bar.setSpacing(6)
        bar.addWidget(self._kind, 1)
        bar.addWidget(self._picture, 1)
        # A view with a window of its own fills a parent of its own.
        room = QWidget()
        inside = QVBoxLayout(room)
        inside.setContentsMargins(0, 0, 0, 0)
        inside.addWidget(self.plot)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addLayout(bar)
        column.addWidget(room, 1)

    def _choose_kind(self, at: int) -> None:
        if self._online is not None and isinstance(self._online[1], str):
            # What failed or was cancelled is tried again.
            self._online = None
        self._bridge.set_ui(matrix_online=at == 1)

    # -- state

    def _follow(self, old: ComparingState, new: ComparingState) -> None:
        if not self.isVisible():
            return
        if only_heads_differ(old, new):
            self.plot.set_heads((new.frame, new.source_frame))
        else:
            self._show(new)

    def _follow_ui(self, old: CompareUi, new: CompareUi) -> None:
        if (old.matrix_online, old.matrix_picture) != (new.matrix_online, new.matrix_picture):
            self._show(self._bridge.state)

    def _follow_live(self, old: LiveShown, new: LiveShown) -> None:
        if old.weights is not new.weights and self.isVisible():
            self._show(self._bridge.state)

    def showEvent(self, event: QShowEvent) -> None:
        """Catch up with what happened while out of sight."""
        super().showEvent(event)
        self._show(self._bridge.state)

    def _show(self, state: ComparingState) -> None:
        ui = self._bridge.ui
        for box, at in (
            (self._kind, int(ui.matrix_online)),
            (self._picture, list(Picture).index(ui.matrix_picture)),
        ):
            with QSignalBlocker(box):
                box.setCurrentIndex(at)
        matrix: Matrix | None
        words, boxes = "", list[Box]()
        if ui.matrix_online:
            matrix, words = self._online_of(state)
        else:
            matrix = self._compared_of(state)
            boxes = _boxes(state)
        self._shown = matrix
        self._hint.say(words)
        self.plot.show_matrix(matrix, ui.matrix_picture, state.shown, boxes)
        self.plot.set_heads((state.frame, state.source_frame))

    def _compared_of(self, state: ComparingState) -> ComparedMatrix | None:
        if state.linked is None:
            return None
        if self._compared is None or self._compared[0] is not state.linked:
            self._compared = state.linked, ComparedMatrix(state.linked.comparison)
        return self._compared[1]

    def _online_of(self, state: ComparingState) -> tuple[KnownMatrix | None, str]:
        """Return the matrix, or why there is none."""
        source = state.source
        if source is None or state.reference is None:
            return None, ""
        asked = Asked(state.reference, source, self._live.shown.weights)
        if self._online is not None and asked.same(self._online[0]):
            found = self._online[1]
            return (None, found) if isinstance(found, str) else (found, "")
        if not asked.same(self._wanted):
            self._work(asked)
        return None, f"Following {source.id}…"

    def _work(self, asked: Asked) -> None:
        self._wanted, name = asked, asked.source.id

        def work() -> Generator[Progress, None, OnlinePath]:
            yield Progress(0.0, f"following {name}")
            from mocapstudio.comparison.online_path import following

            take = asked.source.take
            return (yield from following(asked.reference, take, learnt=asked.weights))

        def settle(found: KnownMatrix | str) -> None:
            if self._wanted is asked:
                self._online, self._wanted = (asked, found), None
                self._show(self._bridge.state)

        job = self._jobs.start(
            f"Following {name}",
            work(),
            lambda found: settle(online_matrix(found)),
            lambda error: settle(f"{name} cannot be followed: {error}"),
            key=_JOB,
        )
        job.ended.connect(lambda: settle("Cancelled.") if job.cancelled else None)


def _boxes(state: ComparingState) -> list[Box]:
    if state.linked is None:
        return []
    return [
        (one.reference.start - 0.5, one.reference.end - 0.5,
         one.source.start - 0.5, one.source.end - 0.5)
        for one in state.linked.carried(state.segments)
    ]  # fmt: skip
