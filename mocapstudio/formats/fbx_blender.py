"""Blender as the program that reads and writes FBX for us: where it is, and a job done by it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

from mocapstudio.motion.errors import MocapError
from mocapstudio.resource_files import resource

VARIABLE = "MOCAPSTUDIO_BLENDER"
"""Environment variable that names Blender's program, where it is not found by itself."""

HOW_TO_GET_IT = (
    "install it from blender.org (apt-get install blender, brew install --cask blender),"
    f" or name its program in {VARIABLE}"
)

_PLACES = (
    "/Applications/Blender.app/Contents/MacOS/Blender",
    "C:/Program Files/Blender Foundation/*/blender.exe",
    "/snap/bin/blender",
)
_HEADLESS = ("--background", "--factory-startup", "--python-exit-code", "1", "--python")
_SECONDS = 1800


def find_blender() -> tuple[str, ...] | None:
    """Return the command that runs Blender or its Python module, or None where there is neither.

    Looked for in this order: the variable MOCAPSTUDIO_BLENDER, the search path, the usual places,
    the Python module bpy.

    Raises
    ------
    MocapError
        If the variable names no file.
    """
    named = os.environ.get(VARIABLE)
    if named:
        if not Path(named).is_file():
            raise MocapError(f"{VARIABLE} names {named}, which is no file")
        return (named,)
    found = shutil.which("blender")
    if found:
        return (found,)
    for place in map(Path, _PLACES):
        installed = sorted(Path(place.anchor).glob(str(place.relative_to(place.anchor))))
        if installed:
            # The newest version sorts last.
            return (str(installed[-1]),)
    return (sys.executable,) if find_spec("bpy") is not None else None


def run_blender(job: str, *arguments: str | Path) -> None:
    """Let Blender do one job of ``resources/blender/exchange.py``.

    Raises
    ------
    MocapError
        If there is no Blender, or it fails.
    """
    found = find_blender()
    if found is None:
        raise MocapError(f"FBX goes through Blender, which was not found: {HOW_TO_GET_IT}")
    headless = () if found == (sys.executable,) else _HEADLESS
    script = resource("blender", "exchange.py")
    command = [*found, *headless, str(script), "--", job, *map(str, arguments)]
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, errors="replace", timeout=_SECONDS, check=False
        )
    except subprocess.TimeoutExpired:
        raise MocapError(f"Blender has not answered for {_SECONDS} s") from None
    except OSError as bad:
        raise MocapError(f"Blender cannot be run: {bad}") from bad
    if done.returncode != 0:
        said = (done.stderr.strip() or done.stdout.strip() or "it said nothing").splitlines()[-1]
        raise MocapError(f"Blender failed: {said.strip()[:200]}")
