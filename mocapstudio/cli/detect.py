"""`mocapstudio detect`: the flags of takes, and their maps."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from mocapstudio.cli.detection_options import ModeOption, Quick, Threshold
from mocapstudio.cli.output import JsonPath, check_writable, write_json, write_npz
from mocapstudio.cli.solving import TemplateOption
from mocapstudio.cli.take_options import Context, TakeOptions, with_take_options
from mocapstudio.motion.errors import MocapError

if TYPE_CHECKING:
    from mocapstudio.cleaning.analysis import Analysis
    from mocapstudio.cleaning.model import Flag

MapPath = Annotated[
    Path | None,
    typer.Option(
        "--map",
        metavar="OUT.npz",
        help="Write the digression map; a folder where there are several takes.",
    ),
]


@with_take_options
def detect(
    takes: Annotated[list[Path], typer.Argument(metavar="TAKE...", help="Files or folders.")],
    context: Context = None,
    threshold: Threshold = None,
    mode: ModeOption = None,
    quick: Quick = False,
    template: TemplateOption = None,
    map_path: MapPath = None,
    json_path: JsonPath = None,
    *,
    reading: TakeOptions,
) -> None:
    """Find what is wrong in takes, where, and how badly.

    Every take is compared with itself and with the context. Without --json, flags are printed
    worst first.
    """
    from mocapstudio.cli.detection_options import analyse, parameters
    from mocapstudio.cli.take_files import Workload

    chosen = parameters(threshold, mode)
    check_writable(json_path)
    work = Workload(reading, template=template)
    files = work.files(takes)
    maps = _MapFiles(map_path, several=len(files) > 1)
    others = work.context(context)
    found: list[dict[str, Any]] = []
    for path in files:
        with work.going_on():
            for take in work.read(path):
                analysis = analyse(take, others, chosen, quick=quick)
                maps.write(analysis, path)
                found.append(as_json(analysis, path))
                if json_path is None:
                    _show(analysis, path)
    write_json({"takes": found}, json_path)
    raise typer.Exit(work.finish())


def as_json(analysis: Analysis, path: Path) -> dict[str, Any]:
    """Return what the JSON says of one take."""
    take = analysis.take
    return {
        "path": str(path),
        "fps": float(take.rate),
        "frames": take.frames,
        "joints": list(take.skeleton.names),
        "threshold": analysis.parameters.threshold,
        "flags": [_flag_as_json(flag) for flag in analysis.flags],
    }


def _flag_as_json(flag: Flag) -> dict[str, Any]:
    return {
        "id": flag.id,
        "joint": flag.joint,
        "joints": list(flag.joints),
        "start": flag.start,
        "end": flag.end,
        "peak": float(flag.peak),
        "peak_frame": flag.peak_frame,
        "score": float(flag.score),
        "kind": flag.kind.value,
    }


class _MapFiles:
    """Where the maps of the takes are written, if at all."""

    def __init__(self, path: Path | None, *, several: bool) -> None:
        self.path = path
        self.folder = path is not None and (several or path.is_dir())
        self._written: set[Path] = set()
        if path is not None and not self.folder:
            check_writable(path)

    def write(self, analysis: Analysis, source: Path) -> None:
        """Write digression (frames x rows), joints, fps and threshold to an npz file.

        Raises
        ------
        FileError
            If the file cannot be written.
        MocapError
            If another take's map was written to the same file.
        """
        import numpy as np

        if self.path is None:
            return
        target = self.path
        if self.folder:
            target.mkdir(parents=True, exist_ok=True)
            target = target / f"{analysis.take.name}.npz"
        if target in self._written:
            raise MocapError(f"{source}: -: its map would replace that of another take, {target}")
        self._written.add(target)
        arrays = {
            "digression": np.asarray(analysis.map.values, dtype=np.float32),
            "joints": np.array(analysis.map.rows),
            "fps": np.float64(analysis.take.rate),
            "threshold": np.float64(analysis.parameters.threshold),
        }
        write_npz(arrays, target)


def _show(analysis: Analysis, path: Path) -> None:
    from rich.console import Console
    from rich.table import Table

    console = Console()
    take = analysis.take
    many = len(analysis.flags)
    console.print(f"{path}: {take.frames} frames, {many} flags", markup=False, highlight=False)
    if analysis.unanalysed:
        console.print(f"not analysed: {', '.join(analysis.unanalysed)}", markup=False)
    if not many:
        return
    table = Table("Joint", "Time", "Frames", "Score", "Kind", box=None, pad_edge=False)
    for flag in sorted(analysis.flags, key=lambda flag: -flag.score):
        table.add_row(
            flag.joint,
            f"{take.seconds(flag.start):.2f} s",
            f"{flag.start}:{flag.end}",
            f"{flag.score:.2f}",
            flag.kind.value,
        )
    console.print(table)
