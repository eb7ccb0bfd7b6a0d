"""Whether this machine can render at all, found out without risk to this process."""

from __future__ import annotations

import subprocess
import sys
from functools import cache

_SECONDS = 60
# VTK crashes the process where it finds no OpenGL, so it is tried in another one.
_TRIAL = """
import pyvista
plotter = pyvista.Plotter(off_screen=True, window_size=(32, 32))
plotter.set_background("white")
assert plotter.screenshot(return_img=True).min() > 200
"""


@cache
def opengl_problem() -> str | None:
    """Say why nothing can be rendered off screen, or return None where it can."""
    try:
        trial = subprocess.run(
            [sys.executable, "-c", _TRIAL], capture_output=True, timeout=_SECONDS, check=False
        )
    except (subprocess.TimeoutExpired, OSError) as error:
        return f"OpenGL could not be tried ({type(error).__name__})"
    return None if trial.returncode == 0 else "no OpenGL was found on this machine"
