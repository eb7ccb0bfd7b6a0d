"""How the motion-texture is painted under the map, and the key to its colours."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

from mocapstudio.gui import theme as themes
from mocapstudio.gui.plots.axes import small_font
from mocapstudio.gui.plots.map_drawing import Frame, draw_limbs
from mocapstudio.gui.plots.pooling import block_length
from mocapstudio.gui.plots.texture_colours import SOFT, TexturePicture, rgb
from mocapstudio.gui.plots.time_plot import RIGHT_GUTTER

_LINE = 17.0
_STRIP = 30


def draw_texture(
    p: QPainter, at: Frame, picture: TexturePicture, start: float, frames_each: float
) -> None:
    """Draw the colours, each limb in one piece.

    Parameters
    ----------
    start, frames_each
        The take's frame of the texture's first one, and frames of the take for each.
    """
    per = at.per_frame * frames_each
    step = block_length(1.0 / per)
    blocks = picture.blocks(step)
    first = max(int(((at.time.start - start) / frames_each + 0.5) // step), 0)
    last = min(int(((at.time.end - start) / frames_each + 0.5) // step) + 1, blocks.shape[1])
    if last <= first or not at.rows.names:
        return
    pixels = np.ascontiguousarray(blocks[:, first:last])
    left = at.x(start + (first * step - 0.5) * frames_each)
    shown = (min(last * step, picture.frames) - first * step) * per
    # The last block of a texture may be shorter than the others.
    full = (last - first) * step * per
    draw_limbs(p, at, pixels, left, shown, full)


class TextureKey(QWidget):
    """Which colour is a turn about which axis, from -90 to 90 degrees."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setFixedWidth(RIGHT_GUTTER)
        self.setToolTip(
            "Rotation of each joint from its own mean in this take, as a rotation vector in the"
            " parent's frame: about x red, y green, z blue, from −90° to 90°; grey: no turn."
            f" {SOFT:.0f}° take a colour three quarters of the way.\n"
            "24 frames a second; of the hips without the heading, as the analysis compares it."
        )

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw a strip for each axis."""
        look = themes.current()
        p = QPainter(self)
        p.fillRect(self.rect(), QColor(look.panel))
        p.setFont(small_font(10))
        top = 24.0
        turns = np.linspace(-90.0, 90.0, _STRIP, dtype=np.float32)
        for axis, name in enumerate("xyz"):
            vectors = np.zeros((_STRIP, 3), np.float32)
            vectors[:, axis] = turns
            for i, (red, green, blue) in enumerate(rgb(vectors).tolist()):
                colour = QColor.fromRgbF(red, green, blue)
                p.fillRect(QRectF(12 + i, top, 1, 10), colour)
            p.setPen(QColor(look.muted))
            room = QRectF(12 + _STRIP + 6, top - 4, 30, 18)
            p.drawText(room, int(Qt.AlignmentFlag.AlignVCenter), name)
            top += _LINE
        p.setPen(QColor(look.faint))
        p.drawText(QRectF(6, top - 3, RIGHT_GUTTER - 8, 14), 0, "−90…90°")
        p.end()
