"""C3D: from a marker take to a file's bytes, from its source where it has one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from mocapstudio.formats.c3d_compose import composed
from mocapstudio.formats.c3d_patch import patched
from mocapstudio.formats.options import WriteOptions
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.markers import MarkerTake


def write_c3d(
    take: MarkerTake, declared: Sequence[Declared], options: WriteOptions
) -> Iterator[bytes]:
    """Bytes of the take as C3D; `declared` counts where the source's bytes are kept.

    Raises
    ------
    MocapError
        If a sample changed without being declared, or the format cannot hold the take.
    """
    kept = take.source is not None and take.source.format == "c3d" and not options.relayout
    if kept:
        return patched(take, declared, trim=options.trim)
    return composed(take, options)
