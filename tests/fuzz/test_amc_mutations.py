"""Mutated ASF and AMC files are read or refused, never crash, hang or swallow memory."""

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
    *(b"NaN", b"inf", b"-", b"1e999", b"-1e13", b"\x00", b"\xff\xfe", b"\r", b"\n", b"\t", b","),
    *(b":bonedata", b":hierarchy", b":DEGREES", b":RADIANS", b"begin", b"end", b"root", b"dof rx"),
    *(b"leg", b"limits (", b"1_0", b"9" * 400, b"1.2.3", b"0.0-7.5", b"\xc3\xa9", b" ", b"#"),
]
HEADERS = {"made.asf": 15, "made.amc": 2}
"""Lines before bones and before frames."""

SKELETON = b"""# made
:version 1.10
:name made
:units
  mass 1.0
  length 0.45
  angle deg
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name leg
    direction 0.3 -0.9 0
    length 7
    axis 0 0 20 XYZ
    dof rx ry rz
    limits (-160.0 20.0)
           (-70.0 70.0)
           (-60.0 70.0)
  end
  begin
    id 2
    name shin
    direction 0.3 -0.9 0
    length 7
    axis 0 0 20 XYZ
    dof rx
    limits (-10.0 170.0)
  end
:hierarchy
  begin
    root leg
    leg shin
  end
"""


def motion() -> bytes:
    numbers = np.random.default_rng(3).normal(scale=20, size=(30, 10))
    frames = [
        f"{n}\nroot {' '.join(f'{v:.5f}' for v in row[:6])}\n"
        f"leg {' '.join(f'{v:.5f}' for v in row[6:9])}\nshin {row[9]:.5f}\n"
        for n, row in enumerate(numbers, 1)
    ]
    return b":FULLY-SPECIFIED\n:DEGREES\n" + "".join(frames).encode()


@pytest.mark.parametrize("spoilt", ["made.asf", "made.amc"])
def test_mutations_are_read_or_refused(tmp_path: Path, spoilt: str) -> None:
    whole = {"made.asf": SKELETON, "made.amc": motion()}
    for name, data in whole.items():
        (tmp_path / name).write_bytes(data)
    watch = Watch()
    for seed in range(MUTATIONS // 2):
        lenient = seed % 2 == 1
        text = mutated(whole[spoilt], random.Random(seed), SNIPPETS, header=100)
        (tmp_path / spoilt).write_bytes(text)
        try:
            with watch.file(seed):
                takes, report = formats.read(
                    tmp_path / "made.amc", formats.ReadOptions(lenient=lenient)
                )
        except MocapError as refused:
            assert str(tmp_path) in str(refused), f"seed {seed}"
            assert "\n" not in str(refused), f"seed {seed}"
            watch.refused(getattr(refused, "line", None), HEADERS[spoilt])
            continue
        watch.accepted()
        assert report.format == "amc"
        for take in takes:
            assert np.isfinite(take.rotations).all(), f"seed {seed}"
            assert np.isfinite(take.translations).all(), f"seed {seed}"
    watch.judge(spoilt)
