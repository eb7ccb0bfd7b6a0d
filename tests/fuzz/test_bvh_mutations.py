"""Mutated BVH files are read or refused, never crash, hang or swallow memory."""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pytest

from mocapstudio import formats
from mocapstudio.motion.errors import MocapError

SEEDS = 400
SNIPPETS = [
    *(
        b"NaN",
        b"inf",
        b"-",
        b"1e999",
        b"1e200",
        b"-1e13",
        b"{",
        b"}",
        b"\x00",
        b"\xff\xfe",
        b"\r",
        b"\n",
        b"\t",
        b",",
    ),
    *(b"MOTION", b"HIERARCHY", b"ROOT", b"JOINT x", b"End Site", b"OFFSET", b"CHANNELS 3"),
    *(b"Frames: 1000000000", b"Frames: -1", b"Frame Time: 0", b"Frame Time: 1e-300", b"1_0"),
    *(b"CHANNELS 99999999999", b"Xrotation", b"9" * 400, b"1.2.3", b"0.0-7.5", b"\xc3\xa9", b" "),
]


def base_file() -> bytes:
    generator = np.random.default_rng(7)
    rows = generator.normal(scale=30, size=(40, 15))
    header = b"""HIERARCHY
ROOT Hips
{
  OFFSET 0 90 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT LeftLeg
  {
    OFFSET 10 -40 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 -40 0
    }
  }
  JOINT Chest
  {
    OFFSET 0 30 0
    CHANNELS 6 Xposition Yposition Zposition Yrotation Xrotation Zrotation
  }
}
MOTION
Frames: 40
Frame Time: 0.0333333
"""
    return header + b"".join(b" ".join(b"%.6f" % v for v in row) + b"\n" for row in rows)


def mutated(data: bytes, chance: random.Random) -> bytes:
    text = bytearray(data)
    for _ in range(chance.choice([1, 1, 1, 2, 3, 8])):
        # A third of the changes land in the header, whose share of the bytes is a tenth.
        limit = 600 if chance.random() < 0.35 else len(text)
        at = chance.randrange(max(1, min(limit, len(text))))
        kind = chance.randrange(7)
        if kind == 0:
            text[at : at + 1] = bytes([chance.randrange(256)])
        elif kind == 1:
            del text[at : at + chance.choice([1, 1, 5, 50])]
        elif kind == 2:
            text[at:at] = chance.choice(SNIPPETS)
        elif kind == 3:
            del text[at:]
        elif kind == 4:
            end = at + chance.choice([1, 20, 200])
            text[at:at] = text[at:end]
        elif kind == 5:
            words = bytes(text).split()
            word = chance.choice(words) if words else b"0"
            text = bytearray(bytes(text).replace(word, chance.choice(SNIPPETS), 1))
        else:
            lines = bytes(text).splitlines(keepends=True)
            chance.shuffle(lines) if chance.random() < 0.1 else lines.pop(
                chance.randrange(len(lines))
            )
            text = bytearray(b"".join(lines))
        if not text:
            return b""
    return bytes(text)


@pytest.mark.parametrize("lenient", [False, True])
def test_mutations_are_read_or_refused(tmp_path: Path, lenient: bool) -> None:
    data = base_file()
    options = formats.ReadOptions(lenient=lenient)
    path, copy = tmp_path / "take.bvh", tmp_path / "copy.bvh"
    read = 0
    for seed in range(SEEDS):
        text = mutated(data, random.Random(seed))
        path.write_bytes(text)
        try:
            takes, report = formats.read(path, options)
        except MocapError as refused:
            assert str(path) in str(refused), f"seed {seed}"
            assert "\n" not in str(refused), f"seed {seed}"
            continue
        read += 1
        assert report.format == "bvh"
        for take in takes:
            assert np.isfinite(take.rotations).all(), f"seed {seed}"
            assert np.isfinite(take.translations).all(), f"seed {seed}"
            np.testing.assert_allclose(
                np.linalg.norm(take.rotations, axis=-1), 1.0, atol=1e-9, err_msg=f"seed {seed}"
            )
            # Whatever was read can be written back as it stood.
            formats.write(take, copy)
            assert copy.read_bytes() == text, f"seed {seed}"
    assert SEEDS // 20 < read < SEEDS, "the mutations are too hard or too mild to tell anything"
