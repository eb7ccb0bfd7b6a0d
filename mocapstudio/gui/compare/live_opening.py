"""Opens the desk on a live performance: a reference, and a take or standard input beside it."""

from __future__ import annotations

import sys
from collections.abc import Generator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from mocapstudio import formats
from mocapstudio.comparison.labels import Labels
from mocapstudio.comparison.online_stream import STANDARD_INPUT
from mocapstudio.comparison.weights import JointWeights
from mocapstudio.gui.jobs import Lines
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.joint_map import rename_recording
from mocapstudio.motion.progress import Progress
from mocapstudio.review.comparing import Recording
from mocapstudio.review.live_feeds import StreamFeed

if TYPE_CHECKING:
    from mocapstudio.gui.main_window import MainWindow
    from mocapstudio.gui.workspaces.compare import CompareWorkspace

_DOING = "The live performance could not be opened"


@dataclass(frozen=True)
class LiveRequest:
    """A live performance that is asked for.

    Parameters
    ----------
    reference
        File of what is aligned with.
    stream
        File of the take that is played, or None for JSON lines from standard input.
    options
        How the files are read; its rate is that of the stream, too.
    names
        Joints of who performs, and what they are called in the reference.
    weights, weights_file
        Joint weights, and the name of their file.
    labels, labels_file
        Segments of the reference, one take or several.
    wait
        Whether the action's beginning is waited for.
    descriptor
        What lines are read from in place of standard input.
    """

    reference: Path
    stream: Path | None = None
    options: formats.ReadOptions | None = None
    names: Mapping[str, str] = field(default_factory=dict)
    weights: JointWeights | None = None
    weights_file: str = ""
    labels: Labels | None = None
    labels_file: Path | None = None
    wait: bool = True
    descriptor: int | None = None


def open_live(window: MainWindow, request: LiveRequest) -> None:
    """Bring the Compare workspace to the front and let the performance begin."""
    from mocapstudio.gui.workspaces.compare import CompareWorkspace

    window.switching.show("compare")
    workspace = window.switching.front
    assert isinstance(workspace, CompareWorkspace)
    window.jobs.start(
        f"Reading {request.reference.name}",
        _reading(request),
        lambda takes: _begin(workspace, request, *takes),
        lambda error: window.messages.complain(error, _DOING),
    )


def _reading(
    request: LiveRequest,
) -> Generator[Progress, None, tuple[Recording, Recording | None]]:
    yield Progress(0.0, f"reading {request.reference.name}")
    reference = formats.read_any(request.reference, request.options)[0][0]
    if request.stream is None:
        return reference, None
    yield Progress(0.5, f"reading {request.stream.name}")
    source = formats.read_any(request.stream, request.options)[0][0]
    return reference, rename_recording(source, request.names) if request.names else source


def _begin(
    workspace: CompareWorkspace,
    request: LiveRequest,
    reference: Recording,
    source: Recording | None,
) -> None:
    sitting, mode, live = workspace.bridge.sitting, workspace.live_mode, workspace.live
    live.set(
        wait=request.wait,
        weights=request.weights,
        weights_file=request.weights_file,
        weights_shown=request.weights is not None,
    )
    sitting.set_reference(reference)
    if request.labels is not None and request.labels_file is not None:
        segments = request.labels.at_rate(reference.rate).segments
        sitting.set_segments(segments, f"Load {request.labels_file.name}")
        sitting.mark_saved(request.labels_file)
    if source is not None:
        sitting.add_sources([source])
        mode.begin()
        return
    lines = Lines(_standard_input() if request.descriptor is None else request.descriptor)
    rate = None if request.options is None else request.options.fps
    feed = StreamFeed(lines.take, lambda: lines.ended, request.names)
    mode.listen(feed, str(STANDARD_INPUT), None if rate is None else float(rate), lines.close)


def _standard_input() -> int:
    if sys.stdin is None or sys.stdin.closed:
        raise FileError(STANDARD_INPUT, "is closed")
    return sys.stdin.fileno()
