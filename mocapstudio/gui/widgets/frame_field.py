"""The field that shows the current frame, by the file's own numbers."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal

from mocapstudio.formats import Recording
from mocapstudio.gui import wording
from mocapstudio.gui.widgets.fields import NumberField


class FrameField(NumberField):
    """The file's own frame number; one can be typed.

    Parameters
    ----------
    name
        Object name.
    """

    wanted = Signal(int)
    """Emitted with the 0-based frame that was typed or stepped to."""

    def __init__(self, name: str) -> None:
        super().__init__()
        self.setObjectName(name)
        self.setToolTip("Frame, by the file's own numbers; type one and press Enter")
        self.setKeyboardTracking(False)
        self.setFixedWidth(76)
        self.setAlignment(Qt.AlignmentFlag.AlignRight)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self._take: Recording | None = None
        self.editingFinished.connect(self._go)

    def show_frame(self, take: Recording | None, frame: int) -> None:
        """Show a frame of a take."""
        if take is not self._take:
            self._take = take
            first = 0 if take is None else take.first_frame
            self.setRange(first, first if take is None else first + take.frames - 1)
        if take is not None:
            self.setValue(wording.number(take, frame))

    def stepBy(self, steps: int) -> None:
        """Step by arrow or wheel."""
        super().stepBy(steps)
        self._go()

    def _go(self) -> None:
        if self._take is not None:
            self.wanted.emit(self.value() - self._take.first_frame)
