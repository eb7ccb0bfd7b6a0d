from __future__ import annotations

import base64
import json
import re
import struct
import zlib
from html.parser import HTMLParser

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from mocapstudio.cleaning.model import Kind
from mocapstudio.cli.evaluate import evaluate
from mocapstudio.evaluation.cases import USUAL, Case
from mocapstudio.evaluation.detection_benchmark import DetectionScores, evaluate_detector
from mocapstudio.evaluation.experiments import (
    METHODS,
    PAPER,
    REACH,
    Experiment,
    Section,
    experiments,
)
from mocapstudio.evaluation.injection import KINDS, corrupt
from mocapstudio.evaluation.map_detector import detector_of
from mocapstudio.evaluation.page import _png, curves_html, page, table_html
from mocapstudio.evaluation.speed_benchmark import SpeedRow, best_of, growth, lasting
from mocapstudio.evaluation.tables import detection_tables
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.errors import MocapError


@pytest.fixture(scope="module")
def section(make_take) -> Section:
    take = make_take(20.0)
    dirty, truths = corrupt(take, np.random.default_rng(0), 20.0)
    case = Case(dirty, take, truths, ())
    rng = np.random.default_rng(0)
    values = np.clip(0.6 * case.mask() + 0.3 + 0.1 * rng.standard_normal(case.mask().shape), 0, 1)
    row = evaluate_detector(detector_of(lambda t, c: (case.rows, values)), [case], "some <method>")
    nothing = evaluate_detector(lambda t, c: [], [case], "nothing")
    return Section(
        Experiment("locomotion, small", "locomotion", "small", USUAL, METHODS),
        (row, nothing), len(truths), ("swinging",),
    )  # fmt: skip


class Balanced(HTMLParser):
    """Fails where tags are not closed in order."""

    OPEN = frozenset({"meta", "br", "img", "path", "circle", "polyline"})

    def __init__(self) -> None:
        super().__init__()
        self.stack: list[str] = []
        self.cells = 0

    def handle_starttag(self, tag, attrs) -> None:
        self.cells += tag == "td"
        if tag not in self.OPEN:
            self.stack.append(tag)

    def handle_endtag(self, tag) -> None:
        if tag not in self.OPEN:
            assert self.stack.pop() == tag


def test_the_page_is_whole_and_stands_alone(section) -> None:
    tables = detection_tables([section])
    text = page("Detection", "lead", [curves_html([section]), *map(table_html, tables)], "foot")
    parser = Balanced()
    parser.feed(text)
    assert parser.stack in ([], ["html"])
    assert parser.cells == sum(len(row) for table in tables for row in table.rows)
    assert "some &lt;method&gt;" in text
    assert not re.search(r"(src|href)=\"(?!data:)", text)


def test_the_curve_is_drawn_through_recall_and_precision(section) -> None:
    points = re.findall(r'polyline points="([^"]+)"', curves_html([section]))[0].split()
    words = [w for _, (w, _) in sorted(section.rows[0].scores.curve.items()) if w.hits + w.false]
    assert len(points) == len(words)
    for point, count in zip(points, words, strict=True):
        x, y = map(float, point.split(","))
        assert x == pytest.approx(40 + 270 * count.recall, abs=0.06)
        assert y == pytest.approx(24 + 270 * (1 - count.precision), abs=0.06)


def test_the_table_shows_the_papers_figures_beside_ours(section) -> None:
    (table,) = detection_tables([section])
    rows = {row[0]: row for row in table.rows}
    assert rows["paper 1"][1:3] == ("0.985", "0.919")
    assert rows["to reach"][1:3] == ("0.990", "0.980")
    assert rows["nothing"][1] == "0.000"
    assert rows["nothing"][2] == ""
    assert all(len(row) == len(table.head) for row in table.rows)


def test_the_plan_holds_every_row_of_the_main_table_and_every_kind() -> None:
    plan = experiments(("locomotion", "varied", "own rate"), ("local", "small", "large"))
    main = {(e.corpus, e.context) for e in plan if e.is_main}
    assert main == set(PAPER) == set(REACH)
    for corpus in ("locomotion", "varied"):
        alone = {e.conditions.kinds for e in plan if e.corpus == corpus and e.is_of_one_kind}
        assert alone == {(kind,) for kind in KINDS}
    assert {e.context for e in plan if not e.is_main} == {"large"}
    own = [e for e in plan if e.corpus == "own rate"]
    assert len(own) == 1
    assert Kind.POP in own[0].conditions.kinds
    assert len(experiments(("own",), ("local",), brief=True)) == 1


