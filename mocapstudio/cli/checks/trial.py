"""Trials in a process of their own."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass

SECONDS = 60


@dataclass(frozen=True)
class Trial:
    """How a trial ended: whether it came to its end, and the last line that it said."""

    passed: bool
    said: str


def attempt(script: str, environment: Mapping[str, str] | None = None) -> Trial:
    """Run a Python script in a new interpreter.

    Parameters
    ----------
    script
        Its text; the last line that it prints is what it has to say.
    environment
        Variables to set over those of this process.
    """
    try:
        ended = subprocess.run(
            [sys.executable, "-c", script],
            env={**os.environ, **(environment or {})},
            capture_output=True,
            text=True,
            timeout=SECONDS,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return Trial(False, f"no answer within {SECONDS} s")
    if ended.returncode == 0:
        return Trial(True, _last_line(ended.stdout))
    said = _last_line(ended.stderr) or f"ended with code {ended.returncode}"
    return Trial(False, said)


def _last_line(text: str) -> str:
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return lines[-1] if lines else ""
