"""FBX: from a take to a file's bytes, by way of Blender."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from fractions import Fraction
from pathlib import Path

from mocapstudio.formats.bvh_compose import composed
from mocapstudio.formats.fbx_blender import run_blender
from mocapstudio.formats.options import WriteOptions
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import ParameterError
from mocapstudio.motion.take import Take


def write_fbx(take: Take, declared: Sequence[Declared], options: WriteOptions) -> Iterator[bytes]:
    """Bytes of the take as binary FBX: bones under the joints' names, a key in every frame.

    Raises
    ------
    MocapError
        If there is no Blender, it fails, or another unit or up axis is asked for than Blender
        states in the file.
    """
    if options.unit not in (None, 1.0) or options.up not in (None, "y"):
        raise ParameterError("FBX is written with Y up, and states its unit itself")
    layout = WriteOptions(order=options.order, channels=6, unit=1.0, up="y", trim=options.trim)
    with tempfile.TemporaryDirectory(prefix="mocapstudio-fbx-") as folder:
        source, target = Path(folder) / "take.bvh", Path(folder) / "take.fbx"
        with source.open("wb") as file:
            file.writelines(composed(take, layout))
        fps, base = _scene_rate(take.rate)
        run_blender("write", source, target, str(fps), repr(base))
        yield target.read_bytes()


def _scene_rate(rate: Fraction) -> tuple[int, float]:
    """Blender's whole frames a second, and what they are divided by."""
    whole = max(1, round(rate))
    return whole, float(whole / rate)