def test_a_map_becomes_a_png_of_its_size() -> None:
    values = np.array([[0.0, 1.0], [0.5, 0.25], [1.0, 2.0]])
    raw = base64.b64decode(_png(values).split(",")[1])
    assert raw.startswith(b"\x89PNG\r\n\x1a\n")
    assert struct.unpack(">II", raw[16:24]) == (3, 2)
    start = raw.index(b"IDAT")
    length = struct.unpack(">I", raw[start - 4 : start])[0]
    pixels = np.frombuffer(zlib.decompress(raw[start + 4 : start + 4 + length]), dtype=np.uint8)
    lines = pixels.reshape(2, 1 + 9)
    assert (lines[:, 0] == 0).all()
    assert lines[0, 1:4].tolist() == [0, 0, 4]
    assert lines[1, 1:4].tolist() == [252, 255, 164]


def test_scores_are_plain_json(section) -> None:
    record = json.loads(json.dumps(section.to_json()))
    assert record["rows"][0]["word"]["hits"] == section.rows[0].scores.words.hits
    assert record["paper"] == [0.985, 0.919]
    assert isinstance(section.rows[0], DetectionScores)


def test_takes_are_made_to_last(make_take) -> None:
    takes = [make_take(3.0, seed=0), make_take(2.0, seed=1)]
    assert lasting(takes, 11.0).frames == 330
    calls: list[int] = []
    assert min(best_of(lambda: calls.append(1), 3)) >= 0
    assert len(calls) == 4


def test_the_power_of_growth_is_found() -> None:
    rows = [SpeedRow("", 1.0, 0.3 * size**1.5, series="source", size=size) for size in (1, 2, 8)]
    assert growth([*rows, SpeedRow("else", 1.0, 1.0)]) == {"source": pytest.approx(1.5)}


def run(*words: str):
    app = typer.Typer()
    app.command()(evaluate)
    return CliRunner().invoke(app, list(words))


def test_detection_from_the_command_line(data, tmp_path) -> None:
    folder = str(data / "bandai_1_styles_bvh_CCBYNC4")
    out, page_path = tmp_path / "out.json", tmp_path / "out.html"
    result = run(
        "detection", "--data", folder, "--brief", "--context", "small", "--limit", "2",
        "--seed", "3", "--json", str(out), "--html", str(page_path),
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    record = json.loads(out.read_text())
    (section,) = record["detection"]
    assert section["title"] == "varied, small"
    assert {row["name"] for row in section["rows"]} >= {"ours", "literal mode", "(c) both"}
    assert len(section["takes"]) == 2
    halves = record["split"]["varied"]
    assert not set(halves["development"]) & set(halves["test"])
    assert record["seed"] == 3
    assert "<svg" in page_path.read_text()


def test_a_hand_cleaned_version_is_scored_with_both_maps(data, tmp_path) -> None:
    from mocapstudio import formats

    source = data / "bandai_1_styles_bvh_CCBYNC4"
    names = ["dataset-1_walk_normal_001.bvh", "dataset-1_walk_active_001.bvh"]
    (clean,), _ = formats.read(source / names[0])
    dirty, truths = corrupt(clean, np.random.default_rng(0), 30.0, [Kind.OFFSET, Kind.FLIP])
    declared = [Declared(joint, t.start, t.end) for t in truths for joint in t.joints]
    folder = tmp_path / "takes"
    folder.mkdir()
    formats.write(dirty, folder / names[0], declared=declared)
    (folder / names[1]).write_bytes((source / names[1]).read_bytes())
    out, page_path = tmp_path / "out.json", tmp_path / "out.html"
    result = run(
        "detection", "--data", str(folder), "--cleaned", str(source / names[0]),
        "--json", str(out), "--html", str(page_path),
    )  # fmt: skip
    assert result.exit_code == 0, (result.output, result.exception)
    row = json.loads(out.read_text())["detection"][0]["rows"][0]
    assert row["events"] >= 2
    assert page_path.read_text().count('class="map"') == 2


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("speed", "--cleaned", "a.bvh"), "speed has no cleaned take"),
        (("repair", "--truth", "a.json"), "use --cleaned"),
        (("detection", "--truth", "a.json", "--cleaned", "b.bvh"), "exclude each other"),
    ],
)
def test_what_makes_no_sense_is_refused(tmp_path, words, message) -> None:
    result = run(words[0], "--data", str(tmp_path), *words[1:])
    assert isinstance(result.exception, MocapError)
    assert message in str(result.exception)
