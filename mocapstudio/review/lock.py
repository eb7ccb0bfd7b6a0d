"""The lock file that warns a second opener."""

from __future__ import annotations

import getpass
import os
import socket
import sys
from pathlib import Path

import msgspec

from mocapstudio.motion.errors import FileError, MocapError
from mocapstudio.review.records import Record


class Holder(Record, frozen=True):
    """Who has a file open."""

    pid: int
    host: str
    user: str = ""
    started: str = ""

    def __str__(self) -> str:
        who = f"{self.user} on {self.host}" if self.user else self.host
        return f"{who} (process {self.pid})"


class LockedError(MocapError):
    """Somebody else has the file open.

    Parameters
    ----------
    path
        The file.
    holder
        Who has it open.
    """

    def __init__(self, path: Path, holder: Holder) -> None:
        self.path, self.holder = path, holder
        super().__init__(f"{path} is open elsewhere: {holder}")


def lock_path(path: Path) -> Path:
    """Where the lock of a file lies."""
    return path.with_name(f"{path.name}.lock")


def holder(path: Path) -> Holder | None:
    """Tell who else has a file open; None where nobody has, or a process that is gone.

    A process of another host counts as living: it cannot be asked.
    """
    found = _read(lock_path(path))
    if found is None or _own(found) or not _alive(found):
        return None
    return found


def is_open_here(path: Path) -> bool:
    """Tell whether this very process has a file open."""
    found = _read(lock_path(path))
    return found is not None and _own(found) and _alive(found)


class Lock:
    """A lock that this process holds on a file until it is released.

    Parameters
    ----------
    path
        The file to be locked; it need not exist.
    force
        Take the lock over from whoever holds it.

    Raises
    ------
    LockedError
        If a living process holds the lock and `force` is False.
    FileError
        If the lock file cannot be written.
    """

    def __init__(self, path: Path, force: bool = False) -> None:
        self.path = path
        other = holder(path)
        if other is not None and not force:
            raise LockedError(path, other)
        place = lock_path(path)
        mine = msgspec.json.encode(_me())
        try:
            place.unlink(missing_ok=True)
            with place.open("xb") as file:
                file.write(mine)
        except FileExistsError:
            found = _read(place)
            raise LockedError(path, found or Holder(0, "unknown")) from None
        except OSError as error:
            raise FileError(place, f"cannot be written: {error.strerror or error}") from error

    def release(self) -> None:
        """Give the lock back, unless somebody took it over."""
        found = _read(lock_path(self.path))
        if found is not None and _own(found):
            lock_path(self.path).unlink(missing_ok=True)


def _me() -> Holder:
    try:
        user = getpass.getuser()
    except (OSError, KeyError, ImportError):
        user = ""
    return Holder(os.getpid(), socket.gethostname(), user, _started(os.getpid()))


def _own(found: Holder) -> bool:
    return (found.pid, found.host) == (os.getpid(), socket.gethostname())


def _read(place: Path) -> Holder | None:
    try:
        return msgspec.json.decode(place.read_bytes(), type=Holder)
    except (OSError, msgspec.DecodeError):
        return None


def _alive(found: Holder) -> bool:
    if found.host != socket.gethostname():
        return True
    if not _runs(found.pid):
        return False
    # The number may have gone to another process since.
    started = _started(found.pid)
    return not (found.started and started) or started == found.started


def _started(pid: int) -> str:
    """When a process began, as Linux tells it; "" elsewhere."""
    try:
        text = Path(f"/proc/{pid}/stat").read_text(encoding="ascii", errors="replace")
    except OSError:
        return ""
    return text.rpartition(")")[2].split()[19]


def _runs(pid: int) -> bool:
    if sys.platform == "win32":
        return _runs_on_windows(pid)
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True


def _runs_on_windows(pid: int) -> bool:
    # os.kill(pid, 0) would end the process there.
    import ctypes

    query_limited_information, still_active = 0x1000, 259
    kernel = ctypes.windll.kernel32  # type: ignore[attr-defined,unused-ignore]
    handle = kernel.OpenProcess(query_limited_information, False, pid)
    if not handle:
        return False
    code = ctypes.c_ulong()
    kernel.GetExitCodeProcess(handle, ctypes.byref(code))
    kernel.CloseHandle(handle)
    return code.value == still_active
