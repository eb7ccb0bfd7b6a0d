from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import msgspec
import pytest

from mocapstudio.motion.errors import FileError
from mocapstudio.review.lock import Holder, Lock, LockedError, holder, lock_path

_HOLD = """
import sys
from pathlib import Path
from mocapstudio.review.lock import Lock
Lock(Path(sys.argv[1]))
print("locked", flush=True)
sys.stdin.read()
"""


def test_a_second_opener_is_warned_until_the_first_is_gone(tmp_path: Path) -> None:
    path = tmp_path / "one.mocapstudio"
    with subprocess.Popen(
        [sys.executable, "-c", _HOLD, str(path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == b"locked\n"
        found = holder(path)
        assert found is not None
        assert found.pid == other.pid
        with pytest.raises(LockedError, match=f"process {other.pid}"):
            Lock(path)
        other.kill()
    assert lock_path(path).exists()
    assert holder(path) is None
    lock = Lock(path)
    lock.release()
    assert not lock_path(path).exists()


def test_force_takes_over_and_the_loser_releases_nothing(tmp_path: Path) -> None:
    path = tmp_path / "one.mocapstudio"
    lock_path(path).write_bytes(msgspec.json.encode(Holder(1, "another-host")))
    with pytest.raises(LockedError):
        Lock(path)
    lock = Lock(path, force=True)
    lock_path(path).write_bytes(msgspec.json.encode(Holder(1, "another-host")))
    lock.release()
    assert lock_path(path).exists()


def test_a_number_that_went_to_another_process_is_stale(tmp_path: Path) -> None:
    import socket

    path = tmp_path / "one.mocapstudio"
    parent = os.getppid()
    mine = Holder(parent, socket.gethostname())
    lock_path(path).write_bytes(msgspec.json.encode(mine))
    assert holder(path) == mine
    if not Path(f"/proc/{parent}/stat").exists():
        pytest.skip("when a process began is only known on Linux")
    recycled = Holder(parent, socket.gethostname(), started="1")
    lock_path(path).write_bytes(msgspec.json.encode(recycled))
    assert holder(path) is None


def test_a_damaged_lock_is_nobodys(tmp_path: Path) -> None:
    path = tmp_path / "one.mocapstudio"
    lock_path(path).write_text("{")
    assert holder(path) is None
    Lock(path).release()


def test_a_folder_that_is_missing_is_a_file_error(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="cannot be written"):
        Lock(tmp_path / "none" / "one.mocapstudio")
