"""Mutated TRC files and tables are read or refused, never crash, hang or swallow memory."""

from __future__ import annotations

import os
import random
import tracemalloc
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from mutations import Watch, mutated

from mocapstudio import formats
from mocapstudio.formats.registry import FORMATS
from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.markers import MarkerTake

MUTATIONS = int(os.environ.get("MOCAPSTUDIO_MUTATIONS", "1000"))
"""Of each reader; the whole run is 100,000."""
LARGEST = 200 << 20
LABELS = ("LFHD", "RFHD", "C7", "LTOE", "LHEE")
FRAMES = 16
SNIPPETS = [
    *(b"NaN", b"inf", b"-", b"1e999", b"1e200", b"-1e13", b"1_0", b"1.2.3", b"1,5", b"9" * 400),
    *(b"\x00", b"\xff\xfe", b"\xef\xbb\xbf", b"\xe9", b"\r", b"\n", b"\r\n", b"\t", b"\t\t\t"),
    *(b",", b";", b'"', b" ", b"0.000", b"0\t0\t0", b"1000000000", b"-1", b"1e-300"),
    *(b"Frame#", b"Time", b"DataRate", b"NumFrames", b"Units", b"mm", b"furlong", b"LFHD"),
    *(b"X1", b"Y", b"LFHD X", b"Hips.Dx", b"Rotation", b"FREQUENCY\t0", b"DATA_INCLUDED\t2D"),
]


def cells(seed: int = 5) -> np.ndarray:
    return np.random.default_rng(seed).normal(800, 300, (FRAMES, 3 * len(LABELS)))


def trc() -> bytes:
    keys = "DataRate CameraRate NumFrames NumMarkers Units OrigDataRate OrigDataStartFrame"
    rows = [
        f"{i}\t{i / 100:.3f}\t" + "\t".join(f"{v:.3f}" for v in row) + "\n"
        for i, row in enumerate(cells(), 1)
    ]
    head = [
        "PathFileType\t4\t(X/Y/Z)\ttake.trc\n",
        f"{keys} OrigNumFrames\n".replace(" ", "\t"),
        f"100.00\t100.00\t{FRAMES}\t{len(LABELS)}\tmm\t100.00\t1\t{FRAMES}\n",
        "Frame#\tTime\t" + "".join(f"{label}\t\t\t" for label in LABELS) + "\n",
        "\t\t" + "\t".join(f"{a}{i}" for i in range(1, 6) for a in "XYZ") + "\n\n",
    ]
    return "".join([*head, *rows]).encode()


def tsv() -> bytes:
    names = "\t".join(f"{label} {axis}" for label in LABELS for axis in "XYZ")
    head = (
        f"NO_OF_FRAMES\t{FRAMES}\nNO_OF_MARKERS\t{len(LABELS)}\nFREQUENCY\t100\n"
        f"DATA_INCLUDED\t3D\nMARKER_NAMES\t{chr(9).join(LABELS)}\nFrame\tTime\t{names}\n"
    )
    rows = (
        f"{i}\t{i / 100:.5f}\t" + "\t".join(f"{v:.3f}" for v in row) + "\n"
        for i, row in enumerate(cells(), 1)
    )
    return (head + "".join(rows)).encode()


def csv() -> bytes:
    names = ",".join(f"{label}.{q}{axis}" for label in LABELS for q in "DR" for axis in "xyz")
    turns = cells(6)
    rows = (
        f"{i / 60:.6f}," + ",".join(f"{v:.4f}" for p in zip(*halves, strict=True) for v in p) + "\n"
        for i, halves in enumerate(zip(cells(), turns, strict=True))
    )
    return f"Time,{names}\n{''.join(rows)}".encode()


BASES = {".trc": trc(), ".tsv": tsv(), ".csv": csv()}
HEADERS = {".trc": 6, ".tsv": 6, ".csv": 1}
"""Lines before the rows."""


@pytest.mark.parametrize("suffix", BASES)
def test_mutations_are_read_or_refused(suffix: str) -> None:
    path = Path(f"take{suffix}")
    form = next(one for one in FORMATS if suffix in one.suffixes)
    assert form.write_markers is not None
    watch = Watch()
    for seed in range(MUTATIONS):
        chance = random.Random(seed)
        text = mutated(BASES[suffix], chance, SNIPPETS, header=400)
        rate = Fraction(50) if chance.random() < 0.2 else None
        options = formats.ReadOptions(lenient=chance.random() < 0.5, fps=rate)
        try:
            with watch.file(seed):
                [take], _ = form.read(path, text, options)
        except MocapError as refused:
            assert str(path) in str(refused), f"seed {seed}"
            assert "\n" not in str(refused), f"seed {seed}"
            watch.refused(getattr(refused, "line", None), HEADERS[suffix])
            continue
        watch.accepted()
        assert isinstance(take, MarkerTake), f"seed {seed}"
        seen = ~take.missing
        assert np.isfinite(take.positions[seen]).all(), f"seed {seed}"
        # Whatever was read can be written back as it stood, but for rows that were moved in time.
        if take.source is not None and take.source.record is not None and rate is None:
            pieces = form.write_markers(take, (), formats.WriteOptions())
            assert b"".join(pieces) == text, f"seed {seed}"
    watch.judge(suffix)


def test_memory_is_bounded_whatever_the_head_claims(tmp_path: Path) -> None:
    path = tmp_path / "take.trc"
    for old, new in (
        (b"\t16\t5\t", b"\t999999999\t999999999\t"),
        (b"\n16\t0.160", b"\n16\t99999999.0"),
        (b"\n16\t0.160", b"\n999999999\t0.160"),
    ):
        text = BASES[".trc"].replace(old, new)
        assert text != BASES[".trc"]
        path.write_bytes(text)
        tracemalloc.start()
        try:
            formats.read_any(path)
            assert tracemalloc.get_traced_memory()[1] < LARGEST
        finally:
            tracemalloc.stop()
