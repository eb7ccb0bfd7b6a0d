"""What the commands of live mode do, and what play and stepping mean while it is on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from mocapstudio.comparison.weights import read_weights
from mocapstudio.gui import settings
from mocapstudio.gui.compare.live_bridge import Phase
from mocapstudio.gui.compare.part import WorkspacePart
from mocapstudio.gui.compare.weight_rows import check_weights
from mocapstudio.gui.dialogs.files import FileRequest, ask_for_files
from mocapstudio.gui.workspaces.workspace import Answers
from mocapstudio.motion.errors import MocapError

if TYPE_CHECKING:
    from mocapstudio.gui.main_window import MainWindow
    from mocapstudio.gui.workspaces.compare import CompareWorkspace

_FILTER = "Weights (*.json)"
_PLAYABLE = frozenset({Phase.RUNNING, Phase.PAUSED, Phase.ENDED})
_STEPPING = ("frame-back", "frame-on", "ten-back", "ten-on", "last", "loop")


class LiveAnswering(WorkspacePart):
    """Connects the commands with live mode.

    Parameters
    ----------
    window, workspace
        See `WorkspacePart`.
    """

    def __init__(self, window: MainWindow, workspace: CompareWorkspace) -> None:
        super().__init__(window, workspace)
        self._live, self._mode = workspace.live, workspace.live_mode
        self._slots: dict[str, Callable[[], object]] = {
            "compare-live": self._mode.switch,
            "live-restart": self._mode.restart,
            "live-wait": lambda: self._mode.set_wait(not self._live.shown.wait),
            "weights-open": self.ask_weights,
            "weights-none": lambda: self._mode.use(None),
            "weights-show": self._show_weights,
            "compare-matrix": self._show_matrix,
        }

    def answers(self, base: Answers) -> Answers:
        """Add live mode to what the workspace answers without it."""
        shown = self._live.shown
        slots = dict(base.slots) | self._slots
        allowed = dict(base.allowed) | {
            "compare-live": shown.on or self._mode.possible,
            "live-restart": shown.phase in _PLAYABLE,
            "live-wait": True,
            "weights-open": True,
            "weights-none": shown.weights is not None,
            "weights-show": True,
        }
        checked = dict(base.checked) | {
            "compare-live": shown.on,
            "live-wait": shown.wait,
            "weights-show": shown.weights_shown,
        }
        if not shown.on:
            return replace(base, slots=slots, allowed=allowed, checked=checked)
        slots |= {"play": self._mode.toggle, "first": self._mode.restart}
        playable = shown.phase in _PLAYABLE
        if shown.phase is Phase.ENDED and shown.streams:
            playable = False
        allowed |= {"play": playable, "first": shown.phase in _PLAYABLE}
        allowed |= dict.fromkeys((*_STEPPING, "compare-multiples", "compare-path"), False)
        allowed |= dict.fromkeys(("slower", "faster"), not shown.streams)
        playing = shown.phase is Phase.RUNNING
        return replace(base, slots=slots, allowed=allowed, checked=checked, playing=playing)

    def ask_weights(self) -> None:
        """Ask for a file of weights."""
        request = FileRequest("Open weights", "weights", filters=_FILTER)
        ask_for_files(self._window, request, lambda paths: self.open_weights(paths[0]))

    def open_weights(self, path: Path) -> None:
        """Align with the weights of a file, and show them."""
        try:
            weights = read_weights(path)
        except MocapError as error:
            self._window.messages.complain(error, "The weights could not be read")
            return
        reference = self._bridge.state.reference
        if reference is not None:
            try:
                check_weights(weights, reference)
            except MocapError as error:
                self._window.messages.complain(error, f"{path.name} does not fit the reference")
                return
        settings.set_folder("weights", path)
        self._bridge.set_ui(matrix=False)
        self._live.set(weights_shown=True)
        self._mode.use(weights, path.name)

    def _show_weights(self) -> None:
        # Matrix and weights have one place.
        self._bridge.set_ui(matrix=False)
        self._live.set(weights_shown=not self._live.shown.weights_shown)

    def _show_matrix(self) -> None:
        self._live.set(weights_shown=False)
        self._bridge.set_ui(matrix=not self._bridge.ui.matrix)
