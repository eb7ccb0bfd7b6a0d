"""How performances are compared: a form of all parameters."""

from __future__ import annotations

from dataclasses import fields, replace
from functools import partial
from typing import Any

from PySide6.QtCore import QSignalBlocker, QSize, Qt
from PySide6.QtWidgets import (
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QScrollArea,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from mocapstudio.comparison.model import Comparison
from mocapstudio.comparison.parameters import CLOSED, REFERENCE, SOURCE, ComparisonParameters
from mocapstudio.gui import icons
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.parameter_fields import Field, quiet_box
from mocapstudio.gui.widgets.parts import header, label, rule
from mocapstudio.motion.parameters import schemas
from mocapstudio.review.comparing import ComparingState
from mocapstudio.review.comparing_state import only_view_differs

_GROUPS = (
    ("features", "true_speed", "ignore_style", "masked"),
    ("", "begin", "end", "band"),
    ("tolerance", "window", "rate", "rounded"),
)
"""Fields by group; the nameless one tells which performance is a part of the other."""

_EXTENTS = {
    (CLOSED, CLOSED): "both whole",
    (REFERENCE, REFERENCE): "source within",
    (SOURCE, SOURCE): "reference within",
}


class ParameterForm(QFrame):
    """Changes parameters one by one; the sources are compared anew at once.

    Parameters
    ----------
    bridge
        Where state comes from and intents go.
    actions
        The commands behind the buttons.
    """

    def __init__(self, bridge: CompareBridge, actions: Actions) -> None:
        super().__init__()
        self.setObjectName("compare-parameters-form")
        self.setProperty("role", "panel")
        self._bridge = bridge
        self._fields: dict[str, Field] = {}
        self._backs: dict[str, QToolButton] = {}
        self._note = label("", "muted", "parameters-note", wrap=True)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(header("Parameters", actions.tool_button("compare-parameters")))
        inside = QWidget()
        rows = QVBoxLayout(inside)
        rows.setContentsMargins(12, 8, 8, 8)
        rows.setSpacing(7)
        for number, names in enumerate(_GROUPS):
            if number:
                rows.addWidget(rule())
            rows.addLayout(self._group(names))
        rows.addWidget(self._note)
        rows.addStretch(1)
        scroll = QScrollArea()
        scroll.setObjectName("parameters-scroll")
        scroll.setWidgetResizable(True)
        scroll.setFrameShape(QFrame.Shape.NoFrame)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        scroll.setWidget(inside)
        column.addWidget(scroll, 1)
        foot = QHBoxLayout()
        foot.setContentsMargins(8, 6, 8, 8)
        foot.setSpacing(6)
        foot.addWidget(actions.push_button("compare-defaults", "Reset to Defaults"), 1)
        foot.addWidget(actions.push_button("compare-again", "Compare Again"), 1)
        column.addLayout(foot)
        bridge.changed.connect(self._follow)
        self._show(bridge.state)

    def _group(self, names: tuple[str, ...]) -> QGridLayout:
        grid = QGridLayout()
        grid.setHorizontalSpacing(8)
        grid.setVerticalSpacing(5)
        grid.setColumnMinimumWidth(0, 74)
        grid.setColumnStretch(1, 1)
        grid.setColumnMinimumWidth(2, 22)
        known = schemas(ComparisonParameters)
        defaults = ComparisonParameters()
        for row, name in enumerate(names):
            if not name:
                self._add_extent(grid, row)
                continue
            one = Field(name, known[name], getattr(defaults, name), partial(self._set, name))
            self._fields[name] = one
            if known[name].choices or known[name].low is not None:
                grid.addWidget(label(known[name].label, "muted"), row, 0)
                grid.addWidget(one.widget, row, 1)
            else:
                grid.addWidget(one.widget, row, 0, 1, 2)
            grid.addWidget(self._back(one), row, 2)
        return grid

    def _add_extent(self, grid: QGridLayout, row: int) -> None:
        box = quiet_box()
        box.setObjectName("parameter-extent")
        box.setAccessibleName("Extent")
        box.setToolTip(
            "Whether one performance is looked for as a part of the other: as a subsequence."
        )
        for ends, text in _EXTENTS.items():
            box.addItem(text, ends)
        box.setPlaceholderText("other ends")
        box.activated.connect(lambda at: self._set_ends(box.itemData(at)))
        self._extent = box
        grid.addWidget(label("Extent", "muted"), row, 0)
        grid.addWidget(box, row, 1)

    def _back(self, one: Field) -> QToolButton:
        button = QToolButton()
        button.setObjectName(f"parameter-{one.name}-default")
        button.setIcon(icons.icon("undo"))
        button.setFixedSize(22, 22)
        button.setIconSize(QSize(14, 14))
        button.setStyleSheet("padding: 0")
        button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        button.setToolTip(f"Back to the default, {one.worded(one.default)}")
        button.clicked.connect(lambda: self._set(one.name, one.default))
        kept = button.sizePolicy()
        kept.setRetainSizeWhenHidden(True)
        button.setSizePolicy(kept)
        self._backs[one.name] = button
        return button

    # -- intents

    def _set(self, name: str, value: Any) -> None:
        old = self._bridge.state.parameters
        changes = {name: value}
        if name in ("begin", "end") and value != CLOSED:
            changes["band"] = 0.0
        if name == "band" and value > 0:
            changes |= {"begin": CLOSED, "end": CLOSED}
        self._bridge.sitting.set_parameters(replace(old, **changes))

    def _set_ends(self, ends: tuple[str, str]) -> None:
        old = self._bridge.state.parameters
        band = old.band if ends == (CLOSED, CLOSED) else 0.0
        new = replace(old, begin=ends[0], end=ends[1], band=band)
        self._bridge.sitting.set_parameters(new)

    # -- state

    def _follow(self, old: ComparingState, new: ComparingState) -> None:
        if not only_view_differs(old, new):
            self._show(new)

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        for button in self._backs.values():
            button.setIcon(icons.icon("undo"))

    def _show(self, state: ComparingState) -> None:
        parameters = state.parameters
        for one in fields(parameters):
            value, field = getattr(parameters, one.name), self._fields[one.name]
            field.show(value)
            self._backs[one.name].setVisible(value != field.default)
        ends = (parameters.begin, parameters.end)
        with QSignalBlocker(self._extent):
            self._extent.setCurrentIndex(list(_EXTENTS).index(ends) if ends in _EXTENTS else -1)
        text = _left_out(state.comparison)
        self._note.setText(text)
        self._note.setVisible(bool(text))


def _left_out(comparison: Comparison | None) -> str:
    """Say how much of a comparison counts nothing, or "" where all counts."""
    if comparison is None or comparison.unreliable is None:
        return ""
    share = float(comparison.unreliable.mean())
    shown = f"{share:.0%}" if share >= 0.01 else "under 1%"
    return f"{shown} of all joints and frames are left out, as missing or flagged."
