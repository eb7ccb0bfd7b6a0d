"""Detecting and solving, in the background."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping, Sequence
from functools import partial

from PySide6.QtCore import QObject

from mocapstudio.cleaning.contacts.changes import as_proposals
from mocapstudio.cleaning.contacts.detection import detecting
from mocapstudio.cleaning.contacts.model import Contact, ContactPoint, Fixed
from mocapstudio.cleaning.ik.drag import KeptFrame
from mocapstudio.cleaning.ik.foot_skate import SkateResult, clean
from mocapstudio.cleaning.ik.meet import Met, meet
from mocapstudio.gui.contacts.bridge import ContactsBridge
from mocapstudio.gui.contacts.lanes import Key
from mocapstudio.gui.contacts.reading import Reading, Readings
from mocapstudio.gui.contacts.targets import drawn_target
from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.messages import Messages
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.take import Take
from mocapstudio.review.around import around_repairs
from mocapstudio.review.model import Scene

DETECT, SOLVE, MEET = "contacts-detect", "contacts-solve", "contacts-meet"


class Working(QObject):
    """Runs what takes a while and hands what came of it to the document.

    Parameters
    ----------
    bridge
        What is shown.
    readings
        Points of the take under review.
    jobs
        Runs the work.
    messages
        Is told what came of it.
    """

    def __init__(
        self, bridge: ContactsBridge, readings: Readings, jobs: Jobs, messages: Messages
    ) -> None:
        super().__init__(bridge)
        self._bridge, self._readings = bridge, readings
        self._jobs, self._messages = jobs, messages

    @property
    def busy(self) -> bool:
        """Whether contacts are being detected, solved or met."""
        return any(job.key in (DETECT, SOLVE, MEET) for job in self._jobs.running)

    def detect(self, then: Callable[[], object] | None = None) -> None:
        """Find contacts of the take under review; what was drawn stays. Then go on, if asked to."""
        desk, reading = self._bridge.desk, self._readings.now
        document, performer = desk.document, desk.state.active
        if reading is None:
            return

        def found(contacts: tuple[Contact, ...]) -> None:
            if desk.document is not document or not _is_open(desk.state.scene, performer):
                return
            document.set_detected(performer, contacts)
            count = sum(not one.drawn for one in document.contacts(performer))
            self._messages.tell(f"{count} contact{'' if count == 1 else 's'} found.")
            if then is not None and count:
                then()

        work = _detecting(reading, self._bridge.kept)
        words = "Contacts could not be detected"
        failed = partial(self._messages.complain, doing=words)
        self._jobs.start("Detecting contacts", work, found, failed, key=DETECT)

    def solve(self) -> None:
        """Bend the motion so that every contact that can be met is met."""
        reading = self._readings.now
        if reading is not None:
            self._solve(reading, [one for one in self._bridge.kept if not reading.trouble(one)])

    def solve_around(self) -> None:
        """Meet contacts around accepted repairs only; detect them first if there are none."""
        reading = self._readings.now
        if reading is None:
            return
        if not self._bridge.kept:
            self.detect(then=self.solve_around)
            return
        usable = [one for one in self._bridge.kept if not reading.trouble(one)]
        pieces = around_repairs(reading.before, usable, self._bridge.repairs)
        if pieces:
            self._solve(reading, pieces)
        else:
            self._messages.tell("No accepted repair moves a point in contact: nothing to solve.")

    def _solve(self, reading: Reading, contacts: Sequence[Contact]) -> None:
        desk = self._bridge.desk
        document, performer = desk.document, desk.state.active
        kept = self._bridge.kept
        left_out = sum(bool(reading.trouble(one)) for one in kept)

        def solved(result: SkateResult) -> None:
            if desk.document is not document or not _is_open(desk.state.scene, performer):
                return
            base = document.uncorrected(performer)
            if document.contacts(performer) != kept or not _same_motion(base, reading.before):
                self._messages.tell("Contacts or edits changed meanwhile: solve again.")
                return
            try:
                document.set_corrections(performer, as_proposals(result.take, result.declared))
            except MocapError as error:
                self._messages.complain(error, "The contacts cannot be met")
                return
            self._bridge.set_ui(unreached=result.unreached)
            self._messages.tell(_told(result, left_out))

        work = clean(
            reading.before,
            contacts,
            reading.points,
            others=reading.others,
            ranges=reading.ranges,
        )
        words = "The contacts could not be met"
        failed = partial(self._messages.complain, doing=words)
        self._jobs.start("Meeting contacts", work, solved, failed, key=SOLVE)

    def meet(self, held: Contact, kept: KeptFrame | None) -> None:
        """Give a contact the target it was dragged to, and bend its limb to it: one step.

        What stands with it goes along. The rest of the body stays as it is, and so does the frame
        that was dragged.
        """
        desk, reading = self._bridge.desk, self._readings.now
        document, performer = desk.document, desk.state.active
        along = self._bridge.ui.along
        targets = {one.id: one.target for one in (held, *along)}

        def there() -> bool:
            same = desk.document is document and desk.state.active == performer
            return same and targets.keys() <= {one.id for one in self._bridge.kept}

        def move_only() -> None:
            if there():
                document.move_targets(targets, ())
            self._bridge.set_ui(held=None)

        base = document.result(performer)
        if reading is None or reading.trouble(held) or not _same_motion(base, reading.after):
            move_only()
            return

        def met(result: Met) -> None:
            if not there() or not _same_motion(document.result(performer), base):
                move_only()
                return
            try:
                proposals = as_proposals(result.take, result.declared)
                document.move_targets(targets, proposals)
            except MocapError as error:
                move_only()
                self._messages.complain(error, "The body cannot follow the target")
                return
            others = (one for one in self._bridge.ui.unreached if one.contact not in targets)
            self._bridge.set_ui(held=None, unreached=(*others, *result.unreached))
            for one in result.unreached:
                self._messages.tell(
                    f"Out of reach by {one.millimetres:.0f} mm: the nearest pose was taken."
                )

        def failed(error: BaseException) -> None:
            move_only()
            self._messages.complain(error, "The body cannot follow the target")

        work = meet(
            base,
            held,
            reading.points,
            along=along,
            others=reading.others,
            ranges=reading.ranges,
            kept=kept,
        )
        job = self._jobs.start("Meeting the contact", work, met, failed, key=MEET, awaited=True)
        job.ended.connect(lambda: move_only() if job.cancelled else None)

    def draw(self, key: Key, start: int, end: int) -> None:
        """Add a contact that was drawn by hand, and choose it."""
        reading, document = self._readings.now, self._bridge.desk.document
        if reading is None:
            return
        draft = Contact("", key[0], key[1], start, end, Fixed((0.0, 0.0, 0.0)), 1.0, True)
        point = reading.point(draft)
        target = drawn_target(reading, point, draft, self._bridge.kept)
        added = document.add_contact(Contact("", key[0], key[1], start, end, target, 1.0, True))
        self._bridge.choose(added)


def _detecting(
    reading: Reading, keep: Sequence[Contact]
) -> Generator[Progress, None, tuple[Contact, ...]]:
    partners: Mapping[str, Take] = reading.others
    points: tuple[ContactPoint, ...] = reading.points
    return (yield from detecting(reading.before, partners, points, keep))


def _same_motion(one: Take, other: Take) -> bool:
    return one.rotations is other.rotations and one.translations is other.translations


def _is_open(scene: Scene, performer: str) -> bool:
    return any(one.id == performer for one in scene.performers)


def _told(result: SkateResult, left_out: int) -> str:
    slide = result.slide
    words = [f"Slide in contact {100 * slide.before:.1f} → {100 * slide.after:.1f} cm/s"]
    words.append(f"hips moved {100 * result.moved:.1f} cm at most")
    if result.unreached:
        words.append(f"{len(result.unreached)} out of reach")
    if left_out:
        words.append(f"{left_out} left out")
    return "; ".join(words) + "."
