"""The README tells the truth: its links lead somewhere, its commands and keys exist."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from mocapstudio.cli.app import COMMANDS
from mocapstudio.gui.commands import MENUS

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
LINKS = re.findall(r"!?\[[^\]]*\]\(([^)\s]+)\)|<img[^>]* src=\"([^\"]+)\"", README)


@pytest.mark.parametrize("target", sorted({a or b for a, b in LINKS}))
def test_link_leads_somewhere(target: str) -> None:
    if target.startswith("#"):
        titles = re.findall(r"^#+ (.*)$", README, re.MULTILINE)
        anchors = {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}
        assert target[1:] in anchors
    elif not target.startswith("https://"):
        assert (ROOT / target).exists()


def test_every_command_is_in_the_table() -> None:
    assert set(re.findall(r"^\| `([a-z-]+)[` ]", README, re.MULTILINE)) >= set(COMMANDS)


def test_commands_of_the_first_screen_are_one_line_each() -> None:
    block = re.search(r"```sh\n(.*?)```", README, re.DOTALL)
    assert block
    lines = [line for line in block[1].splitlines() if line and not line.startswith("#")]
    assert len(lines) == 2
    assert all(line.startswith("bash .ci/setup") for line in lines)


def test_every_folder_named_exists() -> None:
    for name in re.findall(r"^\| `([a-z]+)/` \|", README, re.MULTILINE):
        assert (ROOT / "mocapstudio" / name).is_dir(), name


def test_files_named_in_backticks_exist() -> None:
    for name in re.findall(r"`((?:[a-z_]+/)+[a-z_]+\.py)`", README):
        assert (ROOT / "mocapstudio" / name).is_file() or (ROOT / name).is_file(), name


def test_keys_are_those_of_the_desk() -> None:
    rows = re.findall(r"^\| (`.*)\|$", README.split("| key | does |")[1].split("\n\n")[0], re.M)
    cells = [cell.strip() for row in rows for cell in row.split("|")]
    named = {key for cell in cells[::2] for key in re.findall(r"`([^`]+)`", cell)}
    known = {key for menu in MENUS.values() for command in menu for key in command.keys}
    assert len(named) > 20
    assert named <= known
