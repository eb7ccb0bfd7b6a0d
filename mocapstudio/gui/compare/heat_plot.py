"""Both performances as colours, one below the other, with lines between what matches."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Signal
from PySide6.QtGui import QMouseEvent, QPainter

from mocapstudio.comparison.model import Segment
from mocapstudio.gui.compare import heat_drawing as drawing
from mocapstudio.gui.compare.heat_drawing import Scale
from mocapstudio.gui.compare.heat_layout import Bands, ReferenceAxis, Side, TwinHead, limb_groups
from mocapstudio.gui.compare.layout import Stretch, reference_stretch
from mocapstudio.gui.compare.pooling import PooledPoses, contrast
from mocapstudio.gui.plots.layers import Layer
from mocapstudio.gui.plots.rows import Group, RowLayout
from mocapstudio.gui.plots.time_plot import Gesture, TimePlot
from mocapstudio.gui.plots.time_range import TimeRange
from mocapstudio.review.comparing import Linked

_EDGE = 5.0


class HeatPlot(TimePlot):
    """The source's colours above, the reference's below; the x axis is the source's.

    Dragging in the lane at the bottom draws a segment, or moves the edge of one.

    Parameters
    ----------
    time_range
        Visible source frames.
    """

    reference_scrubbed = Signal(int)
    """The reference frame that the user moved to."""

    segment_drawn = Signal(int, int)
    """Half-open span of the reference that the user drew."""

    segment_moved = Signal(int, int, int)
    """Position of a segment, and the half-open span that the user gave it."""

    segment_chosen = Signal(object)
    """Position of the segment that was clicked, or None."""

    arranged = Signal()
    """Emitted after rows or bands moved."""

    def __init__(self, time_range: TimeRange) -> None:
        self._linked: Linked | None = None
        self._pooled: tuple[PooledPoses, PooledPoses] | None = None
        self._true_speed = False
        self._groups: tuple[Group, ...] = ()
        self._row: str | None = None
        self._segments: tuple[Segment, ...] = ()
        self._segment: int | None = None
        self._draft: Segment | None = None
        self._moving: int | None = None
        self._heads = (0, 0)
        self._dragged = Side.SOURCE
        self.rows = RowLayout((), 0)
        self.reference_axis = ReferenceAxis()
        self._twin = TwinHead()
        self._layers_ready = False
        super().__init__(time_range, axis="bottom", time_axis=self.reference_axis)
        self.scene().removeItem(self.play_head)
        self.scene().addItem(self._twin)
        self._heat = self.add_layer(Layer(self._draw_poses, cached=True), 1)
        self._between = self.add_layer(Layer(self._draw_between, cached=True), 2)
        self._lanes = self.add_layer(Layer(self._draw_lanes, cached=True), 3)
        self._layers_ready = True

    # -- what is shown

    def show_comparison(self, linked: Linked | None, true_speed: bool) -> None:
        """Show another comparison, or none."""
        if linked is not self._linked:
            self._linked = linked
            self._pooled, self._groups = None, ()
            if linked is not None:
                both = linked.comparison
                scale = contrast(both.source_poses, both.reference_poses)
                self._pooled = (
                    PooledPoses(both.source_poses, *scale),
                    PooledPoses(both.reference_poses, *scale),
                )
                self._groups = limb_groups(both)
        self._true_speed = true_speed
        self._place()

    def show_row(self, row: str | None) -> None:
        """Frame another row."""
        if row != self._row:
            self._row = row
            self._between.refresh()

    def show_segments(self, segments: tuple[Segment, ...], selected: int | None) -> None:
        """Show other segments of the reference."""
        self._segments, self._segment = segments, selected
        self._between.refresh()
        self._lanes.refresh()

    def set_frames(self, reference: int, source: int) -> None:
        """Move both play heads."""
        if (reference, source) != self._heads:
            self._heads = reference, source
            self._place_head()

    @property
    def bands(self) -> Bands:
        """Where what stands."""
        return Bands(self.area, self.rows.bottom)

    @property
    def source_scale(self) -> Scale:
        """Source frames over pixels."""
        shown = self.time_range
        return Scale(self.area.left(), self.area.width(), Stretch(shown.start, shown.end))

    @property
    def reference_scale(self) -> Scale:
        """Reference frames over pixels."""
        shown = self.time_range
        stretch = Stretch(shown.start, shown.end)
        if self._linked is not None:
            stretch = reference_stretch(
                self._linked.comparison, shown.start, shown.end, self._true_speed
            )
        return Scale(self.area.left(), self.area.width(), stretch)

    def reference_frame_at(self, x: float) -> int:
        """Reference frame at a pixel, kept within the take."""
        frames = 1 if self._linked is None else self._linked.frames[0]
        return min(max(round(self.reference_scale.frame(x)), 0), frames - 1)

    def source_frame_at(self, x: float) -> int:
        """Source frame at a pixel, kept within the take."""
        frames = 1 if self._linked is None else self._linked.frames[1]
        return min(max(round(self.frame_at(x)), 0), frames - 1)

    def row_at(self, at: QPointF) -> str | None:
        """Row of either performance at a place."""
        bands = self.bands
        side = bands.side(at.y())
        if side is Side.SOURCE:
            return self.rows.row_at(at.y() - bands.source.top())
        if side is Side.REFERENCE:
            return self.rows.row_at(at.y() - bands.reference.top())
        return None

    def segment_at(self, at: QPointF) -> int | None:
        """Position of the segment at a place of the lane, or None."""
        if self.bands.side(at.y()) is not Side.LANE:
            return None
        frame = self.reference_scale.frame(at.x())
        spans = enumerate(self._segments)
        return next((n for n, one in spans if one.start - 0.5 <= frame < one.end - 0.5), None)

    # -- geometry

    def _place(self) -> None:
        if not getattr(self, "_layers_ready", False):
            return
        self.rows = RowLayout(self._groups, Bands.room(self.area.height()))
        self.reference_axis.set_stretch(self.reference_scale.stretch)
        super()._place()
        self.arranged.emit()

    def _place_head(self) -> None:
        reference, source = self._heads
        at = round(self.x_of(source)), round(self.reference_scale.x(reference))
        self._twin.place(self.bands, *at)
        self._twin.setVisible(self._linked is not None)

    # -- drawing

    def _draw_poses(self, p: QPainter, _area: QRectF) -> None:
        if self._pooled is None:
            return
        bands = self.bands
        source, reference = self._pooled
        drawing.draw_poses(p, bands.source, self.source_scale, self.rows, source)
        drawing.draw_poses(p, bands.reference, self.reference_scale, self.rows, reference)

    def _draw_between(self, p: QPainter, _area: QRectF) -> None:
        if self._linked is None:
            return
        bands, source, reference = self.bands, self.source_scale, self.reference_scale
        drawing.draw_timing(p, bands, source, reference, self._linked.comparison)
        drawing.draw_edges(p, bands, source, reference, self._edges())
        for band in (bands.source, bands.reference):
            drawing.draw_row(p, band, self.rows, self._row)

    def _edges(self) -> list[tuple[int, int]]:
        assert self._linked is not None
        edges = {}
        for one in self._linked.carried(self._segments):
            edges[one.reference.start] = one.source.start
            edges[one.reference.end] = one.source.end
        return [(own, other) for other, own in edges.items()]

    def _draw_lanes(self, p: QPainter, _area: QRectF) -> None:
        if self._linked is None:
            return
        bands = self.bands
        shown = [*self._segments] if self._draft is None else [*self._segments, self._draft]
        spans = [(one.name, one.start, one.end) for one in shown]
        chosen = self._segment if self._draft is None else len(spans) - 1
        drawing.draw_segments(p, bands.lane, self.reference_scale, spans, chosen)
        answers = [one.source for one in self._linked.carried(shown)]
        over = [(one.name, one.start, one.end) for one in answers]
        drawing.draw_segments(p, bands.carried, self.source_scale, over, chosen)

    # -- mouse

    def _gesture_for(self, event: QMouseEvent) -> Gesture:
        gesture = super()._gesture_for(event)
        at = event.position()
        self._dragged = self.bands.side(at.y())
        if gesture is Gesture.SCRUB and self._dragged is Side.LANE and self.area.contains(at):
            self._moving = self._edge_at(at)
            return Gesture.SWEEP
        return Gesture.SCRUB if gesture is Gesture.SWEEP else gesture

    def _near_head(self, at: QPointF) -> bool:
        return False

    def _edge_at(self, at: QPointF) -> int | None:
        scale = self.reference_scale
        for number, one in enumerate(self._segments):
            for edge in (one.start, one.end):
                if abs(scale.x(edge - 0.5) - at.x()) <= _EDGE:
                    return number
        return None

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Draw a segment, or go on with any other gesture."""
        super().mouseMoveEvent(event)
        if self._gesture is Gesture.SWEEP and self._linked is not None:
            self._draft = self._swept_segment(event.position())
            self._lanes.refresh()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Leave a segment behind, choose one, or go to a frame."""
        sweeping, draft = self._gesture is Gesture.SWEEP, self._draft
        self._draft = None
        self._gesture = Gesture.NONE if sweeping else self._gesture
        super().mouseReleaseEvent(event)
        if not sweeping:
            return
        self._lanes.refresh()
        if draft is None:
            self.segment_chosen.emit(self.segment_at(event.position()))
        elif self._moving is not None:
            self.segment_moved.emit(self._moving, draft.start, draft.end)
        else:
            self.segment_drawn.emit(draft.start, draft.end)

    def _swept_segment(self, at: QPointF) -> Segment | None:
        if abs(at.x() - self._pressed.x()) <= _EDGE and self._draft is None:
            return None
        here, there = self.reference_frame_at(at.x()), self.reference_frame_at(self._pressed.x())
        if self._moving is None:
            return Segment("new", min(here, there), max(here, there) + 1)
        old = self._segments[self._moving]
        if abs(there - old.start) <= abs(there - old.end):
            return Segment(old.name, min(here, old.end - 1), old.end)
        return Segment(old.name, old.start, max(here, old.start + 1))

    def _scrub(self, at: QPointF) -> None:
        x = min(max(at.x(), self.area.left()), self.area.right())
        if self._dragged in (Side.REFERENCE, Side.LANE):
            self.reference_scrubbed.emit(self.reference_frame_at(x))
        else:
            self.scrubbed.emit(self.source_frame_at(x))
