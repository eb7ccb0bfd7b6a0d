"""Takes and contexts as the command line names them: files, folders, some of them bad."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from mocapstudio import formats
from mocapstudio.cli.errors import BAD_INPUT, DONE, complain, is_bad_input
from mocapstudio.cli.take_options import TakeOptions
from mocapstudio.motion.errors import CancelledError, FileError, MarkersOnlyError
from mocapstudio.motion.joint_map import read_joint_map, rename_joints
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.take import Take

_SHOWN_PROBLEMS = 3


@dataclass
class Workload:
    """Reads the takes of one command; a bad one is complained about and the rest goes on.

    Markers where joints are wanted are bad input in a file that was named, and left out among the
    takes of a folder.
    """

    options: TakeOptions
    failed: bool = False
    template: Path | None = None
    _read: dict[Path, list[Take]] = field(default_factory=dict)
    _body: Take | None = None
    _named: set[Path] = field(default_factory=set)
    _left_out: list[FileError] = field(default_factory=list)
    _reached: bool = False

    def finish(self) -> int:
        """Return what the command leaves with; complain where all that there was was left out."""
        if self._left_out and not self._reached:
            complain(self._left_out[0])
            self.failed = True
        return BAD_INPUT if self.failed else DONE

    @contextmanager
    def going_on(self) -> Iterator[None]:
        """Turn an error of one take into a complaint, so that the others are still processed."""
        try:
            yield
        except CancelledError:
            raise
        except MarkersOnlyError as error:
            if error.path.resolve() in self._named:
                complain(error)
                self.failed = True
            else:
                self._left_out.append(error)
                print(f"warning: {error.path}: -: left out: it {error.cause}", file=sys.stderr)
        except Exception as error:
            if not is_bad_input(error):
                raise
            complain(error)
            self.failed = True

    def files(self, paths: Sequence[Path]) -> list[Path]:
        """Return the files of takes, each once: files as named, folders searched recursively."""
        found: dict[Path, Path] = {}
        self._named |= {path.resolve() for path in paths if not path.is_dir()}
        for path in paths:
            with self.going_on():
                for file in formats.find_takes([path]):
                    found.setdefault(file.resolve(), file)
        return list(found.values())

    def read(self, path: Path) -> list[Take]:
        """Read the takes of a file; what had to be repaired in it is told on standard error.

        Raises
        ------
        FileError
            If the file cannot be read as takes.
        MarkersOnlyError
            Without a template, if it holds markers only.
        """
        known = self._read.get(path.resolve())
        if known is not None:
            return known
        if self.template is None:
            takes, report = formats.read(path, self.options.reading())
            self._reached = True
            _warn(report)
            return takes
        found, report = formats.read_any(path, self.options.reading())
        self._reached = True
        _warn(report)
        return [self._with_joints(path, take) for take in found]

    def _with_joints(self, path: Path, take: Take | MarkerTake) -> Take:
        """Return a take as it is, or its markers solved to the template; warnings are told."""
        if isinstance(take, Take) or self.template is None:
            assert isinstance(take, Take)
            return take
        from mocapstudio.cli.solving import read_template, solved

        if self._body is None:
            self._body = read_template(self.template, self.options)
        result = solved(path, take, self._body)
        for warning in result.warnings:
            print(f"warning: {path}: -: {warning}", file=sys.stderr)
        return result.take

    def context(self, paths: Sequence[Path] | None) -> tuple[Take, ...]:
        """Read the takes of a context, joints renamed by the joint map; bad ones are left out."""
        takes: list[Take] = []
        outcome = self._reached, [*self._left_out]
        for path in self.files(paths or ()):
            with self.going_on():
                takes += self._read.setdefault(path.resolve(), self.read(path))
        # What a context holds says nothing of whether there was a take to work on.
        self._reached, self._left_out = outcome
        if self.options.joint_map is None:
            return tuple(takes)
        names = read_joint_map(self.options.joint_map)
        return tuple(rename_joints(take, names) for take in takes)


def _warn(report: formats.ImportReport) -> None:
    # Every file leaves something to a guess; the import report tells of those.
    repaired = [problem for problem in report.problems if not problem.guess]
    for problem in repaired[:_SHOWN_PROBLEMS]:
        place = "-" if problem.line is None else problem.line
        print(f"warning: {report.path}: {place}: {problem.what}; {problem.done}", file=sys.stderr)
    more = len(repaired) - _SHOWN_PROBLEMS
    if more > 0:
        print(f"warning: {report.path}: -: {more} more, see mocapstudio inspect", file=sys.stderr)
