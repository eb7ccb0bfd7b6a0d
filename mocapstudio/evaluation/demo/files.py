"""The demo as files, as if it had come from a studio."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from mocapstudio import formats
from mocapstudio.evaluation.demo.errors import demo_with_errors
from mocapstudio.evaluation.demo.take import demo_context
from mocapstudio.evaluation.truth import Truth
from mocapstudio.formats.atomic import write_whole
from mocapstudio.motion.errors import FileError


@dataclass(frozen=True)
class DemoFiles:
    """What `write_demo` wrote.

    Parameters
    ----------
    take
        The take with errors.
    context
        Clean takes of the same performer.
    truth
        JSON list of the errors, as `Truth.to_json` gives them.
    truths
        The same errors.
    """

    take: Path
    context: tuple[Path, ...]
    truth: Path
    truths: tuple[Truth, ...]


def write_demo(folder: Path) -> DemoFiles:
    """Write the demo take with errors, its context and the truth into a folder, which is made.

    Raises
    ------
    FileError
        If the folder cannot be made, or a file not be written.
    """
    others = folder / "context"
    try:
        others.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(others, f"cannot be made: {error.strerror}") from error
    take, truths = demo_with_errors()
    path = folder / f"{take.name}.bvh"
    formats.write(take, path)
    context = []
    for one in demo_context():
        context.append(others / f"{one.name}.bvh")
        formats.write(one, context[-1])
    truth = folder / "truth.json"
    text = json.dumps([one.to_json() for one in truths], indent=1)
    write_whole(truth, [text.encode(), b"\n"])
    return DemoFiles(path, tuple(context), truth, truths)
