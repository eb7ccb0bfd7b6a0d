"""`mocapstudio doctor`: can everything run here, and what has to be installed if not."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Annotated

import typer

from mocapstudio.cli import progress
from mocapstudio.cli.checks.blender import check_blender
from mocapstudio.cli.checks.display import check_display, check_opengl
from mocapstudio.cli.checks.finding import Finding, State
from mocapstudio.cli.checks.kernels import check_kernel_cache, warm
from mocapstudio.cli.checks.libraries import check_system_libraries, check_versions
from mocapstudio.cli.checks.none_count import check_none_count
from mocapstudio.cli.errors import DONE, FAULT
from mocapstudio.cli.output import STANDARD_OUTPUT, JsonPath, check_writable, write_json

CHECKS: tuple[Callable[[], list[Finding]], ...] = (
    check_versions,
    check_system_libraries,
    check_display,
    check_opengl,
    check_none_count,
    check_kernel_cache,
    check_blender,
)

_COLOURS = {State.OK: "green", State.NOTE: "yellow", State.FAILED: "red"}


def doctor(
    warm_kernels: Annotated[
        bool, typer.Option("--warm", help="Compile and keep all kernels, so that no start waits.")
    ] = False,
    json_path: JsonPath = None,
) -> None:
    """Check display, OpenGL, libraries and caches, and say what to install.

    Notes tell of what most users do without. Exits 1 if a part of the program cannot run here.
    """
    check_writable(json_path)
    warmed = [progress.run(warm(), "kernels")] if warm_kernels else []
    findings = [finding for check in CHECKS for finding in check()] + warmed
    if json_path != STANDARD_OUTPUT:
        _show(findings)
    write_json({"findings": [_as_json(finding) for finding in findings]}, json_path)
    failed = any(finding.state is State.FAILED for finding in findings)
    raise typer.Exit(FAULT if failed else DONE)


def _as_json(finding: Finding) -> dict[str, str]:
    return {
        "what": finding.what,
        "state": finding.state.value,
        "found": finding.found,
        "remedy": finding.remedy,
    }


def _show(findings: Sequence[Finding]) -> None:
    from rich.console import Console
    from rich.text import Text

    # No table: a command to copy must not be broken over the lines of a cell.
    console = Console(soft_wrap=True)
    for finding in findings:
        state = Text(f"{finding.state.value:8}", style=_COLOURS[finding.state])
        console.print(state + Text(f"{finding.what}: ", "bold") + Text(finding.found, ""))
        if finding.remedy:
            console.print(Text(f"{'':8}-> {finding.remedy}"))
