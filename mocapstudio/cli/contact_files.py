"""A take with its contacts as the command line names them, and the clean-up of it."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mocapstudio.cleaning.contacts.detection import detecting
from mocapstudio.cleaning.contacts.files import contacts_record, read_contacts
from mocapstudio.cleaning.contacts.model import Contact, ContactPoint, Following
from mocapstudio.cleaning.contacts.points import contact_points
from mocapstudio.cli.progress import run
from mocapstudio.cli.take_files import Workload
from mocapstudio.cli.take_options import TakeOptions
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.take import Take

if TYPE_CHECKING:
    from mocapstudio.cleaning.ik.foot_skate import SkateResult
    from mocapstudio.cleaning.ik.targets import Hold
    from mocapstudio.review.document import Document

_SHOWN = 5


@dataclass(frozen=True, eq=False)
class Touching:
    """A take, what may touch, what does, and whom.

    Parameters
    ----------
    path, take
        The performer.
    contacts, points
        Theirs.
    others
        Takes of partners and props, by name, on this take's clock.
    """

    path: Path
    take: Take
    contacts: tuple[Contact, ...]
    points: tuple[ContactPoint, ...]
    others: Mapping[str, Take]

    def record(self) -> dict[str, Any]:
        """Return what the JSON tells of them."""
        record = contacts_record(self.take, self.contacts, self.points, self.others)
        return record | {"take": str(self.path), "frames": self.take.frames}

    def over(self, take: Take) -> Touching:
        """Return the same contacts over another version of the take."""
        return replace(self, take=take)

    def laid(self) -> tuple[Hold, ...]:
        """Return the contacts laid out over the take."""
        from mocapstudio.cleaning.ik.targets import holds

        return holds(self.take, self.contacts, self.points, self.others)


def touching(
    path: Path, partners: Sequence[Path], contacts: Path | None, reading: TakeOptions
) -> Touching:
    """Read a take, its partners and its contacts; without a file of contacts they are found.

    Raises
    ------
    FileError
        If a file cannot be read, or does not fit the take.
    """
    work = Workload(reading)
    takes = work.read(path)
    beside = [one for partner in partners for one in work.read(partner)]
    if not takes:
        raise FileError(path, "holds no motion of a skeleton")
    if contacts is not None:
        return with_file(path, [*takes, *beside], takes[0], contacts)
    take = takes[0]
    others = _beside(take, (*takes[1:], *beside))
    points = contact_points(take)
    found = run(detecting(take, others, points), "contacts")
    return Touching(path, take, found, points, others)


def with_file(path: Path, scene: Sequence[Take], take: Take, contacts: Path) -> Touching:
    """Return a take with the contacts of a file.

    Contact points that the file does not name are those of the take.

    Parameters
    ----------
    path
        Where the take was read from.
    scene
        All takes that contacts may follow; `take` may be among them.

    Raises
    ------
    FileError
        If the file cannot be read, or does not fit.
    """
    points = contact_points(take)
    file = read_contacts(contacts, take, points)
    adjusted = {point.key: point for point in (*points, *file.points)}
    others = _beside(take, scene)
    for contact in file.contacts:
        target = contact.target
        if isinstance(target, Following) and target.performer not in others:
            raise FileError(
                contacts,
                f"contact {contact.id} follows {target.performer}: name that take by --partner",
            )
    return Touching(path, take, file.contacts, tuple(adjusted.values()), others)


def _beside(take: Take, scene: Sequence[Take]) -> dict[str, Take]:
    from mocapstudio.review.beside import on_clock

    return {one.name: on_clock(take, 0.0, one, 0.0) for one in scene if one is not take}


def held(scene: Touching) -> tuple[SkateResult, Document, str]:
    """Hold every contact; returns the result, and a document with it as edits of a performer."""
    from mocapstudio.review.document import Document

    document = Document()
    performer = document.open_take(scene.take)
    return hold(document, scene), document, performer


def bring(document: Document, scene: Touching) -> None:
    """Give the active performer of a document the contacts of a scene, and the scene's partners."""
    ids = {name: document.open_take(one, partner=True) for name, one in scene.others.items()}
    contacts = [
        replace(one, target=replace(one.target, performer=ids[one.target.performer]))
        if isinstance(one.target, Following)
        else one
        for one in scene.contacts
    ]
    document.load_contacts(contacts, scene.points)


def hold(document: Document, scene: Touching) -> SkateResult:
    """Hold every contact of the active performer; what cannot be reached is told on standard error.

    Parameters
    ----------
    scene
        Its take is the document's result so far.
    """
    from mocapstudio.cleaning.contacts.changes import as_proposals
    from mocapstudio.cleaning.ik.foot_skate import clean

    work = clean(scene.take, scene.contacts, scene.points, others=scene.others)
    result = run(work, "contacts")
    with document.group("Hold contacts"):
        for proposal in as_proposals(result.take, result.declared):
            document.add_edit(proposal, "Hold contacts")
    worst = sorted(result.unreached, key=lambda one: -one.millimetres)
    for one in worst[:_SHOWN]:
        print(
            f"warning: {scene.path}: contact {one.contact}: {one.millimetres:.1f} mm out of reach"
            f" in {one.frames} frames",
            file=sys.stderr,
        )
    if len(worst) > _SHOWN:
        more = len(worst) - _SHOWN
        print(f"warning: {scene.path}: {more} more out of reach", file=sys.stderr)
    return result
