"""What holds around every command: help, versions, faults, cancelling, what is imported."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from mocapstudio import __version__
from mocapstudio.cli import app
from mocapstudio.cli.app import COMMANDS, load, run
from mocapstudio.motion.errors import CancelledError

COMMAND = Path(sys.executable).with_name("mocapstudio")


def imported(tmp_path: Path, *words: object) -> set[str]:
    """Names of the modules that a command has imported by its end."""
    script = (
        "import sys, mocapstudio.cli.app as app\n"
        f"code = app.run({list(map(str, words))!r})\n"
        "print(code, *sorted(sys.modules), file=open('modules.txt', 'w'))\n"
    )
    subprocess.run([sys.executable, "-c", script], cwd=tmp_path, check=True, capture_output=True)
    code, *modules = (tmp_path / "modules.txt").read_text().split()
    assert code == "0"
    return set(modules)


GUI = {"PySide6", "pyqtgraph", "pyvista", "pyvistaqt", "superqt", "vtk", "vtkmodules"}
SLOW = {"scipy.signal", "scipy.spatial", "sklearn", "matplotlib"}


def test_detect_and_clean_stay_light(tmp_path: Path, figure, broken: Path, caches, monkeypatch):
    """Nothing of the desk is ever imported; what learning needs, only while it learns."""
    for name, value in caches.items():
        monkeypatch.setenv(name, value)
    short = figure(seconds=8).write(tmp_path / "short.bvh")
    words = ("detect", short, "--json", "x.json", "--map", "x.npz")
    assert not imported(tmp_path, *words) & GUI
    detect = imported(tmp_path, *words)
    assert "mocapstudio.cleaning.decision.model" in detect
    assert not detect & (GUI | SLOW)
    clean = imported(tmp_path, "clean", "--quick", broken, "-o", "out.bvh")
    assert not clean & (GUI | SLOW)


def test_help_imports_next_to_nothing(tmp_path: Path) -> None:
    assert not imported(tmp_path, "--help") & ({"numpy", "numba", "scipy"} | GUI)


def test_help_lists_every_command(mocapstudio) -> None:
    done = mocapstudio("--help", COLUMNS="200")
    assert done.returncode == 0
    for name, summary in COMMANDS.items():
        assert name in done.stdout
        assert summary in done.stdout


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_explains_itself(mocapstudio, name: str) -> None:
    done = mocapstudio(name, "--help", COLUMNS="200")
    assert done.returncode == 0, done.stderr
    assert f"mocapstudio {name}" in done.stdout
    assert done.stderr == ""


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_is_one_function_in_one_file(name: str) -> None:
    function = load(name)
    module = name.replace("-", "_")
    assert function.__name__ == module
    assert function.__module__ == f"mocapstudio.cli.{module}"


def test_version(mocapstudio) -> None:
    done = mocapstudio("--version")
    assert (done.returncode, done.stdout.strip()) == (0, f"mocapstudio {__version__}")


@pytest.mark.parametrize("words", [["dedect"], ["--fast"], ["detect", "--help-me"]])
def test_wrong_use_is_one_line(mocapstudio, words: list[str]) -> None:
    done = mocapstudio(*words)
    assert done.returncode == 2
    [line] = done.stderr.splitlines()
    assert line.startswith("error: ")


def test_internal_fault(monkeypatch, capsys, tmp_path: Path) -> None:
    def detect() -> None:
        raise ValueError("two\nlines")

    monkeypatch.setattr(app, "load", lambda name: detect)
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    assert run(["detect"]) == 1
    [line] = capsys.readouterr().err.splitlines()
    assert line.startswith("error: internal fault: ValueError: two lines")
    [details] = tmp_path.rglob("fault-*.txt")
    assert str(details) in line
    assert "Traceback" in details.read_text()
    assert __version__ in details.read_text()


@pytest.mark.parametrize("error", [KeyboardInterrupt(), CancelledError("stopped")])
def test_cancelled(monkeypatch, capsys, error: BaseException) -> None:
    def detect() -> None:
        raise error

    monkeypatch.setattr(app, "load", lambda name: detect)
    assert run(["detect"]) == 130
    assert capsys.readouterr().err == "cancelled\n"


def test_interrupt_leaves_nothing_behind(tmp_path: Path, broken: Path) -> None:
    """Ctrl-C while the command waits for the rest of a joint map that comes through a pipe."""
    pipe = tmp_path / "names.json"
    os.mkfifo(pipe)
    process = subprocess.Popen(
        [str(COMMAND), "clean", str(broken), "-o", "out.bvh", "--joint-map", str(pipe)],
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        text=True,
    )
    with opened(pipe, process):
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert said == "cancelled\n"
    assert sorted(tmp_path.iterdir()) == [broken, pipe]


@contextmanager
def opened(pipe: Path, reader: subprocess.Popen[str]) -> Iterator[None]:
    """Hold a pipe open for writing, once the process on its other end reads."""
    while True:
        assert reader.poll() is None, reader.communicate()
        try:
            end = os.open(pipe, os.O_WRONLY | os.O_NONBLOCK)
            break
        except OSError:
            time.sleep(0.02)
    try:
        yield
    finally:
        os.close(end)


def test_reader_that_leaves_early(tmp_path: Path, broken: Path) -> None:
    line = f"{COMMAND} detect --quick {broken} --json - | head -c 1; exit ${{PIPESTATUS[0]}}"
    done = subprocess.run(["bash", "-c", line], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0
    assert done.stdout == "{"
    assert done.stderr == ""


def test_module_is_the_command(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "mocapstudio", "--version"], capture_output=True, text=True
    )
    assert done.stdout == f"mocapstudio {__version__}\n"


def test_json_is_plain_text_for_any_name(mocapstudio, tmp_path: Path, figure) -> None:
    path = figure(seconds=3).write(tmp_path / "très «bon» 跳舞.bvh")
    done = mocapstudio("inspect", path, "--json", "-")
    assert json.loads(done.stdout)["files"][0]["path"] == str(path)
