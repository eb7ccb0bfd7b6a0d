"""Blender, which reads and writes what other programs want."""

from __future__ import annotations

import shutil
import subprocess

from mocapstudio.cli.checks.finding import Finding, State


def check_blender() -> list[Finding]:
    """Look for Blender; nothing but the exchange with it needs it."""
    path = shutil.which("blender")
    if path is None:
        found = "not found; only exchange through it is not to be had"
        return [Finding("Blender", State.NOTE, found, "install it if you need FBX")]
    try:
        said = subprocess.run(
            [path, "--version"], capture_output=True, text=True, timeout=60, check=False
        ).stdout
    except (OSError, subprocess.TimeoutExpired) as error:
        return [Finding("Blender", State.NOTE, f"{path} does not answer: {error}")]
    return [Finding("Blender", State.OK, f"{said.splitlines()[0] if said else '?'}, {path}")]
