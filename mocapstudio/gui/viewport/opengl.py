"""Whether there is an OpenGL that the 3-D view can draw with."""

from __future__ import annotations

from functools import cache

from PySide6.QtGui import QGuiApplication, QOffscreenSurface, QOpenGLContext, QSurfaceFormat

_NEEDED = (3, 2)
# These platforms of Qt never show what OpenGL draws, even where they offer a context.
_BLIND = {"offscreen", "minimal", "vnc", "linuxfb"}


@cache
def opengl_problem() -> str | None:
    """Say why the 3-D view cannot draw, or return None where it can. Needs a QGuiApplication."""
    platform = QGuiApplication.platformName()
    if platform in _BLIND:
        return f"the Qt platform “{platform}” does not show OpenGL"
    wanted = QSurfaceFormat()
    wanted.setRenderableType(QSurfaceFormat.RenderableType.OpenGL)
    wanted.setProfile(QSurfaceFormat.OpenGLContextProfile.CoreProfile)
    wanted.setVersion(*_NEEDED)
    context = QOpenGLContext()
    context.setFormat(wanted)
    if not context.create():
        return "no OpenGL context could be created"
    surface = QOffscreenSurface()
    surface.setFormat(context.format())
    surface.create()
    if not context.makeCurrent(surface):
        return "the OpenGL context cannot be used"
    major, minor = context.format().majorVersion(), context.format().minorVersion()
    context.doneCurrent()
    if (major, minor) < _NEEDED:
        return f"version {_NEEDED[0]}.{_NEEDED[1]} is needed, this is {major}.{minor}"
    return None
