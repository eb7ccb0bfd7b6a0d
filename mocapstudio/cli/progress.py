"""Progress on standard error, where that is a terminal."""

from __future__ import annotations

import sys
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from typing import TypeVar

from mocapstudio.motion.progress import Progress
from mocapstudio.motion.progress import run as drive

Result = TypeVar("Result")


def run(work: Generator[Progress, None, Result], title: str) -> Result:
    """Drive long work to its result while a bar named `title` shows how far it is."""
    with _bar(title) as show:
        return drive(work, show)


@contextmanager
def _bar(title: str) -> Iterator[Callable[[Progress], None] | None]:
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, TextColumn, TimeRemainingColumn
    from rich.progress import Progress as Bar

    columns = (
        TextColumn("{task.fields[title]}", markup=False),
        BarColumn(),
        TextColumn("{task.description}", markup=False),
        TimeRemainingColumn(),
    )
    with Bar(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=1.0, title=title)
        yield lambda at: bar.update(task, completed=at.done, description=at.what)
