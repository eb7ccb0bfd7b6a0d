"""The reference's timeline with two heads: where the performer is, and where she would be."""

from __future__ import annotations

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFontMetricsF, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QWidget

from mocapstudio.gui import theme as themes
from mocapstudio.gui.compare import colours as kinds
from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.live_bridge import LiveBridge
from mocapstudio.gui.compare.live_plot import LEFT, RIGHT
from mocapstudio.gui.compare.live_words import timing_kind
from mocapstudio.gui.plots import colours
from mocapstudio.gui.plots.axes import small_font
from mocapstudio.gui.plots.ticks import time_ticks

_TOP, _LANE, _TRACK = 26.0, 26.0, 10.0
_CENTRE = int(Qt.AlignmentFlag.AlignCenter)
_LEFT = int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)


class LiveTimeline(QWidget):
    """Segments of the reference, and how far the performer has come.

    The solid head is where she is; the dashed one where she would be at the reference's own
    tempo since the action began. What lies between has the colour of early or late.

    Parameters
    ----------
    bridge, live
        Where state comes from.
    """

    def __init__(self, bridge: CompareBridge, live: LiveBridge) -> None:
        super().__init__()
        self.setObjectName("live-timeline")
        self.setMinimumHeight(96)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.setToolTip(
            "The reference's timeline. Solid head: where the performer is. Dashed head: where she\n"
            "would be, had she kept the reference's tempo since the action began."
        )
        self._bridge, self._live = bridge, live
        self._drawn: tuple[object, ...] = ()
        live.changed.connect(lambda _old, _new: self._follow())
        bridge.changed.connect(lambda _old, _new: self._follow())

    @property
    def heads(self) -> tuple[float, float] | None:
        """Seconds of the reference: where the performer is, and where she would be."""
        reference, step = self._bridge.state.reference, self._live.shown.step
        if reference is None or step is None:
            return None
        at = reference.seconds(step.reference_frame)
        punctual = at if step.misalignment is None else at - step.misalignment
        return at, min(max(punctual, 0.0), reference.duration)

    @property
    def _wide(self) -> float:
        return max(self.width() - LEFT - RIGHT, 1.0)

    def x_of(self, seconds: float) -> float:
        """Pixel of a time of the reference."""
        reference = self._bridge.state.reference
        whole = 1.0 if reference is None else reference.duration
        return LEFT + seconds / whole * self._wide

    def _follow(self) -> None:
        state = self._bridge.state
        drawn = (self.heads, state.segments, state.reference)
        if drawn != self._drawn:
            self._drawn = drawn
            self.update()

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw lane, track, heads and marks."""
        look, state = themes.current(), self._bridge.state
        p = QPainter(self)
        p.setRenderHint(QPainter.RenderHint.Antialiasing)
        p.fillRect(self.rect(), QColor(look.panel))
        if state.reference is not None:
            p.setFont(small_font(11))
            p.setPen(QColor(look.muted))
            name = QFontMetricsF(p.font()).elidedText(
                f"Reference · {state.reference.name}", Qt.TextElideMode.ElideMiddle,
                self._wide,
            )  # fmt: skip
            p.drawText(QRectF(LEFT, 4, self._wide, 16), _LEFT, name)
            self._draw_segments(p)
            self._draw_track(p)
            self._draw_ticks(p)
            self._draw_heads(p)
        p.end()

    def _draw_segments(self, p: QPainter) -> None:
        look, state, step = themes.current(), self._bridge.state, self._live.shown.step
        assert state.reference is not None
        lane = QRectF(LEFT, _TOP, self._wide, _LANE)
        p.setPen(Qt.PenStyle.NoPen)
        p.setBrush(QColor(look.field))
        p.drawRoundedRect(lane, 4, 4)
        p.setFont(small_font(11))
        metrics = QFontMetricsF(p.font())
        for one in state.segments:
            left = self.x_of(state.reference.seconds(one.start))
            right = self.x_of(state.reference.seconds(one.end))
            box = QRectF(left + 0.5, _TOP, max(right - left - 1, 2), _LANE)
            here = step is not None and one.start <= step.reference_frame < one.end
            p.setPen(Qt.PenStyle.NoPen)
            ground = colours.mixed(look.field, look.border, 0.55)
            p.setBrush(QColor(look.selection) if here else ground)
            p.drawRoundedRect(box, 4, 4)
            p.setPen(QColor(look.text if here else look.muted))
            # Half a name says less than none: the present one stands in full beside.
            if metrics.horizontalAdvance(one.name) <= box.width() - 6:
                p.drawText(box, _CENTRE, one.name)
        if not state.segments:
            p.setPen(QColor(look.faint))
            p.drawText(lane, _CENTRE, "no segments: suggest, load or draw some to see their names")

    def _draw_track(self, p: QPainter) -> None:
        look, heads = themes.current(), self.heads
        top = _TOP + _LANE + 6
        track = QRectF(LEFT, top, self._wide, _TRACK)
        p.setPen(Qt.PenStyle.NoPen)
        p.setBrush(QColor(look.field))
        p.drawRoundedRect(track, 3, 3)
        if heads is None:
            return
        at, punctual = (self.x_of(one) for one in heads)
        done = min(at, punctual)
        p.setBrush(QColor(look.faint))
        p.drawRoundedRect(QRectF(LEFT, top, max(done - LEFT, 0), _TRACK), 3, 3)
        p.setBrush(self._colour())
        p.drawRect(QRectF(done, top, abs(at - punctual), _TRACK))

    def _colour(self) -> QColor:
        step = self._live.shown.step
        ahead = None if step is None else step.misalignment
        kind = timing_kind(ahead, self._bridge.state.parameters.tolerance)
        return kinds.timing(themes.current(), kind)

    def _draw_ticks(self, p: QPainter) -> None:
        look, reference = themes.current(), self._bridge.state.reference
        assert reference is not None
        top = _TOP + _LANE + _TRACK + 9
        p.setFont(small_font(10))
        p.setPen(QColor(look.faint))
        most = max(2, int(self.width() / 90))
        for tick in time_ticks(0.0, reference.duration, 1.0, most):
            x = self.x_of(tick.frame)
            p.drawLine(QPointF(x, top), QPointF(x, top + (4 if tick.label else 2)))
            if tick.label:
                left = min(max(x - 30, 0.0), self.width() - 60.0)
                p.drawText(QRectF(left, top + 4, 60, 13), _CENTRE, tick.label)

    def _draw_heads(self, p: QPainter) -> None:
        look, heads = themes.current(), self.heads
        if heads is None:
            return
        at, punctual = (self.x_of(one) for one in heads)
        bottom = _TOP + _LANE + 6 + _TRACK + 3
        p.setPen(QPen(colours.faded(look.playhead, 0.65), 1.4, Qt.PenStyle.DashLine))
        p.drawLine(QPointF(punctual, _TOP - 2), QPointF(punctual, bottom))
        p.setPen(QPen(QColor(look.playhead), 2))
        p.drawLine(QPointF(at, _TOP - 3), QPointF(at, bottom))
        p.setPen(Qt.PenStyle.NoPen)
        p.setBrush(QColor(look.playhead))
        tip = QPointF(at, _TOP + 2)
        p.drawPolygon(QPolygonF([tip, tip + QPointF(-5, -8), tip + QPointF(5, -8)]))
