"""Blender, which reads and writes what other programs want."""

from __future__ import annotations

import subprocess
import sys

from mocapstudio.cli.checks.finding import Finding, State


def check_blender() -> list[Finding]:
    """Look for Blender; nothing but FBX needs it."""
    from mocapstudio.formats.fbx_blender import HOW_TO_GET_IT, find_blender
    from mocapstudio.motion.errors import MocapError

    try:
        command = find_blender()
    except MocapError as error:
        return [Finding("Blender", State.NOTE, str(error), HOW_TO_GET_IT)]
    if command is None:
        found = "not found; FBX can neither be read nor written"
        return [Finding("Blender", State.NOTE, found, HOW_TO_GET_IT)]
    if command == (sys.executable,):
        return [Finding("Blender", State.OK, "as the Python module bpy")]
    try:
        said = subprocess.run(
            [*command, "--version"], capture_output=True, text=True, timeout=60, check=False
        ).stdout
    except (OSError, subprocess.TimeoutExpired) as error:
        return [Finding("Blender", State.NOTE, f"{command[0]} does not answer: {error}")]
    version = said.splitlines()[0] if said else "of unknown version"
    return [Finding("Blender", State.OK, f"{version}, {command[0]}")]
