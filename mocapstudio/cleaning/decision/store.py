"""Learnt decisions kept on disk, named by the content that they were learnt from."""

from __future__ import annotations

import contextlib
import hashlib
import os
import struct
import tempfile
import zipfile
import zlib
from collections.abc import Generator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import platformdirs

from mocapstudio.cleaning.decision.forest import Forest
from mocapstudio.cleaning.decision.general import general_judge
from mocapstudio.cleaning.decision.model import Bench, Decision, Judge
from mocapstudio.cleaning.decision.training import learn
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.progress import Progress
from mocapstudio.motion.recording import motion_digest
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import comparable_joints

_VERSION = 12
_MOST_KEPT = 64
_DAMAGED = (
    OSError, EOFError, KeyError, ValueError, RuntimeError, MemoryError,
    struct.error, zipfile.BadZipFile, zlib.error,
)  # fmt: skip
"""What reading an npz file raises whose bytes are not those that were written."""


def prepare(
    context: Sequence[Take], folder: Path | None = None
) -> Generator[Progress, None, Decision]:
    """Return the decision learnt from a context: from the cache, or learnt now and kept.

    Parameters
    ----------
    context
        Takes of one skeleton; a single one is compared with itself.
    folder
        Where decisions are kept, or None for the user's cache.

    Raises
    ------
    TooLittleToLearnError
        If there is nothing to learn from.
    """
    joints = comparable_joints(context[0], context[1:])
    path = (folder or default_folder()) / f"{key(context, joints)}.npz"
    known = load(path)
    if known is not None:
        yield Progress(1.0, "context known")
        return known
    decision = yield from learn(context, joints)
    # A cache that cannot be written costs time, nothing else.
    with contextlib.suppress(OSError):
        save(decision, path)
        _forget_oldest(path.parent)
    return decision


def default_folder() -> Path:
    """Folder of learnt decisions in the user's cache."""
    return Path(platformdirs.user_cache_dir("mocapstudio", appauthor=False)) / "decisions"


def key(context: Sequence[Take], joints: Sequence[str]) -> str:
    """Name of a decision: a digest of motions (in any order), joints and version."""
    digests = sorted(motion_digest(take) for take in context)
    text = "\n".join([str(_VERSION), *joints, *digests])
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def save(decision: Decision, path: Path) -> None:
    """Write a decision, in one piece or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent, suffix=".part")
    try:
        with os.fdopen(handle, "wb") as out:
            arrays: dict[str, Any] = {"joints": np.array(decision.joints), "usual": decision.usual}
            for i, judge in enumerate(decision.judges):
                arrays |= judge.own.arrays(f" {i} ")
                arrays["share"] = np.array(judge.share)
            arrays |= decision.spans.arrays("spans ") | _of_doubts(decision.doubts)
            np.savez_compressed(out, **arrays)
        Path(name).replace(path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise


def load(path: Path) -> Decision | None:
    """Read a decision; None where there is none, or where the file is damaged."""
    try:
        with np.load(path, allow_pickle=False) as arrays:
            judges = tuple(
                Bench(Judge.from_arrays(arrays, f" {i} "), general_judge(), float(arrays["share"]))
                for i in range(2 if "joints 1 base" in arrays else 1)
            )
            names = tuple(str(name) for name in arrays["joints"])
            spans = Forest.from_arrays(arrays, "spans ")
            return Decision(names, arrays["usual"], judges, spans, _doubts_of(arrays))
    except _DAMAGED:
        return None


def _of_doubts(doubts: Mapping[str, Sequence[Declared]]) -> dict[str, Any]:
    rows = [(digest, one) for digest, spans in doubts.items() for one in spans]
    return {
        "doubt take": np.array([digest for digest, _ in rows], dtype=str),
        "doubt row": np.array([one.row for _, one in rows], dtype=str),
        "doubt span": np.array([(one.start, one.end) for _, one in rows], np.int64).reshape(-1, 2),
    }


def _doubts_of(arrays: Any) -> dict[str, tuple[Declared, ...]]:
    columns = (arrays[f"doubt {name}"].tolist() for name in ("take", "row", "span"))
    doubts: dict[str, tuple[Declared, ...]] = {}
    for digest, row, (start, end) in zip(*columns, strict=True):
        doubts[digest] = (*doubts.get(digest, ()), Declared(row, start, end))
    return doubts


def _forget_oldest(folder: Path) -> None:
    kept = sorted(folder.glob("*.npz"), key=lambda p: p.stat().st_mtime, reverse=True)
    for old in kept[_MOST_KEPT:]:
        old.unlink(missing_ok=True)
