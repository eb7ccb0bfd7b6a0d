from __future__ import annotations

import os
import stat
from pathlib import Path

from mocapstudio.cli.kernel_cache import VARIABLE, is_writable, place_kernel_cache


def test_the_users_own_cache(monkeypatch, tmp_path: Path) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    folder = place_kernel_cache()
    assert tmp_path in folder.parents
    assert os.environ[VARIABLE] == str(folder)
    assert is_writable(folder)


def test_a_private_temporary_folder_where_there_is_none(monkeypatch, tmp_path: Path) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    in_the_way = tmp_path / "a file"
    in_the_way.write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(in_the_way))
    folder = place_kernel_cache()
    assert is_writable(folder)
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert place_kernel_cache() == folder
    folder.rmdir()


def test_what_the_environment_says_stands(monkeypatch, tmp_path: Path) -> None:
    monkeypatch.setenv(VARIABLE, str(tmp_path / "mine"))
    assert place_kernel_cache() == tmp_path / "mine"


def test_commands_run_where_nothing_can_be_kept(mocapstudio, broken: Path, tmp_path: Path) -> None:
    in_the_way = tmp_path / "a file"
    in_the_way.write_text("")
    environment = {"HOME": str(in_the_way), "XDG_CACHE_HOME": str(in_the_way), VARIABLE: ""}
    done = mocapstudio("detect", "--quick", broken, **environment)
    assert done.returncode == 0, done.stderr
