"""Early or late, in large figures, and what else is known about the performer now."""

from __future__ import annotations

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

from mocapstudio.comparison.online_begin import Following
from mocapstudio.gui import theme as themes
from mocapstudio.gui.compare import colours as kinds
from mocapstudio.gui.compare import live_words as words
from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.live_bridge import LiveBridge, LiveShown, Phase
from mocapstudio.gui.plots.axes import small_font

_LEFT = int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
_WRAPPED = int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop | Qt.TextFlag.TextWordWrap)
_MARGIN = 14.0
_TIP = (
    "Seconds the performer is ahead of the reference since the action began (early, +) or\n"
    "behind it (late, −). Cost: mean distance of poses along the path so far; pose: of this one."
)


class LiveReadout(QWidget):
    """The figures of live mode.

    Parameters
    ----------
    bridge, live
        Where state comes from.
    """

    def __init__(self, bridge: CompareBridge, live: LiveBridge) -> None:
        super().__init__()
        self.setObjectName("live-readout")
        self.setToolTip(_TIP)
        # Else whatever lies behind is painted at every frame, which costs ten times as much.
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self._bridge, self._live = bridge, live
        self._told: tuple[str, ...] = ()
        live.changed.connect(lambda _old, _new: self.follow())
        bridge.changed.connect(lambda _old, _new: self.follow())

    def follow(self) -> None:
        """Paint anew where something else is to be said."""
        told = self.told
        if told != self._told:
            self._told = told
            self.update()

    @property
    def told(self) -> tuple[str, ...]:
        """Everything that stands here: phase, seconds, word, segment, then the smaller lines."""
        shown, state = self._live.shown, self._bridge.state
        seconds, word, _ = words.ahead_words(shown, state.parameters.tolerance)
        lines = (
            words.segment_words(shown, state),
            self._where(shown),
            words.action_words(shown),
            words.cost_words(shown),
            words.note_words(shown),
            words.fault_words(shown),
        )
        return words.phase_words(shown), seconds, word, *lines

    def _where(self, shown: LiveShown) -> str:
        reference = self._bridge.state.reference
        if shown.step is None or reference is None:
            return ""
        frame = shown.step.reference_frame
        return f"reference {reference.seconds(frame):.2f} s · frame {frame + reference.first_frame}"

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw the words."""
        look, shown = themes.current(), self._live.shown
        p = QPainter(self)
        p.setRenderHint(QPainter.RenderHint.Antialiasing)
        p.fillRect(self.rect(), QColor(look.panel))
        phase, seconds, word, segment, *lines = self.told
        kind = words.ahead_words(shown, self._bridge.state.parameters.tolerance)[2]
        room = QRectF(_MARGIN, 10, self.width() - 2 * _MARGIN, 20)
        self._draw_phase(p, room, phase, shown)
        top = 36.0
        colour = kinds.timing(look, kind) if seconds else QColor(look.faint)
        p.setFont(_font(30, bold=True))
        p.setPen(colour)
        p.drawText(QRectF(_MARGIN, top, room.width(), 38), _LEFT, seconds or "– –")
        wide = QFontMetricsF(p.font()).horizontalAdvance(seconds or "– –")
        p.setFont(_font(15, bold=True))
        p.drawText(QRectF(_MARGIN + wide + 10, top + 4, room.width() - wide, 34), _LEFT, word)
        top += 44
        if self._bridge.state.segments:
            self._draw_segment(p, QRectF(_MARGIN, top, room.width(), 24), segment)
            top += 32
        p.setFont(small_font(12))
        for text in lines[:-1]:
            if text and top + 17 <= self.height():
                p.setPen(QColor(look.muted))
                elided = QFontMetricsF(p.font()).elidedText(
                    text, Qt.TextElideMode.ElideRight, room.width()
                )
                p.drawText(QRectF(_MARGIN, top, room.width(), 17), _LEFT, elided)
                top += 18
        if lines[-1]:
            p.setPen(QColor(look.rejected))
            place = QRectF(_MARGIN, top + 2, room.width(), max(self.height() - top - 4, 0))
            p.drawText(place, _WRAPPED, lines[-1])
        p.end()

    def _draw_phase(self, p: QPainter, room: QRectF, text: str, shown: LiveShown) -> None:
        look = themes.current()
        running = shown.phase is Phase.RUNNING
        following = shown.now is not None and shown.now.following is Following.FOLLOWING
        p.setPen(Qt.PenStyle.NoPen)
        p.setBrush(QColor(look.accepted if running and following else look.faint))
        p.drawEllipse(QRectF(room.left(), room.center().y() - 4, 8, 8))
        p.setFont(_font(12, bold=True))
        p.setPen(QColor(look.text))
        p.drawText(room.adjusted(16, 0, 0, 0), _LEFT, text)

    def _draw_segment(self, p: QPainter, room: QRectF, text: str) -> None:
        look = themes.current()
        p.setFont(_font(13, bold=True))
        metrics = QFontMetricsF(p.font())
        shown = metrics.elidedText(text, Qt.TextElideMode.ElideRight, room.width() - 20)
        if not shown:
            return
        pill = QRectF(room.left(), room.top(), metrics.horizontalAdvance(shown) + 20, 24)
        p.setPen(Qt.PenStyle.NoPen)
        p.setBrush(QColor(look.selection))
        p.drawRoundedRect(pill, 6, 6)
        p.setPen(QColor(look.text))
        p.drawText(pill.adjusted(10, 0, 0, 0), _LEFT, shown)


def _font(pixels: int, *, bold: bool = False) -> QFont:
    font = themes.numbers_font()
    font.setPixelSize(pixels)
    font.setBold(bold)
    return font
