"""Everything that the program ships beside its code is whole, and everything it names is there."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

from mocapstudio.motion.errors import FileError
from mocapstudio.resource_files import resource

ROOT = Path(__file__).resolve().parents[1]
ICONS = sorted((ROOT / "resources" / "icons").glob("*.svg"))


def test_resources_of_a_checkout_lie_beside_the_package() -> None:
    assert resource("icons") == ROOT / "resources" / "icons"
    assert resource("icons", "mocapstudio.svg").is_file()


def test_a_missing_resource_is_named() -> None:
    with pytest.raises(FileError, match=r"no-such\.svg"):
        resource("icons", "no-such.svg")


@pytest.mark.parametrize("path", ICONS, ids=lambda path: path.stem)
def test_icon_is_a_square_drawing(path: Path) -> None:
    drawing = ElementTree.parse(path).getroot()
    assert drawing.tag == "{http://www.w3.org/2000/svg}svg"
    left, top, width, height = map(float, drawing.attrib["viewBox"].split())
    assert (left, top) == (0, 0)
    assert width == height > 0
    assert len(list(drawing.iter())) > 1


def test_packages_of_debian_are_well_formed() -> None:
    text = resource("system", "debian-packages.txt").read_text()
    rows = [line.split() for line in text.splitlines() if not line.startswith("#")]
    assert rows
    assert all(len(row) == 2 for row in rows)
    libraries = [row[0] for row in rows]
    assert len(set(libraries)) == len(libraries)
    assert all(re.fullmatch(r"lib[\w.+-]+\.so\.\d+", library) for library in libraries)
    assert all(re.fullmatch(r"[a-z0-9][a-z0-9.+-]+", row[1]) for row in rows)
