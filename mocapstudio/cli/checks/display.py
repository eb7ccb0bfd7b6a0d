"""The display and OpenGL."""

from __future__ import annotations

import os
import sys

from mocapstudio.cli.checks.finding import Finding, State
from mocapstudio.cli.checks.trial import attempt

_WINDOW = """
from PySide6.QtGui import QGuiApplication
application = QGuiApplication([])
screen = application.primaryScreen()
size, ratio = screen.size(), screen.devicePixelRatio()
print(f"{application.platformName()}, {size.width()}x{size.height()} at {ratio:g}")
"""

_PICTURE = """
import pyvista
plotter = pyvista.Plotter(off_screen=True, window_size=(64, 64))
plotter.set_background("black")
plotter.add_mesh(pyvista.Sphere(), color="white", lighting=False)
picture = plotter.screenshot(return_img=True)
window = plotter.render_window
lines = dict(line.split(":", 1) for line in window.ReportCapabilities().splitlines() if ":" in line)
assert picture[32, 32].min() > 200, "the picture stays empty"
assert picture[0, 0].max() < 50, "the picture has no background"
print(lines.get("OpenGL renderer string", type(window).__name__).strip())
"""


def has_display() -> bool:
    """Tell whether there is a screen to open a window on."""
    if not sys.platform.startswith("linux"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def check_display() -> list[Finding]:
    """Find out whether Qt can open a window."""
    if not has_display():
        remedy = "for the desk, a screen; or on a virtual one: xvfb-run -a mocapstudio"
        found = "no display; everything but the desk works"
        return [Finding("Display", State.NOTE, found, remedy)]
    trial = attempt(_WINDOW)
    if trial.passed:
        return [Finding("Display", State.OK, trial.said)]
    remedy = "check DISPLAY and QT_QPA_PLATFORM, and the lines on Qt's libraries"
    return [Finding("Display", State.FAILED, trial.said, remedy)]


def check_opengl() -> list[Finding]:
    """Find out whether a picture can be rendered off screen, by rendering one."""
    trial = attempt(_PICTURE)
    if trial.passed:
        return [Finding("OpenGL", State.OK, trial.said)]
    remedy = "a graphics driver; on Debian without one: apt-get install libgl1 libegl1"
    return [Finding("OpenGL", State.FAILED, trial.said, remedy)]
