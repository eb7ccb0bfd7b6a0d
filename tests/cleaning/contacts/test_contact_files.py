"""Contacts as JSON: round trip, other rates, and what is wrong with bad files."""

from __future__ import annotations

import json
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_takes import walking

from mocapstudio.cleaning.contacts.files import read_contacts, write_contacts
from mocapstudio.cleaning.contacts.json_places import element_lines
from mocapstudio.cleaning.contacts.model import (
    Contact,
    ContactPoint,
    Fixed,
    Floor,
    Following,
    Line,
)
from mocapstudio.motion.errors import FileError

TAKE = walking(2.0, 60)
PARTNER = replace(walking(2.0, 60, seed=1), name="partner")
POINTS = (
    ContactPoint("LeftFoot", "heel", np.array([0.01, -0.02, -0.03])),
    ContactPoint("RightHand", "palm", np.array([-0.07, 0.0, 0.0])),
)

metres = st.floats(-50, 50, allow_nan=False)
place = st.tuples(metres, metres, metres)
unit = st.sampled_from([(0.0, 1.0, 0.0), (0.6, 0.8, 0.0), (0.0, -0.6, 0.8)])
targets = st.one_of(
    st.builds(Fixed, place),
    st.builds(Floor, metres, unit),
    st.builds(Line, place, unit),
    st.builds(Following, st.just("partner"), st.sampled_from(["LeftHand", "Head"]), place),
)
contacts = st.builds(
    lambda start, length, point, target, sure, drawn: Contact(
        "", point.joint, point.point, start, start + length, target, sure, drawn
    ),
    st.integers(0, 100),
    st.integers(1, 20),
    st.sampled_from(POINTS),
    targets,
    st.floats(0, 1),
    st.booleans(),
)


@settings(max_examples=25)
@given(st.lists(contacts, max_size=4))
def test_what_is_written_is_read_again(
    tmp_path_factory: pytest.TempPathFactory, some: list[Contact]
) -> None:
    some = [replace(c, id=f"c{i}") for i, c in enumerate(some)]
    path = tmp_path_factory.getbasetemp() / "round.json"
    others = {"partner": PARTNER}
    write_contacts(path, TAKE, some, POINTS, slide={"before": 0.1, "after": None}, others=others)
    file = read_contacts(path, TAKE)
    assert file.contacts == tuple(some)
    for a, b in zip(file.points, POINTS, strict=True):
        assert a.key == b.key
        np.testing.assert_array_equal(a.offset, b.offset)
    assert json.loads(path.read_text())["slide"] == {"before": 0.1, "after": None}


PLAIN = {"joint": "LeftFoot", "point": "heel", "start": 3, "end": 9, "target": [0.1, 0.0, 2.0]}


def written(tmp_path: Path, content: object, name: str = "c.json") -> Path:
    path = tmp_path / name
    path.write_text(content if isinstance(content, str) else json.dumps(content))
    return path


def test_the_least_a_file_needs(tmp_path: Path) -> None:
    [one] = read_contacts(written(tmp_path, {"contacts": [PLAIN]}), TAKE).contacts
    assert (one.joint, one.point, one.start, one.end) == ("LeftFoot", "heel", 3, 9)
    assert one.target == Fixed((0.1, 0.0, 2.0))
    assert one.confidence == 1.0


def test_frames_are_converted_to_the_takes_rate(tmp_path: Path) -> None:
    path = written(tmp_path, {"fps": 30, "contacts": [{**PLAIN, "start": 30, "end": 60}]})
    [one] = read_contacts(path, TAKE).contacts
    assert (one.start, one.end) == (60, 120)
    ntsc = replace(TAKE, rate=Fraction(60000, 1001))
    path = written(tmp_path, {"fps": 59.94, "contacts": [PLAIN]})
    [one] = read_contacts(path, ntsc).contacts
    assert (one.start, one.end) == (3, 9)


def test_ids_become_unique(tmp_path: Path) -> None:
    twice = {"contacts": [{**PLAIN, "id": "a"}, {**PLAIN, "id": "a"}, PLAIN]}
    ids = [c.id for c in read_contacts(written(tmp_path, twice), TAKE).contacts]
    assert len(set(ids)) == 3
    assert ids[0] == "a"


