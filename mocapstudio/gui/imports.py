"""What is known of every file that was read in this sitting: how, and what was odd about it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from mocapstudio.formats import ImportReport, Problem, ReadOptions, Recording
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.motion.take import Take
from mocapstudio.review.state import DocumentState


@dataclass(frozen=True)
class Imported:
    """One file as it was read.

    Parameters
    ----------
    report
        What was odd about it.
    options
        How it was read.
    facts
        What it holds, in a few words.
    """

    report: ImportReport
    options: ReadOptions
    facts: str

    @property
    def path(self) -> Path:
        """The file."""
        return self.report.path

    @property
    def counts(self) -> str:
        """How much of it was odd, and how much guessed; "" for nothing."""
        guesses = sum(problem.guess for problem in self.report.problems)
        odd = len(self.report.problems) - guesses
        parts = (f"{odd} odd" if odd else "", f"{guesses} guessed" if guesses else "")
        return ", ".join(filter(None, parts))


def imported(
    found: Sequence[Recording], report: ImportReport, options: ReadOptions | None
) -> Imported:
    """Note how a file was read."""
    return Imported(report, options or ReadOptions(), facts(found))


def facts(found: Sequence[Recording]) -> str:
    """Say what a file holds."""
    first = found[0]
    joints = isinstance(first, Take)
    count = len(first.skeleton) if isinstance(first, Take) else len(first.labels)
    parts = [] if len(found) == 1 else [f"{len(found)} performers"]
    parts.append(f"{count} {'joints' if joints else 'markers'}")
    parts.append(f"{first.frames} frames at {float(first.rate):.6g} fps ({first.duration:.2f} s)")
    if first.source is not None:
        parts.append(f"1 unit = {first.source.unit:.4g} m")
    if first.trim is not None:
        parts.append(f"analysed from row {first.trim[0] + 1} to {first.trim[1]}")
    if not isinstance(first, Take) and first.missing.any():
        parts.append(f"{first.missing.mean():.1%} missing")
    return "  ·  ".join(parts)


class Imports(QObject):
    """Files behind the performers of the scene, in the scene's order.

    Parameters
    ----------
    bridge
        Tells which performers there are.
    parent
        Qt's parent.
    """

    changed = Signal()
    """Emitted when there is another list of files, or more is known of one."""

    def __init__(self, bridge: DocumentBridge, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._bridge = bridge
        self._known: dict[Path, Imported] = {}
        self._solved: dict[Take, Path] = {}
        bridge.changed.connect(self._follow)

    def note(self, one: Imported) -> None:
        """Keep how a file was read."""
        self._known[one.path.resolve()] = one
        self.changed.emit()

    def note_solved(self, take: Take, path: Path, remarks: Sequence[str]) -> None:
        """Keep which file of markers a take was solved from, and what there is to say of that."""
        self._solved[take] = path.resolve()
        one = self._known.get(path.resolve())
        if one is not None:
            told = tuple(Problem(None, remark, "solved all the same") for remark in remarks)
            new = tuple(problem for problem in told if problem not in one.report.problems)
            report = replace(one.report, problems=(*one.report.problems, *new))
            self.note(replace(one, report=report))

    def of(self, path: Path) -> Imported | None:
        """Return what is known of a file; nothing of one that came with a session."""
        return self._known.get(path.resolve())

    def file_of(self, take: Recording) -> Path | None:
        """Return the file that a take came from, or None for one that is in no file."""
        if take.source is not None:
            return take.source.path.resolve()
        return self._solved.get(take) if isinstance(take, Take) else None

    def solved(self, path: Path) -> bool:
        """Tell whether a file's markers were solved to what the scene shows."""
        takes = (one.take for one in self._bridge.state.scene.performers)
        return any(self._solved.get(take) == path.resolve() for take in takes)

    @property
    def files(self) -> tuple[Path, ...]:
        """Files of the scene's performers and of marker takes, each once."""
        found = (self.file_of(one.take) for one in self._bridge.state.everyone)
        return tuple(dict.fromkeys(path for path in found if path is not None))

    @property
    def active(self) -> Path | None:
        """File of the take under review, else of the first markers."""
        state = self._bridge.state
        first = state.performer or next(iter(state.markers), None)
        return None if first is None else self.file_of(first.take)

    def _follow(self, old: DocumentState, new: DocumentState) -> None:
        if old.scene is new.scene and old.markers is new.markers:
            return
        shown = {one.take for one in new.scene.performers}
        self._solved = {take: path for take, path in self._solved.items() if take in shown}
        self.changed.emit()
