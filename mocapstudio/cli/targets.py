"""Where written takes go: one file, or a folder; never onto an input."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from mocapstudio.cli.output import check_writable
from mocapstudio.formats.registry import Recording, written_suffix
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.markers import MarkerTake


class Targets:
    """Names the output file of each take.

    Parameters
    ----------
    out
        A file, or a folder where there are several takes or it has no ending.
    inputs
        Files that must not be replaced.

    Raises
    ------
    FileError
        If `out` cannot be written.
    """

    def __init__(self, out: Path, takes: Sequence[Path], inputs: Iterable[Path]) -> None:
        self.out = out
        self.folder = len(takes) > 1 or out.is_dir() or not out.suffix
        self._inputs = {path.resolve() for path in inputs}
        self._taken: set[Path] = set()
        if self.folder and out.exists() and not out.is_dir():
            raise FileError(out, "is a file; several takes need a folder")
        if not self.folder:
            check_writable(out)
            self._refuse_input(out)

    def of(self, path: Path, take: Recording, *, alone: bool) -> Path:
        """Return where a take goes; the folder is made.

        In a folder it keeps its ending, but for formats that are only read.

        Parameters
        ----------
        path
            The file it was read from.
        alone
            True where that file holds this take only.

        Raises
        ------
        FileError
            If that is an input, or another take was written there.
        """
        target = self.out
        if self.folder:
            try:
                self.out.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                raise FileError(self.out, f"cannot be made: {error.strerror}") from error
            # Markers solved to joints have no file of joints behind them.
            markers = isinstance(take, MarkerTake)
            suffix = written_suffix(path.suffix if take.source else "", markers=markers)
            target = self.out / f"{path.stem if alone else take.name}{suffix}"
        elif not alone:
            target = self.out.with_name(f"{self.out.stem}-{take.name}{self.out.suffix}")
        self._refuse_input(target)
        if target in self._taken:
            raise FileError(path, f"would replace what another take was written to, {target}")
        self._taken.add(target)
        return target

    def _refuse_input(self, target: Path) -> None:
        if target.resolve() in self._inputs:
            raise FileError(target, "is an input and is not overwritten")
