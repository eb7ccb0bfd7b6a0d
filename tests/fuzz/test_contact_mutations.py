"""Spoilt files of contacts are read or refused with a line, and what is read can be written."""

from __future__ import annotations

import json
import os
import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from made_takes import walking
from mutations import mutated

from mocapstudio.cleaning.contacts.files import read_contacts, write_contacts
from mocapstudio.cleaning.contacts.model import (
    Contact,
    ContactPoint,
    Fixed,
    Floor,
    Following,
    Line,
)
from mocapstudio.motion.errors import FileError, MocapError

MUTATIONS = int(os.environ.get("MOCAPSTUDIO_MUTATIONS", "1000"))
TAKE = walking(2.0, 60)
POINTS = (
    ContactPoint("LeftFoot", "heel", np.array([0.01, -0.02, -0.03])),
    ContactPoint("RightHand", "palm", np.array([-0.07, 0.0, 0.0])),
)
CONTACTS = (
    Contact("a", "LeftFoot", "heel", 3, 20, Floor(0.1)),
    Contact("b", "RightHand", "palm", 5, 9, Following("partner", "LeftHand")),
    Contact("c", "LeftFoot", "heel", 30, 40, Line((0.0, 0.0, 0.0), (0.0, 0.0, 1.0))),
    Contact("d", "RightHand", "palm", 50, 60, Fixed((0.0, 1.0, 2.0))),
)
SNIPPETS = (
    b"[",
    b"]",
    b"{",
    b"}",
    b",",
    b'"',
    b"-",
    b"1e99",
    b"9" * 30,
    b"\\ud800",
    b"NaN",
    b"null",
)
JUNK: tuple[Any, ...] = (
    None, True, 0, -1, 2.5, 1e308, 10**400, "", "x", "\ud800", [], {}, [1, 2], [1, 2, 3],
    [None] * 3, ["a", "b", "c"], {"a": 1}, float("nan"), float("inf"), [[[]]], "heel", "floor",
    "line", "following", [0, 0, 0], [1e-320, 0, 0], [1e300] * 3,
)  # fmt: skip


def spoilt(content: Any, chance: random.Random) -> Any:
    """Put junk somewhere into a tree of JSON, or leave something out."""
    node = content
    while True:
        key = chance.choice(list(node)) if isinstance(node, dict) else chance.randrange(len(node))
        below = node[key]
        if not isinstance(below, dict | list) or not below or chance.random() < 0.3:
            break
        node = below
    if chance.random() < 0.25:
        del node[key]
    else:
        node[key] = chance.choice(JUNK)
    return content


@pytest.mark.parametrize("kind", ["tree", "bytes"])
def test_spoilt_contacts_are_read_or_refused(tmp_path: Path, kind: str) -> None:
    file, again = tmp_path / "contacts.json", tmp_path / "again.json"
    write_contacts(file, TAKE, CONTACTS, POINTS, others={"partner": TAKE})
    whole = file.read_bytes()
    read = 0
    for seed in range(MUTATIONS // 2):
        chance = random.Random(seed)
        if kind == "tree":
            file.write_text(json.dumps(spoilt(json.loads(whole), chance)))
        else:
            file.write_bytes(mutated(whole, chance, SNIPPETS, header=200))
        try:
            found = read_contacts(file, TAKE, POINTS)
        except FileError as refusal:
            assert "\n" not in str(refusal)
            assert str(refusal).startswith(str(file))
            continue
        read += 1
        try:
            points = {point.key: point for point in (*POINTS, *found.points)}
            write_contacts(again, TAKE, found.contacts, tuple(points.values()),
                           others={"partner": TAKE})  # fmt: skip
        except MocapError:
            # A partner or a joint of the partner that there is not.
            continue
        assert len(read_contacts(again, TAKE, POINTS).contacts) == len(found.contacts)
    assert 0.03 * MUTATIONS / 2 < read < 0.9 * MUTATIONS / 2
