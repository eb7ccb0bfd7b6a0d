"""Reading performances and comparing them in the background."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from mocapstudio import formats
from mocapstudio.comparison.masking import mask_of
from mocapstudio.comparison.model import Comparison
from mocapstudio.gui import settings
from mocapstudio.gui.compare.bridge import CompareBridge
from mocapstudio.gui.compare.flagging import Flagging
from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.messages import Messages
from mocapstudio.gui.trouble import Trouble, understand
from mocapstudio.motion.errors import MocapError, NoRateError
from mocapstudio.motion.progress import Progress
from mocapstudio.review.comparing import MOST_SOURCES, Compared, ComparingState, Recording

_DOING = "This could not be compared"
_OPENING = "This could not be opened"


@dataclass
class Read:
    """What came of reading files: performances, files without a rate, and what went wrong."""

    takes: list[Recording] = field(default_factory=list)
    rateless: list[Path] = field(default_factory=list)
    troubles: list[Trouble] = field(default_factory=list)


def reading(
    paths: Sequence[Path], options: formats.ReadOptions | None = None
) -> Generator[Progress, None, Read]:
    """Read files of joints or markers; a bad file is noted and the others are read."""
    result = Read()
    files = [one for path in paths for one in _files(path, result)]
    for done, path in enumerate(files):
        yield Progress(done / len(files), f"reading {path.name}")
        try:
            takes, _ = formats.read_any(path, options)
        except NoRateError:
            result.rateless.append(path)
        except Exception as error:
            result.troubles.append(understand(error, _OPENING))
        else:
            result.takes += takes
    return result


def _files(path: Path, result: Read) -> Sequence[Path]:
    if not path.is_dir():
        return [path]
    try:
        return formats.find_takes([path])
    except Exception as error:
        result.troubles.append(understand(error, _OPENING))
        return []


class Working(QObject):
    """Keeps the sitting supplied: reads what the user names, compares what is pending.

    Parameters
    ----------
    bridge
        Where state comes from and results go.
    flagging
        Knows what is flagged in the performances.
    jobs
        Runs the work.
    messages
        Is told what went wrong.
    parent
        Qt's parent.
    """

    rate_wanted = Signal(object, object)
    """Emitted with files that state no frame rate, and what to call with one (a Fraction)."""

    def __init__(
        self,
        bridge: CompareBridge,
        flagging: Flagging,
        jobs: Jobs,
        messages: Messages,
        parent: QObject,
    ) -> None:
        super().__init__(parent)
        self._bridge, self._jobs, self._messages = bridge, jobs, messages
        self._flagging = flagging
        self._begun: set[Compared] = set()
        bridge.changed.connect(self._follow)

    def set_reference(self, path: Path) -> None:
        """Read a performance and compare to it; what else its file holds becomes a source."""

        def done(read: Read) -> None:
            if read.takes:
                self._bridge.sitting.set_reference(read.takes[0])
                self._add(read.takes[1:])
            self._remember([path], read)

        self._read([path], done)

    def add_sources(self, paths: Sequence[Path]) -> None:
        """Read performances and compare them; without a reference the first becomes it."""

        def done(read: Read) -> None:
            self.take_in(read.takes)
            self._remember(paths, read)

        self._read(paths, done)

    def take_in(self, takes: Sequence[Recording]) -> None:
        """Compare performances that are at hand; without a reference the first becomes it."""
        rest = list(takes)
        if self._bridge.state.reference is None and rest:
            self._bridge.sitting.set_reference(rest.pop(0))
        self._add(rest)

    def _add(self, takes: Sequence[Recording]) -> None:
        room = MOST_SOURCES - len(self._bridge.state.sources)
        if takes[:room]:
            self._bridge.sitting.add_sources(takes[:room])
        if takes[room:]:
            left = ", ".join(one.name for one in takes[room:])
            words = f"At most {MOST_SOURCES} sources are compared at once; left out: {left}."
            self._messages.tell(words)

    def _read(
        self,
        paths: Sequence[Path],
        done: Callable[[Read], None],
        options: formats.ReadOptions | None = None,
    ) -> None:
        wanted = list(paths)
        name = wanted[0].name if len(wanted) == 1 else f"{len(wanted)} performances"

        def arrived(read: Read) -> None:
            done(read)
            if read.rateless:
                self.rate_wanted.emit(
                    tuple(read.rateless),
                    lambda rate: self._read(read.rateless, done, formats.ReadOptions(fps=rate)),
                )

        self._jobs.start(
            f"Reading {name}",
            reading(wanted, options),
            arrived,
            lambda error: self._messages.complain(error, _OPENING),
        )

    def _remember(self, paths: Sequence[Path], read: Read) -> None:
        if read.takes:
            settings.set_folder("compare", paths[0])
            for path in paths:
                if path.is_file():
                    settings.add_recent("files", path)
        self._messages.complain_of(read.troubles)

    # -- comparing

    def _follow(self, old: ComparingState, new: ComparingState) -> None:
        same = new.sources is old.sources and new.reference is old.reference
        if same:
            return
        pending = self._bridge.sitting.pending()
        # What was asked for and is no longer wanted need not be finished.
        for one in self._begun - set(pending):
            self._jobs.cancel(_key(one))
        self._begun &= set(pending)
        self._begin()

    def _begin(self) -> None:
        """Compare what is pending; what is flagged in it is found out first, where that counts."""
        state, pending = self._bridge.state, self._bridge.sitting.pending()
        if pending and state.parameters.masked and state.reference is not None:
            everyone = [state.reference, *(one.take for one in pending)]
            if any(self._flagging.of(one) is None for one in everyone):
                self._flagging.find(everyone, self._begin, self._give_up)
                return
        self._flagging.stop()
        for one in pending:
            if one not in self._begun:
                self._begun.add(one)
                self._compare(one)

    def _give_up(self) -> None:
        """Nobody wants to wait for the flags."""
        if self._bridge.state.parameters.masked:
            for one in self._bridge.sitting.pending():
                self._bridge.sitting.fail(one, "cancelled")

    def _compare(self, source: Compared) -> None:
        state = self._bridge.state
        assert state.reference is not None
        reference, parameters = state.reference, state.parameters
        both = reference, source.take
        masked = parameters.masked
        flagged = [self._flagging.of(one) or () if masked else () for one in both]

        def work() -> Generator[Progress, None, Comparison]:
            yield Progress(0.0, f"comparing {source.id}")
            from mocapstudio.comparison.kata import compare

            masks = [
                mask_of(one, spans, parameters.features) if spans else None
                for one, spans in zip(both, flagged, strict=True)
            ]
            return (
                yield from compare(
                    *both, parameters, reference_unreliable=masks[0], source_unreliable=masks[1]
                )
            )

        def failed(error: BaseException) -> None:
            self._begun.discard(source)
            if not self._bridge.sitting.fail(source, str(error)):
                return
            if not isinstance(error, MocapError):
                self._messages.complain(error, _DOING)

        def done(comparison: Comparison) -> None:
            self._begun.discard(source)
            self._bridge.sitting.finish(source, comparison)

        job = self._jobs.start(f"Comparing {source.id}", work(), done, failed, key=_key(source))
        job.ended.connect(lambda: self._ended(source, job.cancelled))

    def _ended(self, source: Compared, cancelled: bool) -> None:
        if cancelled and source in self._begun:
            self._begun.discard(source)
            self._bridge.sitting.fail(source, "cancelled")


def _key(source: Compared) -> str:
    return f"compare {id(source)}"
