"""JSON files that people may have written by hand."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from mocapstudio.motion.errors import FileError


def read_json(path: Path, what: str) -> Any:
    """Read a JSON file.

    Parameters
    ----------
    what
        What it should hold, for the complaint.

    Raises
    ------
    FileError
        If the file cannot be read, is no UTF-8 text or no JSON, or is nested too deeply.
    """
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except OSError as cause:
        why = (cause.strerror or str(cause)).lower()
        raise FileError(path, f"cannot be read: {why}") from cause
    except UnicodeDecodeError as cause:
        raise FileError(path, "is not UTF-8 text", offset=cause.start) from cause
    except json.JSONDecodeError as cause:
        raise FileError(path, f"is not JSON: {cause.msg}", line=cause.lineno) from cause
    except RecursionError as cause:
        raise FileError(path, f"does not hold {what}: nested too deeply") from cause
