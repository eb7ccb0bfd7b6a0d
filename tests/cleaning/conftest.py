"""Takes and analyses that several tests look at; none of them changes what it is given."""

from __future__ import annotations

import pytest
from made_takes import walking

from mocapstudio.motion.take import Take


@pytest.fixture(scope="session")
def take() -> Take:
    """Ten clean seconds at 30 fps."""
    return walking(10.0, 30, seed=0)


@pytest.fixture(scope="session")
def context() -> tuple[Take, ...]:
    """Two other recordings of the same walk."""
    return walking(10.0, 30, seed=1), walking(10.0, 30, seed=2)
