"""The toolbar: open, context, analyse, what is running, mode and threshold."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QComboBox, QLabel, QSlider, QToolBar, QToolButton, QWidget

from mocapstudio.cleaning.parameters import CALIBRATED, PAPER, schema
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.document import DocumentBridge, only_frame_differs
from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.widgets.job_strip import JobStrip
from mocapstudio.gui.widgets.parts import label
from mocapstudio.gui.widgets.workspace_switch import WorkspaceSwitch
from mocapstudio.gui.workspaces.registry import WORKSPACES
from mocapstudio.motion.errors import MocapError
from mocapstudio.review.state import DocumentState

_STEPS = 100


class DeskToolBar(QToolBar):
    """The bar under the menus.

    Parameters
    ----------
    bridge
        The document's door.
    jobs
        What is running.
    actions
        The commands behind the buttons.
    """

    def __init__(self, bridge: DocumentBridge, jobs: Jobs, actions: Actions) -> None:
        super().__init__("Toolbar")
        self.setObjectName("toolbar")
        self.setMovable(False)
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.PreventContextMenu)
        self._bridge = bridge
        self._workspace = WORKSPACES[0].name
        # What stands in the bar for some workspaces only, by workspace.
        self._own: dict[str, list[QAction]] = {}
        self._context = actions.tool_button("context", text="Context")
        self._mode = self._make_mode()
        self._slider, self._value = self._make_threshold()
        titles = {f"workspace-{one.name}": one.text.replace("&", "") for one in WORKSPACES}
        self.addWidget(WorkspaceSwitch([actions.tool_button(n, text=t) for n, t in titles.items()]))
        self.addSeparator()
        self._for_review(actions.tool_button("open", text="Open"), actions.tool_button("partner"))
        self._for_review(self._context, None, actions.tool_button("analyse", text="Analyse"))
        self._strip = self.addWidget(JobStrip(jobs, actions.tool_button("cancel")))
        caption = label("Threshold", "muted")
        caption.setContentsMargins(4, 0, 4, 0)
        self._for_review(self._mode, None, caption, self._slider, self._value, None)
        self.addWidget(actions.tool_button("undo"))
        self.addWidget(actions.tool_button("redo"))
        self._for_review(None, actions.tool_button("export"))
        bridge.changed.connect(self._follow)
        self._show(bridge.state)

    def add_tools(self, workspace: str, tools: Sequence[QWidget]) -> None:
        """Add what a workspace has in the bar; it is shown while that one is in front."""
        made = [self.insertWidget(self._strip, one) for one in tools]
        self._own.setdefault(workspace, []).extend(made)
        self.follow_workspace(self._workspace)

    def follow_workspace(self, name: str) -> None:
        """Show what belongs to the workspace in front."""
        self._workspace = name
        for workspace, tools in self._own.items():
            for one in tools:
                one.setVisible(workspace == name)
                button = self.widgetForAction(one)
                if isinstance(button, QToolButton) and button.defaultAction() is not None:
                    # Whatever changes about its place in the bar switches a widget on.
                    button.setEnabled(button.defaultAction().isEnabled())

    def _for_review(self, *tools: QWidget | None) -> None:
        made = [self.addSeparator() if one is None else self.addWidget(one) for one in tools]
        self._own.setdefault("review", []).extend(made)

    def _make_mode(self) -> QComboBox:
        combo = QComboBox()
        combo.setObjectName("mode")
        combo.addItem("Calibrated", CALIBRATED)
        combo.addItem("As in the paper", PAPER)
        combo.setToolTip(
            "Calibrated: each joint is measured by what is normal for it in this context.\n"
            "As in the paper: by its own mean, as published; that flags far more."
        )
        combo.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        combo.activated.connect(lambda row: self._bridge.document.set_mode(combo.itemData(row)))
        return combo

    def _make_threshold(self) -> tuple[QSlider, QLabel]:
        slider = QSlider(Qt.Orientation.Horizontal)
        slider.setObjectName("threshold")
        known = schema("threshold")
        slider.setRange(round(_STEPS * (known.low or 0.0)), round(_STEPS * (known.high or 1.0)))
        slider.setPageStep(5)
        slider.setFixedWidth(104)
        slider.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        slider.setToolTip(f"{known.help}, 0 to 1 (+ and − move it)")
        # Only the user's own moves: a threshold set elsewhere must not come back rounded.
        slider.actionTriggered.connect(lambda _: self._set(slider.sliderPosition() / _STEPS))
        value = label("", "readout", "threshold-value")
        value.setFixedWidth(38)
        value.setAlignment(Qt.AlignmentFlag.AlignCenter)
        return slider, value

    def step_threshold(self, by: float) -> None:
        """Raise or lower the threshold."""
        known = schema("threshold")
        wanted = round(self._bridge.state.threshold + by, 4)
        self._set(min(max(wanted, known.low or 0.0), known.high or 1.0))

    def _set(self, threshold: float) -> None:
        try:
            self._bridge.document.set_threshold(threshold)
        except MocapError as error:
            self._value.setToolTip(str(error))

    def _follow(self, old: DocumentState, new: DocumentState) -> None:
        if not only_frame_differs(old, new):
            self._show(new)

    def _show(self, state: DocumentState) -> None:
        self._value.setText(f"{state.threshold:.2f}")
        self._slider.setValue(round(_STEPS * state.threshold))
        self._mode.setCurrentIndex(max(0, self._mode.findData(state.mode)))
        for widget in (self._slider, self._mode):
            widget.setEnabled(state.take is not None)
        count = len(self._bridge.document.context_takes)
        self._context.setText(f"Context ({count})" if count else "Context")
