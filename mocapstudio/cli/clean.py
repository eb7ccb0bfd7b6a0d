"""`mocapstudio clean`: every proposal accepted, without the desk."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mocapstudio.cli.contact_options import Partner, by_take
from mocapstudio.cli.detection_options import ModeOption, Quick, Threshold
from mocapstudio.cli.output import JsonPath, check_writable, write_json
from mocapstudio.cli.solving import TemplateOption
from mocapstudio.cli.take_options import Context, TakeOptions, with_take_options
from mocapstudio.motion.errors import MocapError

if TYPE_CHECKING:
    from mocapstudio.cleaning.analysis import Analysis
    from mocapstudio.cli.contact_files import Touching
    from mocapstudio.motion.take import Take
    from mocapstudio.review.document import Document

OutPath = Annotated[
    Path,
    typer.Option(
        "-o", "--out", metavar="OUT", help="File to write; a folder where there are several takes."
    ),
]


@with_take_options
def clean(
    takes: Annotated[list[Path], typer.Argument(metavar="TAKE...", help="Files or folders.")],
    out: OutPath,
    context: Context = None,
    contacts: Annotated[
        Path | None,
        typer.Option(
            "--contacts",
            metavar="FILE",
            help="Contacts to keep, as `contacts --contacts-out` writes them; for several takes a"
            " folder with a file of each take's name, such as 05_02.json.",
        ),
    ] = None,
    partner: Partner = None,
    threshold: Threshold = None,
    mode: ModeOption = None,
    quick: Quick = False,
    template: TemplateOption = None,
    json_path: JsonPath = None,
    *,
    reading: TakeOptions,
) -> None:
    """Repair all that is found in takes, and write them.

    Nothing else is changed. What was changed, from which neighbour, is written beside each take
    as its provenance. With --contacts, of a flag's neighbours the one that comes closest to the
    contact is taken and bent to it, and at the end every contact is held at its place.
    """
    from mocapstudio.cli import changes
    from mocapstudio.cli.detection_options import analyse, parameters
    from mocapstudio.cli.take_files import Workload
    from mocapstudio.cli.targets import Targets
    from mocapstudio.review.export import export

    chosen = parameters(threshold, mode)
    check_writable(json_path)
    work = Workload(reading, template=template)
    files = work.files(takes)
    context_files = work.files(context or ())
    touched = by_take(contacts, files)
    beside = partner or ()
    targets = Targets(out, files, (*files, *context_files, *touched.values(), *beside))
    others = work.context(context_files)
    partners = [one for path in beside for one in work.read(path)]
    done: list[dict[str, Any]] = []
    for path in files:
        with work.going_on():
            found = work.read(path)
            for take in found:
                target = targets.of(path, take, alone=len(found) == 1)
                scene = _scene(path, [*found, *partners], take, touched.get(path))
                document, performer = repaired(
                    analyse(take, others, chosen, quick=quick), context or (), scene
                )
                export(document, performer, target)
                done.append(changes.as_json(path, target, document.state.sitting.edits))
    write_json({"takes": done}, json_path)
    raise typer.Exit(work.finish())


def repaired(
    analysis: Analysis,
    context: list[Path] | tuple[Path, ...],
    scene: Touching | None = None,
) -> tuple[Document, str]:
    """Return a document in which every flag of an analysis is accepted, and the performer's id.

    The contacts of `scene` are the document's, so that its proposals keep to them; at the end they
    are held. A flag that nothing can be proposed for stays open, with a warning on standard error.
    """
    from mocapstudio.review.document import Document

    document = Document()
    performer = document.open_take(analysis.take)
    if scene is not None:
        from mocapstudio.cli.contact_files import bring

        bring(document, scene)
    document.set_context(context, analysis.context)
    document.set_parameters(analysis.parameters)
    document.finish_analysis(performer, document.begin_analysis(performer), analysis)
    for flag in analysis.flags:
        try:
            document.accept(flag.id)
        except MocapError as error:
            place = f"{flag.joint} at frames {flag.start}:{flag.end}"
            print(f"warning: {analysis.take.name}: {place}: {error}", file=sys.stderr)
    if scene is not None:
        from mocapstudio.cli.contact_files import hold

        hold(document, scene.over(document.result(performer)))
    return document, performer


def _scene(path: Path, takes: Sequence[Take], take: Take, contacts: Path | None) -> Touching | None:
    if contacts is None:
        return None
    from mocapstudio.cli.contact_files import with_file

    return with_file(path, takes, take, contacts)
