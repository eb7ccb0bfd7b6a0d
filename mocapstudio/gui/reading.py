"""Reading takes in the background: a bad file never keeps the others back."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from mocapstudio import formats
from mocapstudio.gui.imports import Imported, imported
from mocapstudio.gui.trouble import Trouble, understand
from mocapstudio.motion.errors import NoRateError, SkeletonMismatchError
from mocapstudio.motion.joint_map import rename_joints
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.take import Take
from mocapstudio.review.manner import AS_THEY_ARE, Manner


@dataclass
class Read:
    """What came of reading files: takes, what was odd, and what could not be read.

    `markers` are files that hold no skeleton, `rateless` those that state no frame rate.
    """

    takes: list[Take] = field(default_factory=list)
    markers: list[MarkerTake] = field(default_factory=list)
    files: list[Imported] = field(default_factory=list)
    rateless: list[Path] = field(default_factory=list)
    troubles: list[Trouble] = field(default_factory=list)


def reading(
    paths: Sequence[Path], doing: str, manner: Manner = AS_THEY_ARE
) -> Generator[Progress, None, Read]:
    """Read files and folders; a bad file is noted and the others are read all the same."""
    result = Read()
    files: dict[Path, Path] = {}
    for path in paths:
        try:
            files |= {one.resolve(): one for one in formats.find_takes([path])}
        except Exception as error:
            result.troubles.append(understand(error, doing))
    for done, path in enumerate(files.values()):
        yield Progress(done / len(files), f"reading {path.name}")
        options = manner.of(path)
        try:
            found, report = formats.read_any(path, options)
        except NoRateError:
            result.rateless.append(path)
        except Exception as error:
            result.troubles.append(understand(error, doing))
        else:
            takes = [one for one in found if isinstance(one, Take)]
            result.takes += takes
            if not takes:
                result.markers += [one for one in found if isinstance(one, MarkerTake)]
            result.files.append(imported(takes or found, report, options))
    return result


def reading_context(
    paths: Sequence[Path], doing: str, take: Take | None, manner: Manner = AS_THEY_ARE
) -> Generator[Progress, None, Read]:
    """Read a context; what has another skeleton than the take under review is left out too."""
    result = yield from reading(paths, doing, manner)
    result.takes = [rename_joints(one, manner.renamed) for one in result.takes]
    for markers in result.markers:
        file = "" if markers.source is None else str(markers.source.path)
        cause = "holds markers and no skeleton: open it, and solve it to a skeleton first"
        result.troubles.append(Trouble(doing, cause, file))
    if take is not None:
        from mocapstudio.similarity.texture import comparable_joints

        for other in list(result.takes):
            try:
                comparable_joints(take, [other])
            except SkeletonMismatchError as error:
                result.takes.remove(other)
                result.troubles.append(understand(error, doing))
    return result
