"""The shell command: one file a command, thin."""

from __future__ import annotations


def main() -> None:
    """Run `mocapstudio` with the arguments of the shell and leave with its exit code."""
    # numba reads the place of its cache once, when it is first imported.
    from mocapstudio.cli.kernel_cache import place_kernel_cache

    place_kernel_cache()
    from mocapstudio.cli.app import run

    raise SystemExit(run())
