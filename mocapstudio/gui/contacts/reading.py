"""Where the points of the take under review are, worked out in the background."""

from __future__ import annotations

from collections.abc import Generator, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal

from mocapstudio.cleaning.contacts.changes import METHOD
from mocapstudio.cleaning.contacts.model import Contact, ContactPoint
from mocapstudio.cleaning.contacts.points import contact_points, point_positions
from mocapstudio.cleaning.ik.ranges import JointRanges, joint_ranges
from mocapstudio.cleaning.ik.targets import Hold, chosen_again, hold_at
from mocapstudio.gui.contacts.bridge import ContactsBridge
from mocapstudio.gui.contacts.lanes import key_of
from mocapstudio.gui.jobs import Jobs
from mocapstudio.gui.messages import Messages
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.kinematics import take_pose
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.take import Take
from mocapstudio.review.beside import on_clock
from mocapstudio.review.state import DocumentState

Array = NDArray[np.float64]
_KEY = "contacts-reading"


@dataclass(frozen=True, eq=False)
class Reading:
    """What is known of the take under review.

    Parameters
    ----------
    source
        The take as its file has it.
    points
        P contact points.
    before, after
        The take without and with the edits that meet contacts; one object while there are none.
    places_before, places_after
        (F, P, 3) metres.
    others
        The other performers on this take's clock, by id.
    palms
        Their contact points, by id.
    ranges
        How far joints turn, learnt from the take.
    """

    source: Take
    points: tuple[ContactPoint, ...]
    before: Take
    after: Take
    places_before: Array
    places_after: Array
    others: Mapping[str, Take]
    palms: Mapping[str, tuple[ContactPoint, ...]]
    ranges: JointRanges
    _laid: dict[Contact, Hold | str] = field(default_factory=dict)

    @property
    def solved(self) -> bool:
        """Whether there are edits that meet contacts."""
        return self.after is not self.before

    def place(self, contact: Contact, after: bool = False) -> Array:
        """(m, 3) metres: where a contact's point is over the contact's frames."""
        span = slice(contact.start, contact.end)
        keys = [point.key for point in self.points]
        if key_of(contact) in keys:
            places = self.places_after if after else self.places_before
            return places[span, keys.index(key_of(contact))]
        take = self.after if after else self.before
        positions, world = take_pose(take, contact.start, contact.end)
        joint = take.skeleton.index[contact.joint]
        return positions[:, joint] + rot.rotate(world[:, joint], np.zeros(3))

    def point(self, contact: Contact) -> ContactPoint:
        """Return the contact point of a contact."""
        plain = ContactPoint(contact.joint, contact.point, np.zeros(3))
        return next((one for one in self.points if one.key == key_of(contact)), plain)

    def hold(self, contact: Contact) -> Hold | None:
        """Lay a contact out over the take before the solve; None where `trouble` says why."""
        found = self._lay(contact)
        return found if isinstance(found, Hold) else None

    def hold_after(self, contact: Contact) -> Hold | None:
        """Lay a contact out over the take after the solve."""
        found = self.hold(contact)
        return None if found is None else chosen_again(found, self.place(contact, after=True))

    def trouble(self, contact: Contact) -> str:
        """Say why a contact cannot be met at all, or nothing."""
        found = self._lay(contact)
        return found if isinstance(found, str) else ""

    def _lay(self, contact: Contact) -> Hold | str:
        if contact not in self._laid:
            if len(self._laid) > 4096:
                self._laid.clear()
            try:
                place, offset = self.place(contact), self.point(contact).offset
                self._laid[contact] = hold_at(self.before, contact, offset, place, self.others)
            except MocapError as error:
                self._laid[contact] = str(error)
        return self._laid[contact]


class Readings(QObject):
    """Keeps the reading of the take under review up to date while the workspace is in front.

    Parameters
    ----------
    bridge
        What is shown.
    jobs
        Runs the work.
    messages
        Is told what went wrong.
    """

    changed = Signal()
    """Emitted when `now` is another reading, or none."""

    def __init__(self, bridge: ContactsBridge, jobs: Jobs, messages: Messages) -> None:
        super().__init__(bridge)
        self._bridge, self._jobs, self._messages = bridge, jobs, messages
        self._wanted: tuple[object, ...] = ()
        self._awake = False
        self.now: Reading | None = None
        bridge.desk.changed.connect(self._follow)

    def wake(self, awake: bool) -> None:
        """Begin to follow the document, or stop."""
        self._awake = awake
        if awake:
            self._look()

    def _follow(self, _old: DocumentState, _new: DocumentState) -> None:
        if self._awake:
            self._look()

    def _look(self) -> None:
        desk = self._bridge.desk
        state, document = desk.state, desk.document
        if state.take is None:
            self._wanted = ()
            self._jobs.cancel(_KEY)
            self._show(None)
            return
        before = document.uncorrected(state.active)
        solved = any(
            one.performer == state.active and one.method == METHOD and not one.muted
            for one in state.sitting.edits
        )
        after = document.result(state.active) if solved else before
        partners = {
            one.id: (document.result(one.id), one.offset)
            for one in state.scene.performers
            if one.id != state.active
        }
        points = document.contact_points(state.active)
        active = state.scene.performer(state.active)
        wanted = (state.take, before, after, points, active.offset, *partners.values())
        if len(wanted) == len(self._wanted) and all(map(_same, wanted, self._wanted)):
            return
        if self.now is not None and self.now.source is not state.take:
            self._show(None)
        self._wanted = wanted
        work = _read(state.take, before, after, points, active.offset, partners, self.now)
        self._jobs.start("Reading hands and feet", work, self._show, self._fail, key=_KEY)

    def _show(self, reading: Reading | None) -> None:
        if reading is not self.now:
            self.now = reading
            self.changed.emit()

    def _fail(self, error: BaseException) -> None:
        self._messages.complain(error, "Hands and feet could not be read")


def _same(a: object, b: object) -> bool:
    if isinstance(a, tuple) and isinstance(b, tuple) and len(a) == len(b) == 2:
        return a[0] is b[0] and a[1] == b[1]
    return a is b or (isinstance(a, float) and a == b)


def _read(
    source: Take,
    before: Take,
    after: Take,
    points: tuple[ContactPoint, ...] | None,
    offset: float,
    partners: Mapping[str, tuple[Take, float]],
    known: Reading | None,
) -> Generator[Progress, None, Reading]:
    yield Progress(0.0, "hands and feet")
    again = known if known is not None and known.source is source else None
    pose = take_pose(source) if points is None and again is None else None
    if points is None:
        points = contact_points(source, pose) if again is None else again.points
    yield Progress(0.3, "hands and feet")
    same = again is not None and _alike(again.points, points)
    if again is not None and same and again.before.rotations is before.rotations:
        places = again.places_before
    else:
        places = point_positions(before, points, pose if before is source else None)
    yield Progress(0.5, "hands and feet")
    later = places if after is before else point_positions(after, points)
    yield Progress(0.7, "partners")
    others = {name: on_clock(source, offset, take, at) for name, (take, at) in partners.items()}
    palms = {
        name: (again.palms[name] if again is not None and name in again.palms
               else contact_points(take))
        for name, take in others.items()
    }  # fmt: skip
    yield Progress(0.9, "ranges of the joints")
    ranges = joint_ranges([source]) if again is None else again.ranges
    return Reading(source, points, before, after, places, later, others, palms, ranges)


def _alike(a: tuple[ContactPoint, ...], b: tuple[ContactPoint, ...]) -> bool:
    return len(a) == len(b) and all(x is y for x, y in zip(a, b, strict=True))
