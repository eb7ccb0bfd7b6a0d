"""`mocapstudio contacts`: what a performer touches, and how much it slides there."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mocapstudio.cli.contact_options import Partner
from mocapstudio.cli.output import JsonPath, check_writable, write_json
from mocapstudio.cli.take_options import TakeOptions, with_take_options
from mocapstudio.motion.errors import FileError

if TYPE_CHECKING:
    from mocapstudio.cleaning.contacts.slide import TakeSlide
    from mocapstudio.cli.contact_files import Touching


@with_take_options
def contacts(
    take: Annotated[Path, typer.Argument(metavar="TAKE", help="The file to look at.")],
    contacts_path: Annotated[
        Path | None,
        typer.Option("--contacts", metavar="FILE", help="Contacts to use instead of finding them."),
    ] = None,
    contacts_out: Annotated[
        Path | None,
        typer.Option("--contacts-out", metavar="FILE", help="Write the contacts as JSON."),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("-o", "--out", metavar="OUT", help="Remove foot skate and write the motion."),
    ] = None,
    partner: Partner = None,
    json_path: JsonPath = None,
    *,
    reading: TakeOptions,
) -> None:
    """Find or read what feet and hands touch, and measure how much they slide there.

    With -o every contact is held at its place and the motion is written; nothing else changes.
    Without --json a table is printed. Of several performers in a file the first is looked at, the
    others are its partners.
    """
    from mocapstudio.cleaning.contacts.files import write_contacts
    from mocapstudio.cleaning.contacts.slide import measure_slide
    from mocapstudio.cli.contact_files import held, touching
    from mocapstudio.cli.targets import Targets

    inputs = [take, *(partner or ()), *([contacts_path] if contacts_path else [])]
    _check(json_path, contacts_out, inputs)
    target = None if out is None else Targets(out, [take], inputs)
    scene = touching(take, partner or (), contacts_path, reading)
    before = measure_slide(scene.take, scene.contacts, scene.points, scene.others)
    record = scene.record() | {"slide": {"before": before.mean, "after": None}}
    after = None
    if target is not None:
        result, document, performer = held(scene)
        after = measure_slide(result.take, scene.contacts, scene.points, scene.others, scene.laid())
        record |= _written(target.of(take, scene.take, alone=True), document, performer)
        record["slide"]["after"] = after.mean
        record["unreached"] = [
            {"contact": one.contact, "millimetres": one.millimetres, "frames": one.frames}
            for one in result.unreached
        ]
    if contacts_out is not None:
        write_contacts(
            contacts_out,
            scene.take,
            scene.contacts,
            scene.points,
            slide=record["slide"],
            others=scene.others,
        )
    if json_path is None:
        _show(scene, before, after)
    write_json(record, json_path)


def _check(json_path: Path | None, contacts_out: Path | None, inputs: list[Path]) -> None:
    for path in (json_path, contacts_out):
        check_writable(path)
    if contacts_out is not None and contacts_out.resolve() in {p.resolve() for p in inputs}:
        raise FileError(contacts_out, "is an input and is not overwritten")


def _written(target: Path, document: Any, performer: str) -> dict[str, Any]:
    from mocapstudio.cli import changes
    from mocapstudio.review.export import export

    export(document, performer, target)
    edits = document.state.sitting.edits
    return {"output": str(target), "changes": changes.as_json(target, target, edits)["changes"]}


def _show(scene: Touching, before: TakeSlide, after: TakeSlide | None) -> None:
    rate = float(scene.take.rate)
    for i, (contact, slid) in enumerate(zip(scene.contacts, before.contacts, strict=True)):
        name = f"{contact.joint} {contact.point or ''}".strip()
        held = "" if after is None else f" -> {100 * after.contacts[i].mean:6.2f}"
        print(
            f"{name:24} {contact.start:6d}:{contact.end:<6d} {contact.start / rate:8.2f} s"
            f"  confidence {contact.confidence:.2f}  slide {100 * slid.mean:6.2f}{held} cm/s"
        )
    told = "" if after is None else f", afterwards {100 * after.mean:.2f}"
    print(f"{len(scene.contacts)} contacts, mean slide {100 * before.mean:.2f} cm/s{told}")