@pytest.mark.parametrize(
    ("change", "cause"),
    [
        ({"joint": "Tail"}, "of joint Tail"),
        ({"joint": None}, 'no "joint"'),
        ({"point": "elbow"}, "none of heel, ball, toe, palm"),
        ({"point": "toe"}, "does not have"),
        ({"start": 9}, "frames 9:9"),
        ({"end": 121}, "frames 3:121"),
        ({"start": -1}, "frames -1:9"),
        ({"start": 2.5}, "no frame number"),
        ({"end": True}, "no frame number"),
        ({"end": None}, 'no "end"'),
        ({"end": 10**400}, "no frame number"),
        ({"target": [0, 0]}, "three numbers"),
        ({"target": [0, 0, "x"]}, "three numbers"),
        ({"target": [0, 0, 1e9]}, "three numbers"),
        ({"target": None}, 'no "target"'),
        ({"confidence": 1.5}, "outside 0..1"),
        ({"confidence": "high"}, "no number"),
        ({"kind": "wall"}, '"kind"'),
        ({"kind": "line"}, 'no "direction"'),
        ({"kind": "line", "direction": [0, 0, 0]}, "without length"),
        ({"kind": "following"}, 'no "performer"'),
        ({"id": 7}, '"id"'),
    ],
)
def test_a_bad_contact_is_named_with_its_line(tmp_path: Path, change: dict, cause: str) -> None:
    good, bad = json.dumps(PLAIN), json.dumps({**PLAIN, **change})
    path = written(tmp_path, '{"fps": 60,\n "contacts": [\n  ' + good + ",\n  " + bad + "]}")
    with pytest.raises(FileError, match="contact 1") as raised:
        read_contacts(path, TAKE, POINTS)
    assert raised.value.line == 4
    assert cause in str(raised.value)


@pytest.mark.parametrize(
    ("text", "line", "cause"),
    [
        ("", 1, "no JSON"),
        ('{"contacts": [\n{]}', 2, "no JSON"),
        ("[]", None, "holds no contacts"),
        ('{"contacts": {}}', None, "holds no contacts"),
        ('{"contacts": [7]}', 1, "no object"),
        ('{"contacts": [], "fps": 0}', None, "no frame rate"),
        ('{"contacts": [], "fps": NaN}', None, "no number"),
        ('{"contacts": [], "points": 3}', None, "no list"),
        ('{"contacts": [],\n"points": [{"joint": "Head"}]}', 2, 'no "offset"'),
        ("[" * 100_000, None, "nested"),
        ("9" * 10_000, None, "no JSON"),
    ],
)
def test_a_bad_file_is_one_error(tmp_path: Path, text: str, line: int | None, cause: str) -> None:
    with pytest.raises(FileError) as raised:
        read_contacts(written(tmp_path, text), TAKE)
    assert raised.value.line == line
    assert cause in str(raised.value)


def test_files_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="cannot be read"):
        read_contacts(tmp_path / "none.json", TAKE)
    (tmp_path / "bytes.json").write_bytes(b'{"contacts": ["\xff"]}')
    with pytest.raises(FileError, match="UTF-8"):
        read_contacts(tmp_path / "bytes.json", TAKE)


@given(
    st.recursive(
        st.none() | st.integers() | st.text(max_size=5),
        lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3), inner),
        max_leaves=4,
    ),
    st.lists(st.dictionaries(st.text(max_size=3), st.integers(), max_size=2), max_size=4),
    st.sampled_from([None, 1, 2]),
)
@settings(max_examples=15)
def test_lines_of_elements(before: object, elements: list, indent: int | None) -> None:
    content = {"a": before, "contacts": elements, "z": before}
    text = json.dumps(content, indent=indent)
    lines = element_lines(text, "contacts")
    assert len(lines) == len(elements)
    decoder = json.JSONDecoder()
    for line, element in zip(lines, elements, strict=True):
        # The element begins on that line.
        rest = "\n".join(text.split("\n")[line - 1 :])
        starts = [i for i, c in enumerate(rest.split("\n")[0]) if c == "{"]
        assert any(_decoded(decoder, rest, i) == element for i in starts)


def _decoded(decoder: json.JSONDecoder, text: str, at: int) -> object:
    try:
        return decoder.raw_decode(text, at)[0]
    except json.JSONDecodeError:
        return None
