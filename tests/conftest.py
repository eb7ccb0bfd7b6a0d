"""Fixtures for all tests."""

from __future__ import annotations

from pathlib import Path

import pytest

DATA = Path(__file__).resolve().parents[2] / "shared" / "data"


@pytest.fixture(scope="session")
def data() -> Path:
    """The folder of real takes; tests that need it skip where it is absent."""
    if not DATA.is_dir():
        pytest.skip(f"no real takes: {DATA} does not exist")
    return DATA
