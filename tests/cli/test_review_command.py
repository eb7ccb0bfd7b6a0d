"""`mocapstudio review` before there is a window, and when it is interrupted."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from made_takes import walking

from mocapstudio import formats

COMMAND = [sys.executable, "-m", "mocapstudio", "review"]


def environment(tmp_path: Path, **changes: str) -> dict[str, str]:
    own = {f"XDG_{name}_HOME": str(tmp_path / name) for name in ("CONFIG", "STATE", "DATA")}
    return {**os.environ, **own, **changes}


@pytest.mark.parametrize("option", [[], ["--context"], ["--partner"]])
def test_a_missing_file_is_one_line(tmp_path, option):
    missing = tmp_path / "missing.bvh"
    done = subprocess.run([*COMMAND, *option, missing], capture_output=True, text=True, timeout=60)
    assert done.returncode == 2
    assert done.stderr == f"error: {missing}: -: no such file or folder\n"


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["--live", "-"], "error: --live wants one TAKE, the reference"),
        (["{take}", "--live", "gone.bvh"], "error: gone.bvh: -: no such file or folder"),
        (["{take}", "--weights", "{take}"], "error: --weights and --labels belong to --live"),
        (["{take}", "--live", "-", "--weights", "{take}"], "error: {take}: 1: is not JSON"),
    ],
)
def test_what_live_wants_is_said_on_one_line(tmp_path, given, said):
    take = tmp_path / "take.bvh"
    take.write_text("HIERARCHY\n")
    words = [one.format(take=take) for one in given]
    done = subprocess.run([*COMMAND, *words], capture_output=True, text=True, timeout=60)
    assert done.returncode == 2
    assert done.stderr.startswith(said.format(take=take))
    assert len(done.stderr.splitlines()) == 1


def test_without_a_display_it_says_so(tmp_path):
    bare = environment(tmp_path)
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"):
        bare.pop(name, None)
    done = subprocess.run(COMMAND, capture_output=True, text=True, timeout=60, env=bare)
    assert done.returncode == 2
    assert done.stderr.startswith("error: no display")
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize("live", [False, True])
def test_ctrl_c_ends_the_desk(tmp_path, live):
    if not os.environ.get("DISPLAY"):
        pytest.skip("no display")
    words = []
    if live:
        formats.write(walking(1.0), tmp_path / "take.bvh")
        words = [str(tmp_path / "take.bvh"), "--live", "-"]
    # Nobody ever closes the pipe that it listens to.
    desk = subprocess.Popen(
        COMMAND + words,
        env=environment(tmp_path),
        stdin=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    unsaved = tmp_path / "STATE" / "mocapstudio" / "unsaved"
    ready = time.monotonic() + 60
    while not list(unsaved.glob("*.journal")) and time.monotonic() < ready:
        time.sleep(0.1)
    time.sleep(3)
    desk.send_signal(signal.SIGINT)
    assert desk.wait(30) == 130
