"""What all records of session file and journal share: JSON beside named arrays of samples."""

from __future__ import annotations

import io
from collections.abc import Iterable, Mapping
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

Arrays = dict[str, NDArray[Any]]


class MalformedError(ValueError):
    """Records that contradict themselves or their arrays; the message says how."""


class Record(msgspec.Struct, frozen=True, omit_defaults=True):
    """Base of all records."""


def samples(
    arrays: Mapping[str, NDArray[Any]], key: str, shape: tuple[int, ...]
) -> NDArray[np.float64]:
    """Return named samples, which nobody may write to any more.

    Raises
    ------
    MalformedError
        If they are missing or of another shape.
    """
    found = arrays.get(key)
    if found is None or found.shape != shape or found.dtype != np.float64:
        raise MalformedError(f"samples {key} are missing or damaged")
    found.setflags(write=False)
    return found


def arrays_to_bytes(arrays: Mapping[str, NDArray[Any]]) -> bytes:
    """Return an npz file of named arrays."""
    buffer = io.BytesIO()
    np.savez_compressed(buffer, allow_pickle=False, **dict(arrays))
    return buffer.getvalue()


def arrays_from_bytes(data: bytes) -> Arrays:
    """Read an npz file; no pickle.

    Raises
    ------
    ValueError, OSError, zipfile.BadZipFile
        If it is damaged.
    """
    with np.load(io.BytesIO(data), allow_pickle=False) as file:
        return {name: np.ascontiguousarray(file[name]) for name in file.files}


def check_unique(ids: Iterable[str], what: str) -> None:
    """Raise MalformedError where an id comes twice."""
    seen: set[str] = set()
    for one in ids:
        if one in seen:
            raise MalformedError(f"{what} {one} comes twice")
        seen.add(one)
