"""The doctor on this machine, and on machines that lack something."""

from __future__ import annotations

import json
import os
import re
import sys
from pathlib import Path

import PySide6
import pytest

from mocapstudio.cli.checks.finding import State
from mocapstudio.cli.checks.libraries import check_system_libraries, debian_packages
from mocapstudio.cli.checks.none_count import CALLS, TOLERANCE, lost_references
from mocapstudio.cli.checks.trial import attempt

linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="Linux only")


def findings(text: str) -> dict[str, dict[str, str]]:
    return {one["what"]: one for one in json.loads(text)["findings"]}


def test_this_pyside_keeps_its_references_to_none() -> None:
    assert lost_references() <= TOLERANCE


def test_a_pyside_that_loses_them_would_be_seen() -> None:
    """None's count is one that this interpreter can lose, unless it is immortal."""
    if sys.version_info >= (3, 12):
        pytest.skip("None is immortal from Python 3.12 on")
    script = (
        "import ctypes, sys\n"
        "before = sys.getrefcount(None)\n"
        f"for _ in range({CALLS}): ctypes.pythonapi.Py_DecRef(ctypes.py_object(None))\n"
        "lost = before - sys.getrefcount(None)\n"
        f"for _ in range({CALLS}): ctypes.pythonapi.Py_IncRef(ctypes.py_object(None))\n"
        "print(lost)"
    )
    trial = attempt(script)
    assert trial.passed, trial.said
    assert int(trial.said) > TOLERANCE


def test_all_is_well_here(mocapstudio) -> None:
    if not os.environ.get("DISPLAY"):
        pytest.skip("no display")
    done = mocapstudio("doctor", "--json", "-")
    assert done.returncode == 0, done.stdout
    found = findings(done.stdout)
    for what in ("Python", "Libraries", "Display", "OpenGL", "PySide6 and None", "Kernel cache"):
        assert found[what]["state"] == "ok", found[what]


@linux
def test_without_a_display_only_the_desk_is_missing(mocapstudio) -> None:
    done = mocapstudio("doctor", "--json", "-", DISPLAY="", WAYLAND_DISPLAY="")
    assert done.returncode == 0
    assert findings(done.stdout)["Display"]["state"] == "note"


@linux
def test_a_display_that_does_not_answer(mocapstudio) -> None:
    done = mocapstudio("doctor", DISPLAY=":7654", WAYLAND_DISPLAY="", QT_QPA_PLATFORM="xcb")
    assert done.returncode == 1
    assert "failed  Display" in done.stdout


@linux
def test_missing_libraries_are_named_by_their_packages(monkeypatch, tmp_path: Path) -> None:
    ldd = tmp_path / "ldd"
    ldd.write_text(
        "#!/bin/sh\n"
        "echo '\tlibEGL.so.1 => not found'\n"
        "echo '\tlibc.so.6 => /lib/libc.so.6 (0x1)'\n"
        "echo '\tlibxcb-cursor.so.0 => not found'\n"
    )
    ldd.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    [finding] = check_system_libraries()
    assert finding.state is State.FAILED
    assert finding.remedy == "apt-get install libegl1 libxcb-cursor0"
    assert "libc" not in finding.found.replace("libxcb-cursor", "")


@linux
def test_every_library_that_qt_links_is_listed() -> None:
    """Setup installs what the list names, so nothing may be missing in it."""
    folder = Path(next(iter(PySide6.__path__)))
    files = [
        *folder.glob("Qt/plugins/platforms/libqxcb.so"),
        *folder.glob("Qt/plugins/xcbglintegrations/*.so"),
        *(folder / "Qt" / "lib" / f"libQt6{name}.so.6" for name in ("XcbQpa", "Gui", "Widgets")),
    ]
    assert len(files) > 4
    # The names of linked libraries stand in a file's table of dynamic strings.
    name = re.compile(rb"\0(lib[\w+-]+\.so(?:\.\d+)+)(?=\0)")
    linked = {found.decode() for file in files for found in name.findall(file.read_bytes())}
    ours = {one for one in linked if not one.startswith(("libQt6", "libicu", "libc.", "libm."))}
    assert "libxcb-cursor.so.0" in ours
    assert ours <= set(debian_packages())


def test_a_cache_that_cannot_be_written(mocapstudio, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    done = mocapstudio("doctor", "--json", "-", NUMBA_CACHE_DIR=str(tmp_path / "file" / "x"))
    assert done.returncode == 1
    assert findings(done.stdout)["Kernel cache"]["state"] == "failed"


def test_warm_leaves_nothing_to_compile(mocapstudio, tmp_path: Path, figure) -> None:
    cache = {"NUMBA_CACHE_DIR": str(tmp_path / "kernels")}
    take = figure(seconds=8).raise_error("LeftForeArm", 100, 115, 60.0).write(tmp_path / "a.bvh")

    def compiled() -> set[Path]:
        return set((tmp_path / "kernels").rglob("*.nbc"))

    assert not compiled()
    assert mocapstudio("doctor", "--warm", **cache).returncode == 0
    warm = compiled()
    assert warm
    done = mocapstudio("clean", take, "-o", tmp_path / "out.bvh", "--json", "-", **cache)
    assert json.loads(done.stdout)["takes"][0]["changes"]
    assert compiled() == warm
