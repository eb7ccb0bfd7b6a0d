"""What is flagged in the performances that are compared, where that is to be left out."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from weakref import WeakKeyDictionary

from PySide6.QtCore import QObject

from mocapstudio.comparison.masking import Flagged
from mocapstudio.gui.document import DocumentBridge
from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.messages import Messages
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.recording import same_recording
from mocapstudio.motion.take import Take
from mocapstudio.review.comparing import Recording
from mocapstudio.review.model import Verdict

_JOB = "compare flags"

Flags = tuple[Flagged, ...]


class Flagging(QObject):
    """Knows what is flagged: as the review found and decided, else as a quick analysis finds.

    Each take is analysed by itself: beside another performance, what is performed otherwise would
    be flagged too.

    Parameters
    ----------
    document
        Where flags were decided about.
    jobs
        Runs the analysis.
    messages
        Is told what went wrong.
    parent
        Qt's parent.
    """

    def __init__(
        self, document: DocumentBridge, jobs: Jobs, messages: Messages, parent: QObject
    ) -> None:
        super().__init__(parent)
        self._document, self._jobs, self._messages = document, jobs, messages
        self._found: WeakKeyDictionary[Recording, Flags] = WeakKeyDictionary()

    def of(self, recording: Recording) -> Flags | None:
        """Return what is flagged, or None where that is still to be found out.

        Markers are not analysed: of them only what is missing is left out.
        """
        if not isinstance(recording, Take):
            return ()
        reviewed = self._reviewed(recording)
        return self._found.get(recording) if reviewed is None else reviewed

    def find(
        self,
        recordings: Sequence[Recording],
        done: Callable[[], object],
        cancelled: Callable[[], object],
    ) -> None:
        """Analyse what is not known yet in the background, then call one of two."""
        wanted = [one for one in recordings if isinstance(one, Take) and self.of(one) is None]

        def work() -> Generator[Progress, None, list[Flags]]:
            yield Progress(0.0, "looking for flags")
            from mocapstudio.cleaning.detection import detect

            found = []
            for number, take in enumerate(wanted):
                steps = detect(take)
                while True:
                    try:
                        step = next(steps)
                    except StopIteration as stop:
                        analysis = stop.value
                        break
                    yield Progress((number + step.done) / len(wanted), f"analysing {take.name}")
                found.append(
                    tuple(Flagged((f.joint, *f.joints), f.start, f.end) for f in analysis.flags)
                )
            return found

        def arrived(found: list[Flags]) -> None:
            for take, flags in zip(wanted, found, strict=True):
                self._found[take] = flags
            done()

        def failed(error: BaseException) -> None:
            self._messages.complain(error, "Flags could not be looked for")
            cancelled()

        job = self._jobs.start("Looking for flags", work(), arrived, failed, key=_JOB)
        job.ended.connect(lambda: cancelled() if job.cancelled else None)

    def stop(self) -> None:
        """Analyse no longer."""
        self._jobs.cancel(_JOB)

    def _reviewed(self, take: Take) -> Flags | None:
        document, state = self._document.document, self._document.state
        for performer in state.scene.performers:
            if performer.id not in state.analyses or not _performs(performer.take, take):
                continue
            # What was repaired is right where the repaired motion is what is compared.
            repaired = take.source is None and performer.take.source is not None
            kept = {Verdict.OPEN, Verdict.DEFERRED} | (set() if repaired else {Verdict.ACCEPTED})
            items = (one for one in document.queue(performer.id) if one.verdict in kept)
            return tuple(
                Flagged((one.flag.joint, *one.flag.joints), one.flag.start, one.flag.end)
                for one in items
            )
        return None


def _performs(reviewed: Take, take: Take) -> bool:
    """Tell whether a take is one under review, as recorded or repaired."""
    if same_recording(reviewed, take):
        return True
    alike = (reviewed.name, reviewed.frames, reviewed.rate) == (take.name, take.frames, take.rate)
    return take.source is None and alike and reviewed.skeleton is take.skeleton
