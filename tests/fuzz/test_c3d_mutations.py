"""Mutated C3D files are read or refused, never crash, hang or swallow memory."""

from __future__ import annotations

import os
import random
import struct
import sys
from pathlib import Path

import numpy as np
import pytest
from mutations import Watch

from mocapstudio.formats import ReadOptions, WriteOptions
from mocapstudio.formats.c3d_read import read_c3d
from mocapstudio.formats.c3d_write import write_c3d
from mocapstudio.motion.errors import MocapError

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "formats"))
from c3d_bytes import DEC, INTEL, MIPS, Made

MUTATIONS = int(os.environ.get("MOCAPSTUDIO_MUTATIONS", "1000"))
SNIPPETS = [
    *(b"\x00\x00", b"\xff\xff", b"\xff\x7f", b"\x00\x80", b"\x01\x00", b"\xc0\x7f"),
    *(struct.pack("<f", v) for v in (np.nan, np.inf, -np.inf, 1e38, -1e-38, 0.0, -1.0)),
    *(b"POINT", b"LABELS", b"LABELS2", b"USED", b"SCALE", b"FRAMES", b"UNITS", b"EVENT"),
    *(b"mm  ", b"m   ", b"\xe9\xe9", b"*1", b":", b"A:", b"Angles"),
]


def base_files() -> list[bytes]:
    generator = np.random.default_rng(5)
    xyz = generator.uniform(-900, 900, (1, 6, 3)) + generator.normal(scale=9, size=(30, 6, 3))
    fourth = np.where(generator.random((30, 6)) < 0.1, -1, 3 << 8 | 4)
    labels = ["A:LHEE", "A:RHEE", "A:C7", "B:LHEE", "B:LHipAngles", "*5"]
    more: dict[str, dict[str, object]] = {
        "POINT": {"Y_SCREEN": "+Z", "ANGLES": ["B:LHipAngles"], "TYPE_GROUPS": [["ANGLES", "A"]]},
        "TRIAL": {"ACTUAL_START_FIELD": [7, 0], "ACTUAL_END_FIELD": [36, 0]},
        "SUBJECTS": {"USED": 2, "USES_PREFIXES": 1, "NAMES": ["A", "B"]},
        "EVENT": {"USED": 1, "LABELS": ["Foot Off"], "CONTEXTS": ["Left"], "TIMES": [[0.0, 0.2]]},
    }
    kinds = [(INTEL, -1.0, 0), (INTEL, 0.1, 3), (DEC, -1.0, 0), (MIPS, 0.1, 0)]
    return [
        Made(
            xyz, fourth, processor=processor, scale=scale, analog=analog, labels=labels,
            labels_each=4, first=7, header_events=[("RHS", 0.1)], more=more,
        ).data()
        for processor, scale, analog in kinds
    ]  # fmt: skip


def mutated(data: bytes, chance: random.Random) -> bytes:
    raw = bytearray(data)
    for _ in range(chance.choice([1, 1, 1, 2, 3, 8])):
        # Header and parameters, where most can go wrong, are a fourth of the bytes.
        where = chance.random()
        limit = 24 if where < 0.15 else 1100 if where < 0.6 else len(raw)
        at = chance.randrange(max(1, min(limit, len(raw))))
        kind = chance.randrange(6)
        if kind == 0:
            raw[at : at + 1] = bytes([chance.randrange(256)])
        elif kind == 1:
            snippet = chance.choice(SNIPPETS)
            raw[at : at + len(snippet)] = snippet
        elif kind == 2:
            del raw[at : at + chance.choice([1, 1, 2, 50, 512])]
        elif kind == 3:
            raw[at:at] = chance.choice(SNIPPETS)
        elif kind == 4:
            raw[at : at + 2] = struct.pack("<H", chance.choice([0, 1, 2, 255, 256, 32767, 65535]))
        elif chance.random() < 0.3:
            del raw[at:]
        if not raw:
            return b""
    return bytes(raw)


def _samples_at(raw: bytes) -> int:
    order = ">" if raw[515] == MIPS else "<"
    return 512 * (int(struct.unpack(f"{order}H", raw[16:18])[0]) - 1)


@pytest.mark.parametrize("lenient", [False, True])
def test_mutations_are_read_or_refused(lenient: bool) -> None:
    files = base_files()
    options = ReadOptions(lenient=lenient)
    path = Path("take.c3d")
    watch = Watch()
    for seed in range(MUTATIONS // 2):
        raw = mutated(files[seed % len(files)], random.Random(seed))
        try:
            with watch.file(seed):
                takes, report = read_c3d(path, raw, options)
        except MocapError as refused:
            assert str(refused).startswith(str(path)), f"seed {seed}"
            assert str(refused).isprintable(), f"seed {seed}"
            watch.refused(getattr(refused, "offset", None), _samples_at(files[seed % len(files)]))
            continue
        watch.accepted()
        for problem in report.problems:
            assert f"{problem.what}; {problem.done}".isprintable(), f"seed {seed}"
        for take in takes:
            assert not np.isinf(take.positions).any(), f"seed {seed}"
            assert take.positions.nbytes <= 8 * len(raw), f"seed {seed}"
            # Whatever was read can be written back as it stood, and anew.
            assert b"".join(write_c3d(take, [], WriteOptions())) == raw, f"seed {seed}"
            if seed % 5 == 0:
                assert len(b"".join(write_c3d(take, [], WriteOptions(unit=0.001)))) > 1024
    watch.judge(f"C3D, lenient {lenient}")
