"""Where numba keeps compiled kernels.

By default numba writes beside the source, and a read-only installation then fails at import.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import platformdirs

VARIABLE = "NUMBA_CACHE_DIR"
TEMPORARY = "mocapstudio-kernels-"


def place_kernel_cache() -> Path:
    """Choose a writable folder for compiled kernels and tell numba; return it.

    A folder that the environment names already is left alone. Call it before numba is imported.
    """
    named = os.environ.get(VARIABLE)
    if named:
        return Path(named)
    folder = platformdirs.user_cache_path("mocapstudio") / "numba"
    if not is_writable(folder):
        # A fresh name: compiled code is loaded from here, so nobody else may have put it there.
        folder = Path(tempfile.mkdtemp(prefix=TEMPORARY))
    os.environ[VARIABLE] = str(folder)
    return folder


def is_writable(folder: Path) -> bool:
    """Tell whether files can be made in a folder, which is created where it is absent."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return True
    except OSError:
        return False
