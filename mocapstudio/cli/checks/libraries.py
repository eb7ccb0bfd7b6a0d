"""The Python libraries, and the system's libraries that Qt needs."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, requires, version
from importlib.util import find_spec
from pathlib import Path

from mocapstudio.cli.checks.finding import Finding, State
from mocapstudio.resource_files import resource


def check_versions() -> list[Finding]:
    """Name the versions of Python and of all libraries that the program asks for."""
    there: list[str] = []
    missing: list[str] = []
    for name in _wanted():
        try:
            there.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            missing.append(name)
    found = [
        Finding("Python", State.OK, sys.version.split()[0]),
        Finding("Libraries", State.OK, ", ".join(there)),
    ]
    if missing:
        remedy = f"pip install {' '.join(missing)}"
        found.append(Finding("Libraries", State.FAILED, f"missing: {', '.join(missing)}", remedy))
    return found


def _wanted() -> list[str]:
    wanted = [one for one in requires("mocapstudio") or () if "extra ==" not in one]
    names = (re.match(r"[\w.-]+", one) for one in wanted)
    return sorted({name.group() for name in names if name}, key=str.lower)


def check_system_libraries() -> list[Finding]:
    """Find the shared libraries of the system that Qt's wheels need and that are missing."""
    what = "Qt's system libraries"
    if not sys.platform.startswith("linux"):
        return [Finding(what, State.OK, "part of the wheels on this system")]
    ldd = shutil.which("ldd")
    if ldd is None:
        return [Finding(what, State.NOTE, "not checked: there is no ldd")]
    missing = sorted({name for file in _qt_files() for name in _missing_of(ldd, file)})
    if not missing:
        return [Finding(what, State.OK, "all there")]
    packages = debian_packages()
    wanted = sorted({packages.get(name, name) for name in missing})
    remedy = f"apt-get install {' '.join(wanted)}"
    return [Finding(what, State.FAILED, f"missing: {', '.join(missing)}", remedy)]


def debian_packages() -> dict[str, str]:
    """Return the package of Debian for each shared library that Qt and VTK need."""
    text = resource("system", "debian-packages.txt").read_text(encoding="utf-8")
    packages = {}
    for line in text.splitlines():
        if not line.startswith("#"):
            library, package = line.split()
            packages[library] = package
    return packages


def _qt_files() -> list[Path]:
    spec = find_spec("PySide6")
    if spec is None or not spec.submodule_search_locations:
        return []
    folder = Path(next(iter(spec.submodule_search_locations)))
    patterns = (
        "Qt/plugins/platforms/libqxcb.so",
        "Qt/plugins/platforms/libqoffscreen.so",
        "Qt/plugins/xcbglintegrations/*.so",
        "QtWidgets.*.so",
        "QtOpenGLWidgets.*.so",
        "QtSvg.*.so",
    )
    return sorted(file for pattern in patterns for file in folder.glob(pattern))


def _missing_of(ldd: str, file: Path) -> list[str]:
    listed = subprocess.run([ldd, str(file)], capture_output=True, text=True, check=False).stdout
    return [line.split()[0] for line in listed.splitlines() if "not found" in line]
