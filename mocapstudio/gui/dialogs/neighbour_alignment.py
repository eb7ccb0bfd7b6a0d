"""How a flag's neighbours answer to the flagged span: the matrix behind each distance."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QSignalBlocker, Qt
from PySide6.QtWidgets import QDialog, QHBoxLayout, QVBoxLayout, QWidget

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.distance_profile import DistanceProfile
from mocapstudio.cleaning.model import Flag, Neighbour
from mocapstudio.cleaning.neighbour_alignment import NeighbourAlignment, neighbour_alignment
from mocapstudio.gui.compare.matrix_plot import MatrixPlot
from mocapstudio.gui.compare.parameter_fields import quiet_box
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.widgets.parts import label
from mocapstudio.review.matrix_model import KnownMatrix, Picture, neighbour_matrix
from mocapstudio.review.state import DocumentState


class NeighbourAlignmentDialog(QDialog):
    """Stands beside the desk; a click on the path goes there in the take under review.

    Parameters
    ----------
    bridge
        The document's door.
    analysis, flag, profile, neighbours
        What was looked for, and what was found: nearest first.
    parent
        The window.
    """

    def __init__(
        self,
        bridge: DocumentBridge,
        analysis: Analysis,
        flag: Flag,
        profile: DistanceProfile,
        neighbours: Sequence[Neighbour],
        parent: QWidget | None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName("neighbour-alignment")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(f"Alignment of {flag.joint}")
        self.resize(520, 580)
        self._bridge, self._flag = bridge, flag
        self._analysis, self._profile, self._neighbours = analysis, profile, tuple(neighbours)
        self._found: NeighbourAlignment | None = None
        self._matrix: KnownMatrix | None = None
        self._box, self._picture = quiet_box(), quiet_box()
        self._words = label("", "muted", "alignment-words", wrap=True)
        self.plot = MatrixPlot(("neighbour", "flagged span"))
        self.plot.setObjectName("alignment-plot")
        self._lay_out()
        self.plot.picked.connect(self._go)
        self.plot.zoomed.connect(self._zoom)
        bridge.changed.connect(self._follow)

    def _lay_out(self) -> None:
        self._box.setObjectName("alignment-neighbour")
        for number, one in enumerate(self._neighbours, start=1):
            self._box.addItem(f"{number}   {one.take}   {one.distance:.1f}°")
        self._box.activated.connect(self.show_neighbour)
        self._picture.setObjectName("alignment-picture")
        self._picture.addItems(("pose distances", "accumulated cost"))
        self._picture.activated.connect(lambda _at: self._show())
        self.plot.setToolTip(
            "Distance of every pose of the neighbour (across) from every pose of the flagged span\n"
            "and its margins (up), over the joints that are not flagged: dark is alike.\n"
            "The line is the warping path; the frame is the flagged span."
        )
        column = QVBoxLayout(self)
        column.setContentsMargins(14, 12, 14, 12)
        column.setSpacing(8)
        row = QHBoxLayout()
        row.addWidget(self._box, 3)
        row.addWidget(self._picture, 2)
        column.addLayout(row)
        # A view with a window of its own fills a parent of its own.
        room = QWidget()
        inside = QVBoxLayout(room)
        inside.setContentsMargins(0, 0, 0, 0)
        inside.addWidget(self.plot)
        column.addWidget(room, 1)
        column.addWidget(self._words)

    def show_neighbour(self, which: int) -> None:
        """Show the alignment with one of the neighbours, 0-based."""
        with QSignalBlocker(self._box):
            self._box.setCurrentIndex(which)
        found = neighbour_alignment(self._analysis, self._flag, self._profile, which)
        self._found, self._matrix = found, neighbour_matrix(found)
        self._shown = (-0.5, self._matrix.frames[1] - 0.5)
        take, other = self._analysis.take, self._neighbours[which]
        pairs = len(found.path)
        self._words.setText(
            f"{take.name} from {take.seconds(round(found.own[0])):.2f} s beside {found.take} from"
            f" {found.theirs[0] / found.rates[1]:.2f} s: {other.distance:.1f}° in the mean of"
            f" {pairs} pairs at 24 frames a second."
        )
        self._show()

    def _show(self) -> None:
        if self._found is None:
            return
        each = self._found.own[1]
        first, last = (one * each - 0.5 for one in self._found.flagged)
        picture = list(Picture)[self._picture.currentIndex()]
        box = (first, last, -0.5, self._found.distances.shape[1] * self._found.theirs[1] - 0.5)
        self.plot.show_matrix(self._matrix, picture, self._shown, [box])
        self._follow(self._bridge.state, self._bridge.state)

    def _follow(self, _old: DocumentState, new: DocumentState) -> None:
        found, matrix = self._found, self._matrix
        if found is None or matrix is None:
            return
        if new.take is not self._analysis.take and new.active not in new.analyses:
            self.plot.set_heads(None)
            return
        row = new.frame - found.own[0]
        pairs = matrix.path[matrix.path[:, 0] <= row]
        inside = 0 <= row < matrix.frames[0] and len(pairs)
        self.plot.set_heads((round(row), int(pairs[-1, 1])) if inside else None)

    def _go(self, reference: int, _source: int) -> None:
        if self._found is not None:
            self._bridge.document.set_frame(round(self._found.own[0]) + reference)

    def _zoom(self, left: float, right: float) -> None:
        if self._matrix is None:
            return
        last = self._matrix.frames[1] - 0.5
        wide = min(max(right - left, 6.0), last + 0.5)
        left = min(max(left, -0.5), last - wide)
        self._shown = (left, left + wide)
        self._show()
