"""Brings takes that are open in the desk into the comparison."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QMenu

from mocapstudio.gui.compare.part import WorkspacePart
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.review.comparing import Recording
from mocapstudio.review.performances import joint_performances, marker_performances


class SittingTakes(WorkspacePart):
    """Joints are compared with joints, markers with markers.

    A reference decides which; without one, and where both are open, the user does.
    """

    def take_in(self) -> None:
        """Compare what is open; without a reference the first becomes it."""
        document, reference = self._window.bridge.document, self._bridge.state.reference
        joints, markers = joint_performances(document), marker_performances(document)
        if reference is None and joints and markers:
            self._ask(joints, markers)
            return
        wanted: Sequence[Recording] = joints or markers
        if reference is not None:
            wanted = markers if isinstance(reference, MarkerTake) else joints
        if not wanted:
            holds = "markers" if isinstance(reference, MarkerTake) else "joints"
            self._window.messages.tell(f"No take of {holds}, as the reference is, is open.")
            return
        self._workspace.working.take_in(wanted)

    def _ask(self, joints: Sequence[Recording], markers: Sequence[Recording]) -> None:
        menu = QMenu(self._workspace)
        menu.setObjectName("compare-kind")
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for what, takes in (("&Joints", joints), ("&Markers", markers)):
            names = ", ".join(one.name for one in takes[:3])
            more = f" and {len(takes) - 3} more" if len(takes) > 3 else ""
            action = menu.addAction(f"{what}: {names.replace('&', '&&')}{more}")
            action.triggered.connect(partial(self._chosen, takes))
        middle = self._workspace.rect().center() - QPoint(menu.sizeHint().width() // 2, 0)
        menu.popup(self._workspace.mapToGlobal(middle))

    def _chosen(self, takes: Sequence[Recording], _checked: bool = False) -> None:
        self._workspace.working.take_in(takes)
