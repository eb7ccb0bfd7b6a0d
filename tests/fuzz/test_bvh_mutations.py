"""Mutated BVH files are read or refused, never crash, hang or swallow memory."""

from __future__ import annotations

import os
import random
from pathlib import Path

import numpy as np
import pytest
from mutations import Watch, mutated

from mocapstudio import formats
from mocapstudio.motion.errors import MocapError

MUTATIONS = int(os.environ.get("MOCAPSTUDIO_MUTATIONS", "1000"))
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


HEADER = 21
"""Line of MOTION in the file that is spoilt."""


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


@pytest.mark.parametrize("lenient", [False, True])
def test_mutations_are_read_or_refused(tmp_path: Path, lenient: bool) -> None:
    data = base_file()
    options = formats.ReadOptions(lenient=lenient)
    path, copy = tmp_path / "take.bvh", tmp_path / "copy.bvh"
    watch = Watch()
    for seed in range(MUTATIONS // 2):
        text = mutated(data, random.Random(seed), SNIPPETS, header=600)
        path.write_bytes(text)
        try:
            with watch.file(seed):
                takes, report = formats.read(path, options)
        except MocapError as refused:
            assert str(path) in str(refused), f"seed {seed}"
            assert "\n" not in str(refused), f"seed {seed}"
            watch.refused(getattr(refused, "line", None), HEADER)
            continue
        watch.accepted()
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
    watch.judge(f"BVH, lenient {lenient}")
