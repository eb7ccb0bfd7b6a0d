"""Under the digression map: the motion-texture, or the map of another context, on the same axes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QShowEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QStackedWidget

from mocapstudio.gui import theme as themes
from mocapstudio.gui.document import DocumentBridge, UiState
from mocapstudio.gui.plots import colours, map_readout
from mocapstudio.gui.plots import map_drawing as drawing
from mocapstudio.gui.plots.context_choice import ContextChoice, CornerButton
from mocapstudio.gui.plots.layers import Layer
from mocapstudio.gui.plots.plot_view import PlotView, in_a_row
from mocapstudio.gui.plots.pooling import PooledMap
from mocapstudio.gui.plots.row_labels import RowLabels
from mocapstudio.gui.plots.rows import Group, RowLayout, limb_groups
from mocapstudio.gui.plots.texture_colours import TexturePicture, turned
from mocapstudio.gui.plots.texture_drawing import TextureKey, draw_texture
from mocapstudio.gui.plots.ticks import clock
from mocapstudio.gui.plots.time_plot import RIGHT_GUTTER, TimePlot
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.gui.second_map import SecondMap
from mocapstudio.review.model import QueueItem, Verdict

if TYPE_CHECKING:
    from mocapstudio.cleaning.analysis import Analysis
    from mocapstudio.motion.take import Take
    from mocapstudio.review.document import DocumentState


class BesideView(PlotView):
    """Shows what `UiState.beside` says; while hidden it does nothing.

    Parameters
    ----------
    bridge
        Where state comes from and intents go.
    second
        The map of another context.
    time_range
        The visible frames, shared with the map.
    """

    def __init__(self, bridge: DocumentBridge, second: SecondMap, time_range: TimeRange) -> None:
        super().__init__()
        self._bridge, self._second = bridge, second
        self._shown: DocumentState | None = None
        self._of: tuple[object, ...] = ()
        self._groups: tuple[Group, ...] = ()
        self._rows = RowLayout((), 0)
        self._pooled: PooledMap | None = None
        self._texture: TexturePicture | None = None
        self._flags: tuple[QueueItem, ...] = ()
        self.time_range = time_range
        self.plot = TimePlot(time_range, axis="top")
        self.labels = RowLabels()
        self.choice = ContextChoice(second, self.labels)
        self.title = CornerButton(self.labels, "beside-title")
        self.title.setToolTip("Rotation of each joint from its own mean, as a colour")
        self.title.say("motion texture")
        self.key = QStackedWidget()
        self.note = QLabel()
        self.empty = QLabel()
        self._picture = self.plot.add_layer(Layer(self._draw, cached=True), 1)
        self._lay_out()
        self.plot.scrubbed.connect(lambda frame: self._bridge.document.set_frame(frame))
        self.plot.hovered.connect(self._hover)
        self.plot.focus_wanted.connect(self._zoom_to_flag)
        self.plot.plotItem.vb.sigResized.connect(lambda *_: self._arrange())
        self.labels.rows_clicked.connect(self._select_rows)
        bridge.changed.connect(lambda _old, new: self._follow(new))
        bridge.ui_changed.connect(self._follow_ui)
        second.changed.connect(lambda: self._follow(bridge.state))

    def _lay_out(self) -> None:
        self.note.setProperty("role", "faint")
        self.note.setObjectName("beside-note")
        self.note.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.note.setContentsMargins(12, 24, 2, 0)
        self.key.addWidget(TextureKey())
        self.key.addWidget(self.note)
        self.key.setFixedWidth(RIGHT_GUTTER)
        self.empty.setObjectName("beside-hint")
        self.empty.setProperty("role", "hint")
        self.empty.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.empty.setWordWrap(True)
        whole = QHBoxLayout(self)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.addWidget(in_a_row(self.labels, self.plot, self.key))
        self.empty.setParent(self.plot)
        self.setMinimumHeight(100)

    # -- state

    def showEvent(self, event: QShowEvent) -> None:
        """Catch up: while it is hidden the view does nothing."""
        super().showEvent(event)
        self._follow(self._bridge.state)

    def _follow_ui(self, old: UiState, new: UiState) -> None:
        if old.beside != new.beside:
            self._follow(self._bridge.state)

    def _follow(self, new: DocumentState) -> None:
        beside = self._bridge.ui.beside
        if not self.isVisible() or not beside:
            return
        was, self._shown = self._shown, new
        take = new.take
        if take is not None and (was is None or take is not was.take):
            self.time_range.set_frames(take.frames)
            self.plot.time_axis.set_clock(float(take.rate), take.first_frame)
        wanted = (beside, take, new.analysis, self._second.analysis, new.threshold)
        if wanted != self._of:
            self._of = wanted
            self._set(take, new.analysis, beside)
        self.choice.show_choice(new.analysis)
        self.choice.setVisible(beside == "map")
        self.title.setVisible(beside == "texture")
        self._say(new, beside)
        self.labels.set_marks(new.selection.joints, (), None, False)
        if was is None or new.frame != was.frame:
            self.plot.set_frame(new.frame)

    def _set(self, take: Take | None, analysis: Analysis | None, beside: str) -> None:
        self._pooled, self._texture, self._groups, self._flags = None, None, (), ()
        self.key.setCurrentIndex(int(beside == "map"))
        second = self._second.analysis
        if take is not None and analysis is not None:
            rows = analysis.texture.joints if beside == "texture" else analysis.map.rows
            self._groups = limb_groups(take.skeleton, rows)
            order = [name for group in self._groups for name in group.rows]
            if beside == "texture":
                columns = np.array([rows.index(name) for name in order], dtype=np.int64)
                self._texture = TexturePicture(turned(analysis.texture), columns)
            elif second is not None and second.take is analysis.take:
                self._set_second(second, order)
        self._arrange()

    def _set_second(self, second: Analysis, order: list[str]) -> None:
        """Keep the rows of the first map; one that the other context lacks stays empty."""
        mapped = second.map
        values = np.zeros((len(mapped.values), len(order)), dtype=np.float32)
        for column, name in enumerate(order):
            if name in mapped.rows:
                values[:, column] = mapped.values[:, mapped.rows.index(name)]
        self._pooled = PooledMap(values, np.arange(len(order), dtype=np.int64))
        self._flags = tuple(QueueItem(flag, Verdict.OPEN) for flag in second.flags)

    def _say(self, state: DocumentState, beside: str) -> None:
        words, second = "", self._second
        if state.take is None or state.analysis is None:
            words = "Analyse a take first"
        elif beside == "map" and second.analysis is None:
            words = "Stopped. Choose a context on the left to draw the map."
            if second.trouble is not None:
                words = second.trouble.line
            elif second.running or self._bridge.ui.analysing:
                words = f"Drawing the map against {second.context}…"
        self.empty.setText(words)
        self.empty.setVisible(bool(words))
        if beside == "map" and second.analysis is not None:
            count, first = len(second.analysis.flags), state.analysis
            before = "" if first is None else f"\nabove: {len(first.flags)}"
            self.note.setText(f"{count} flags{before}")
            self.note.setToolTip("Flags raised by each map at the threshold in force")
        else:
            self.note.setText("")

    def _arrange(self) -> None:
        area = self.plot.area
        self._rows = RowLayout(self._groups, max(int(area.height()), 1))
        self.labels.set_rows(self._rows, int(area.top()))
        self.empty.setGeometry(area.toRect())
        self.plot.refresh_layers()

    def restyle(self) -> None:
        """Take over the colours of the theme in force."""
        self.plot.restyle()
        self.labels.update()
        self.key.update()

    # -- drawing

    def _draw(self, p: QPainter, area: QRectF) -> None:
        state, look = self._shown, themes.current()
        if state is None or state.analysis is None:
            return
        at = drawing.Frame(area, self.time_range, self._rows, look)
        if self._texture is not None:
            texture = state.analysis.texture
            draw_texture(p, at, self._texture, texture.start, texture.frames_each)
            drawing.draw_row_lines(p, at)
        elif self._pooled is not None:
            drawing.draw_cells(p, at, self._pooled, colours.lookup_table(look, state.threshold))
            drawing.draw_row_lines(p, at)
            drawing.draw_flags(p, at, self._flags)

    # -- intents and reading off

    def _select_rows(self, rows: frozenset[str], adds: bool) -> None:
        if self._shown is not None:
            chosen = rows | self._shown.selection.joints if adds else rows
            self._bridge.document.select(joints=chosen, flag="")

    def _zoom_to_flag(self) -> None:
        item = None if self._shown is None else self._shown.selected
        if item is not None:
            self.time_range.focus(item.flag.start, item.flag.end)

    def read_out(self, at: QPointF) -> str:
        """Say in words what lies at a place of the plot, or "" where nothing does."""
        state, area = self._shown, self.plot.area
        row = self._rows.row_at(at.y() - area.top()) if area.contains(at) else None
        if state is None or state.take is None or state.analysis is None or row is None:
            return ""
        frame = self.plot.whole_frame_at(at.x())
        second, texture = self._second.analysis, state.analysis.texture
        if self._pooled is not None and second is not None:
            if row not in second.map.rows:
                return f"{row}\nnot analysed: {self._second.context} lacks this joint"
            place = map_readout.place(second.map, state.take, row, frame)
            return f"{place}\nagainst {self._second.context}"
        place_of = round((frame - texture.start) / texture.frames_each)
        if self._texture is None or not 0 <= place_of < len(texture):
            return ""
        x, y, z = self._texture.degrees[place_of, texture.joints.index(row)].tolist()
        when = f"{clock(state.take.seconds(frame))} · frame {state.take.first_frame + frame}"
        return f"{row}\n{when}\nfrom its mean about x {x:.0f}°, y {y:.0f}°, z {z:.0f}°"

    def _hover(self, at: QPointF | None) -> None:
        self.plot.tell(at, "" if at is None else self.read_out(at))
