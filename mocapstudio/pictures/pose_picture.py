"""The body at one frame, before and after, as a picture."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

import numpy as np

from mocapstudio.motion.take import Take
from mocapstudio.pictures.opengl import opengl_problem
from mocapstudio.pictures.pose_scene import Figure3D, View, render, view_of
from mocapstudio.pictures.stick import stick
from mocapstudio.pictures.style import DARK, Palette, Picture, new_figure, rgb, to_png

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_HEAD = 56
_GHOST = 0.22


def pose_picture(
    before: Take,
    after: Take | None,
    frame: int,
    joints: Collection[str] = (),
    *,
    title: str = "",
    size: tuple[int, int] = (1280, 700),
    palette: Palette = DARK,
) -> Picture:
    """Draw a take at a frame, and beside it the same frame after a change.

    The joints in question are emphasised; each side shows the other as a ghost.

    Parameters
    ----------
    before, after
        The take as it is, and with the proposal; None shows one side only.
    frame
        0-based frame of both.
    joints
        Rows to emphasise.
    size
        Pixels, width and height.

    Returns
    -------
    The picture; without OpenGL it is a flat drawing and its note says so.
    """
    problem = opengl_problem()
    old = Figure3D(stick(before, frame, joints), palette.wrong)
    sides = [("before", palette.wrong, [old])]
    if after is not None:
        new = Figure3D(stick(after, frame, joints), palette.proposal)
        ghost_of_new = Figure3D(new.stick, palette.proposal, _GHOST)
        ghost_of_old = Figure3D(old.stick, palette.wrong, _GHOST)
        sides = [
            ("before", palette.wrong, [old, ghost_of_new]),
            ("after", palette.proposal, [new, ghost_of_old]),
        ]
    view = view_of([body.stick for body in sides[-1][2][::-1]])
    width, height = size
    figure = new_figure(size, palette)
    pane = (width // len(sides), height - _HEAD)
    for i, (name, colour, bodies) in enumerate(sides):
        axes = figure.add_axes((i * pane[0] / width, 0, pane[0] / width, pane[1] / height))
        if problem is None:
            axes.imshow(render(bodies, view, pane, palette), aspect="auto")
        else:
            _flat(axes, bodies, view, pane, palette)
        axes.set_axis_off()
        axes.text(0.026, 0.985, name, color=colour, fontsize=13, transform=axes.transAxes, va="top")
    note = None if problem is None else f"{problem}: poses are drawn flat, not rendered"
    line = 1 - 0.62 * _HEAD / height
    figure.text(16 / width, line, title or before.name, color=palette.text, fontsize=13)
    where = f"frame {frame} · {before.seconds(frame):.2f} s"
    figure.text(1 - 16 / width, line, where, color=palette.muted, fontsize=11, ha="right")
    return Picture(to_png(figure), note)


def _flat(
    axes: Axes, bodies: list[Figure3D], view: View, pane: tuple[int, int], palette: Palette
) -> None:
    """Draw bodies as lines, seen along the same direction and at the same scale."""
    toward = view.toward
    right = np.cross([0.0, 1.0, 0.0], toward)
    right /= np.linalg.norm(right)
    up = np.cross(toward, right)
    half = 0.5 * view.extent
    axes.set_ylim(-half, half)
    axes.set_xlim(-half * pane[0] / pane[1], half * pane[0] / pane[1])
    field = rgb(palette.field)
    axes.fill_between(axes.get_xlim(), -half, half, color=field, zorder=0)
    for body in reversed(bodies):
        seen = (body.stick.points - view.centre) @ np.stack([right, up], axis=1)
        for (a, b), marked in zip(body.stick.bones, body.stick.marked_bones, strict=True):
            colour = rgb(body.accent if marked else palette.body)
            axes.plot(
                seen[[a, b], 0],
                seen[[a, b], 1],
                color=tuple(field + (colour - field) * body.opacity),
                linewidth=6 if marked else 4,
                solid_capstyle="round",
            )
