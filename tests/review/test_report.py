from __future__ import annotations

import base64
import re
import struct
import zlib
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from review_pieces import analyse, document_with, flag, read_bvh, small_take, write_bvh

from mocapstudio.motion.errors import FileError
from mocapstudio.review.document import Document
from mocapstudio.review.report import report, write_report
from mocapstudio.review.report_map import png, pooled

A, B, C, D = (
    flag("Spine", 10, 20, 0.9),
    flag("root position", 40, 50, 0.7),
    flag("Hips", 80, 95, 0.5),
    flag("LeftLeg", 0, 9, 0.3),
)
_VOID = {"meta", "link", "br", "img", "hr"}


class Outline(HTMLParser):
    """Checks that elements nest, and gathers the rows of tables."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.rows: list[list[str]] = []
        self.rects: list[str] = []
        self.references: list[str] = []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attributes) -> None:
        values = dict(attributes)
        self.references += [values[k] for k in ("src", "href") if k in values]
        if tag not in _VOID:
            self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th"):
            self.rows[-1].append("")
        elif tag == "rect":
            self.rects.append(values["class"])

    def handle_startendtag(self, tag, attributes) -> None:
        self.handle_starttag(tag, attributes)
        self.open.pop()

    def handle_endtag(self, tag) -> None:
        assert self.open.pop() == tag

    def handle_data(self, text) -> None:
        if "td" in self.open or "th" in self.open:
            self.rows[-1][-1] += text


@pytest.fixture
def document() -> Document:
    document = document_with(A, B, C, D)
    document.accept([A.id, B.id])
    document.reject(C.id)
    document.protect([], 100, 110)
    return document


def test_every_flag_decision_and_change_is_told(document: Document) -> None:
    outline = Outline(report(document))
    found = [row for row in outline.rows if len(row) == 9][1:]
    assert [row[:7] for row in found] == [
        ["1", "Spine", "0.33", "10–19", "spike", "0.90", "accepted"],
        ["2", "root position", "1.33", "40–49", "spike", "0.70", "accepted"],
        ["3", "Hips", "2.67", "80–94", "spike", "0.50", "rejected"],
        ["4", "LeftLeg", "0.00", "0–8", "spike", "0.30", "open"],
    ]
    assert [row[7] for row in found] == ["ana", "ana", "ana", ""]
    changed = [row for row in outline.rows if len(row) == 7][1:]
    assert [row[:3] for row in changed] == [
        ["Spine", "0.33", "10–19"],
        ["root position", "1.33", "40–49"],
    ]
    protected = [row for row in outline.rows if len(row) == 5][1:]
    assert protected[0][:3] == ["all joints", "3.33", "100–109"]
    shapes = [one for one in outline.rects if one.startswith("flag")]
    assert sorted(shapes) == ["flag accepted", "flag accepted", "flag open", "flag rejected"]
    assert outline.rects.count("edit") == 2


def test_frames_are_numbered_as_in_the_file() -> None:
    document = Document("ana")
    document.open_take(replace(small_take(), first_frame=100))
    analyse(document, (A, flag("Hips", 3, 4)))
    found = [row[3] for row in Outline(report(document)).rows if len(row) == 9][1:]
    assert found == ["110–119", "103"]


def test_nothing_is_fetched_and_every_name_is_escaped(tmp_path: Path) -> None:
    evil = "<script>alert(1)</script>'\"&"
    take = small_take(evil)
    names = tuple(f"{name}{evil}" for name in take.skeleton.names)
    document = Document(evil)
    document.open_take(replace(take, skeleton=replace(take.skeleton, names=names)))
    one = replace(A, joint=names[1], joints=(names[1],), id=evil)
    analyse(document, (one,), evil)
    document.accept(evil)
    document.set_context([evil])
    document.protect([names[1]], 0, 5)
    text = report(document)
    outline = Outline(text)
    assert "<script" not in text
    assert all(reference.startswith("data:") for reference in outline.references)
    assert "http" not in re.sub(r"http-equiv", "", text)
    assert any(evil in cell for row in outline.rows for cell in row)


def test_an_empty_sitting_has_a_report() -> None:
    Outline(report(Document("ana")))
    bare = Document("ana")
    bare.open_take(small_take())
    text = report(bare)
    Outline(text)
    assert "Nothing was flagged." in text


def test_partners_are_left_out_unless_there_is_something_to_tell(document: Document) -> None:
    partner = document.open_take(small_take("partner", seed=3), partner=True)
    assert ">partner<" not in report(document)
    document.set_active(partner)
    analyse(document, (C,), partner)
    assert ">partner<" in report(document)


def test_no_input_is_overwritten(tmp_path: Path) -> None:
    document = Document("ana")
    document.open_take(read_bvh(write_bvh(tmp_path / "walk.bvh", small_take())))
    with pytest.raises(FileError, match="is an input"):
        write_report(document, tmp_path / "walk.bvh")
    write_report(document, tmp_path / "report.html")
    assert (tmp_path / "report.html").read_text(encoding="utf-8").startswith("<!doctype html>")


def test_the_map_is_a_picture_of_the_digression(document: Document) -> None:
    mapped = document.state.analysis.map
    text = report(document)
    picture = base64.b64decode(re.search(r"data:image/png;base64,([^']+)'", text)[1])
    pixels = _decoded(picture)
    assert pixels.shape == (len(mapped.rows), 120, 4)
    np.testing.assert_allclose(pixels[..., 3], mapped.values.T * 255, atol=0.51)


def test_pooling_keeps_the_highest_value_of_each_column() -> None:
    values = np.random.default_rng(0).random((5000, 3)).astype(np.float32)
    small = pooled(values, 1200)
    assert small.shape == (1200, 3)
    assert small.max() == values.max()
    assert (small >= 0.2).mean() > (values >= 0.2).mean()


def _decoded(data: bytes) -> np.ndarray:
    assert data.startswith(b"\x89PNG\r\n\x1a\n")
    at, chunks = 8, {}
    while at < len(data):
        (length,) = struct.unpack(">I", data[at : at + 4])
        name, body = data[at + 4 : at + 8], data[at + 8 : at + 8 + length]
        assert zlib.crc32(name + body) == struct.unpack(">I", data[at + 8 + length :][:4])[0]
        chunks[name] = body
        at += 12 + length
    width, height, *rest = struct.unpack(">IIBBBBB", chunks[b"IHDR"])
    assert rest == [8, 6, 0, 0, 0]
    lines = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), dtype=np.uint8)
    lines = lines.reshape(height, 1 + width * 4)
    assert (lines[:, 0] == 0).all()
    return lines[:, 1:].reshape(height, width, 4)


def test_png_holds_the_pixels_it_was_given() -> None:
    pixels = np.random.default_rng(0).integers(0, 256, (7, 11, 4)).astype(np.uint8)
    assert np.array_equal(_decoded(png(pixels)), pixels)
