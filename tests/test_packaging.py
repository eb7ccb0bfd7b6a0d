"""The wheel: what is in it, and that the program runs from it alone."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    words = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(words, cwd=ROOT, check=True, capture_output=True)
    [path] = folder.glob("*.whl")
    return path


@pytest.fixture(scope="module")
def unpacked(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    return folder


def files_below(folder: Path) -> set[str]:
    return {
        path.relative_to(folder).as_posix()
        for path in folder.rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }


def test_wheel_holds_the_program_and_its_resources(unpacked: Path) -> None:
    packed = files_below(unpacked / "mocapstudio")
    assert {f"resources/{name}" for name in files_below(ROOT / "resources")} <= packed
    assert files_below(ROOT / "mocapstudio") <= packed
    assert "py.typed" in packed


def test_wheel_holds_nothing_else(unpacked: Path) -> None:
    [info] = unpacked.glob("*.dist-info")
    assert {path.name for path in unpacked.iterdir()} == {"mocapstudio", info.name}
    assert "mocapstudio = mocapstudio.cli:main" in (info / "entry_points.txt").read_text()
    assert files_below(info) >= {"licenses/LICENSE", "METADATA"}


def test_program_runs_from_the_wheel_alone(unpacked: Path, tmp_path: Path) -> None:
    """Resources come from the wheel, and a command that needs them and the engine works."""
    script = (
        f"import sys; sys.path.insert(0, {str(unpacked)!r})\n"
        "import mocapstudio, mocapstudio.resource_files as files\n"
        "print(mocapstudio.__file__); print(files.resource('icons', 'mocapstudio.svg'))\n"
        "from mocapstudio.cli.app import run\n"
        "sys.exit(run(['doctor', '--json', 'doctor.json']))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=tmp_path, capture_output=True, text=True
    )
    package, icon = map(Path, done.stdout.splitlines()[:2])
    assert package == unpacked / "mocapstudio" / "__init__.py"
    assert icon == unpacked / "mocapstudio" / "resources" / "icons" / "mocapstudio.svg"
    assert (tmp_path / "doctor.json").is_file(), done.stderr
