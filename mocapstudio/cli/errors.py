"""What goes wrong on the command line: one line on standard error, and the exit code."""

from __future__ import annotations

import sys
import tempfile
import traceback
from datetime import UTC, datetime
from pathlib import Path

from mocapstudio.motion.errors import CancelledError, MocapError

DONE = 0
FAULT = 1
BAD_INPUT = 2
CANCELLED = 130


def complain(error: Exception) -> None:
    """Print an error as the one line ``error: FILE: LINE: what`` on standard error."""
    print("error:", one_line(error), file=sys.stderr)


def one_line(error: Exception) -> str:
    """Return the message of an error on one line."""
    if isinstance(error, OSError) and error.filename is not None:
        message = f"{error.filename}: -: {error.strerror}"
    else:
        message = str(error) or type(error).__name__
    return " ".join(message.split())


def is_bad_input(error: Exception) -> bool:
    """Tell whether the user, not the program, can do something about an error."""
    if isinstance(error, OSError):
        return error.filename is not None
    return isinstance(error, MocapError)


def exit_code_of(error: BaseException) -> int:
    """Tell the user about an error that ended the command, and return the exit code for it."""
    if isinstance(error, KeyboardInterrupt | CancelledError):
        print("cancelled", file=sys.stderr)
        return CANCELLED
    if not isinstance(error, Exception):
        raise error
    if is_bad_input(error):
        complain(error)
        return BAD_INPUT
    print(
        f"error: internal fault: {type(error).__name__}: {one_line(error)}"
        f" (details in {_write_details(error)})",
        file=sys.stderr,
    )
    return FAULT


def _write_details(error: Exception) -> str:
    """Write the traceback to a file of the user's own and return its path."""
    from mocapstudio import __version__

    when = datetime.now(UTC).isoformat(timespec="seconds")
    head = f"mocapstudio {__version__}, Python {sys.version.split()[0]}, {when}\n"
    head += f"arguments: {sys.argv[1:]!r}\n\n"
    text = head + "".join(traceback.format_exception(error))
    for folder in _places():
        try:
            folder.mkdir(parents=True, exist_ok=True)
            with tempfile.NamedTemporaryFile(
                "w", dir=folder, prefix="fault-", suffix=".txt", delete=False, encoding="utf-8"
            ) as file:
                file.write(text)
        except OSError:
            continue
        return file.name
    return "no file: neither the log folder nor the temporary folder can be written"


def _places() -> list[Path]:
    import platformdirs

    return [platformdirs.user_log_path("mocapstudio"), Path(tempfile.gettempdir())]
