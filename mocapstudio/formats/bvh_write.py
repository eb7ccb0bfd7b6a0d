"""BVH: from a take to a file's bytes, from its source text where it has one."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from mocapstudio.formats.bvh_compose import composed
from mocapstudio.formats.bvh_patch import patched
from mocapstudio.formats.options import WriteOptions
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.take import Take


def write_bvh(take: Take, declared: Sequence[Declared], options: WriteOptions) -> Iterator[bytes]:
    """Bytes of the take as BVH; `declared` counts where the source's text is kept.

    Raises
    ------
    MocapError
        If a sample changed without being declared.
    """
    kept = take.source is not None and take.source.format == "bvh" and not options.relayout
    if kept:
        return patched(take, declared, trim=options.trim)
    return composed(take, options)
