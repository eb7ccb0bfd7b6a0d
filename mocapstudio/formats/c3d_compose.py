"""C3D written anew, for markers that have no C3D behind them or want another layout."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mocapstudio.formats.c3d_numbers import FIRST_PROCESSOR, Numbers
from mocapstudio.formats.c3d_parameters import BLOCK
from mocapstudio.formats.guesses import turn_to_y_up
from mocapstudio.formats.options import UNITS, WriteOptions
from mocapstudio.motion import rotations as rot
from mocapstudio.motion.errors import MocapError, ParameterError
from mocapstudio.motion.markers import Event, MarkerTake

Array = NDArray[np.float64]
Value = int | float | str | Sequence[int] | Sequence[float] | Sequence[str]

_INTEL = Numbers(FIRST_PROCESSOR)
_FULL = 0xFFFF
_MOST_POINTS = 0xFFFF
_MOST_BLOCKS = 255
_EXTENT = 255
_MOST_BYTES = 32000
_CONTEXTS = ("Left", "Right", "General")
_PIECE = 4096


@dataclass(frozen=True, eq=False)
class _Plan:
    take: MarkerTake
    start: int
    end: int
    unit: str
    to_inside: Array

    @property
    def first_frame(self) -> int:
        return max(1, self.take.first_frame + self.start)


def composed(take: MarkerTake, options: WriteOptions) -> Iterator[bytes]:
    """Bytes of a C3D file of 32-bit floats that holds the markers and events of a take.

    The unit is that of the options, else of the source where C3D has a name for it, else
    millimetres; the up axis that of the options, else of the source, else Z, the usual one.
    Missing samples are marked as invalid. Where some samples are filled, all others get the least
    residual there is, since none at all marks what was not measured.

    Raises
    ------
    MocapError
        If there are more markers or longer labels than the format holds, or its unit has no name.
    """
    plan = _plan(take, options)
    groups = _groups(plan)
    section = _section(groups, 0)
    # The first sample follows header and parameters; its place is among the parameters.
    begin = 2 + len(section) // BLOCK
    section = _section(groups, begin)
    if not take.labels or len(take.labels) > _MOST_POINTS or len(section) > _MOST_BLOCKS * BLOCK:
        raise MocapError(f"{take.name}: C3D cannot hold {len(take.labels)} markers of such labels")
    yield _header(plan, begin)
    yield section
    written = 0
    for start in range(plan.start, plan.end, _PIECE):
        piece = _samples(plan, start, min(start + _PIECE, plan.end))
        written += len(piece)
        yield piece
    yield bytes(-written % BLOCK)


def _plan(take: MarkerTake, options: WriteOptions) -> _Plan:
    wanted = options.unit or (take.source.unit if take.source else UNITS["mm"])
    named = [name for name in ("mm", "cm", "m", "in") if np.isclose(UNITS[name], wanted, rtol=1e-6)]
    if not named and options.unit is not None:
        raise ParameterError(f"C3D has no name for a unit of {wanted:g} m: mm, cm, m or in")
    to_inside = take.source.to_inside if take.source else turn_to_y_up("z")
    if options.up is not None:
        to_inside = turn_to_y_up(options.up)
    start, end = take.span if options.trim else (0, take.frames)
    return _Plan(take, start, end, next(iter(named), "mm"), to_inside)


def _header(plan: _Plan, begin: int) -> bytes:
    words = np.zeros(BLOCK // 2, dtype=np.uint16)
    last = plan.first_frame + plan.end - plan.start - 1
    words[0] = 2 | 0x50 << 8
    words[1] = len(plan.take.labels)
    words[3:5] = min(plan.first_frame, _FULL), min(last, _FULL)
    raw = bytearray(words.astype("<u2").tobytes())
    raw[12:16] = _reals(-1.0)
    raw[16:18] = _words(begin)
    raw[20:24] = _reals(float(plan.take.rate))
    return bytes(raw)


def _samples(plan: _Plan, start: int, end: int) -> bytes:
    take = plan.take
    missing = take.missing[start:end]
    place = rot.rotate(rot.conjugate(plan.to_inside), take.positions[start:end])
    four = np.zeros((*missing.shape, 4), dtype=np.float32)
    four[..., :3] = place / UNITS[plan.unit]
    if take.filled is not None:
        four[..., 3] = np.where(take.filled[start:end], 0.0, 1.0)
    four[missing] = (0.0, 0.0, 0.0, -1.0)
    return _INTEL.floats_bytes(four)


def _groups(plan: _Plan) -> dict[str, dict[str, Value]]:
    take = plan.take
    frames = plan.end - plan.start
    last = plan.first_frame + frames - 1
    point: dict[str, Value] = {
        "USED": len(take.labels),
        "SCALE": -1.0,
        "RATE": float(take.rate),
        "DATA_START": 0,
        "FRAMES": min(frames, _FULL),
        "UNITS": plan.unit,
        **_split("LABELS", take.labels),
        **_split("DESCRIPTIONS", [""] * len(take.labels)),
        **_screen(plan.to_inside),
    }
    if frames > _FULL:
        point["LONG_FRAMES"] = float(frames)
    groups: dict[str, dict[str, Value]] = {
        "POINT": point,
        "ANALOG": {"USED": 0, "RATE": 0.0, "GEN_SCALE": 1.0},
        "TRIAL": {
            "ACTUAL_START_FIELD": [plan.first_frame & _FULL, plan.first_frame >> 16],
            "ACTUAL_END_FIELD": [last & _FULL, last >> 16],
        },
        "MANUFACTURER": {"SOFTWARE": "mocapstudio"},
    }
    prefixes = list(dict.fromkeys(label.rpartition(":")[0] for label in take.labels))
    if prefixes != [""]:
        names = [prefix for prefix in prefixes if prefix]
        groups["SUBJECTS"] = {
            "USED": len(names),
            "USES_PREFIXES": int(len(names) == 1),
            "NAMES": names,
            "LABEL_PREFIXES": [f"{name}:" for name in names],
        }
    events = [e for e in take.events if plan.start <= e.time * float(take.rate) < plan.end]
    if events:
        groups["EVENT"] = _event_group(plan, events)
    return groups


def _event_group(plan: _Plan, events: Sequence[Event]) -> dict[str, Value]:
    # Frame 1 is at time 0.
    rate = float(plan.take.rate)
    shift = (plan.first_frame - 1 - plan.start) / rate
    contexts, labels, times = [], [], list[float]()
    for event in events:
        context, _, label = event.name.partition(" ")
        known = context in _CONTEXTS and bool(label)
        contexts.append(context if known else "General")
        labels.append(label if known else event.name)
        times += divmod(event.time + shift, 60.0)
    return {"USED": len(events), "CONTEXTS": contexts, "LABELS": labels, "TIMES": times}


def _split(name: str, texts: Sequence[str]) -> dict[str, Value]:
    """Spread texts over as many parameters as they need: LABELS, LABELS2 and so on."""
    width = max(1, *(len(text.encode()) for text in texts)) if texts else 1
    most = max(1, min(_EXTENT, _MOST_BYTES // width))
    pieces = [texts[i : i + most] for i in range(0, len(texts), most)]
    return {name if i == 0 else f"{name}{i + 1}": list(piece) for i, piece in enumerate(pieces)}


def _screen(to_inside: Array) -> dict[str, Value]:
    """Which of the file's axes point right and up on the screen, where they are axes at all."""
    along = {}
    for key, axis in (("X_SCREEN", np.array([1.0, 0, 0])), ("Y_SCREEN", np.array([0.0, 1.0, 0]))):
        back = rot.rotate(rot.conjugate(to_inside), axis)
        at = int(np.argmax(np.abs(back)))
        if abs(back[at]) < 1 - 1e-6:
            return {}
        along[key] = ("+" if back[at] > 0 else "-") + "XYZ"[at]
    return dict(along)


def _section(groups: dict[str, dict[str, Value]], begin: int) -> bytes:
    groups["POINT"]["DATA_START"] = begin
    records = []
    for number, (group, inside) in enumerate(groups.items(), 1):
        records.append((_named(group, -number), b"\x00"))
        records += [(_named(name, number), _body(name, value)) for name, value in inside.items()]
    raw = bytearray(b"\x01\x50\x00\x54")
    for i, (head, body) in enumerate(records):
        step = 0 if i == len(records) - 1 else 2 + len(body)
        raw += head + _words(step) + body
    raw += bytes(-len(raw) % BLOCK)
    raw[2] = min(len(raw) // BLOCK, _MOST_BLOCKS)
    return bytes(raw)


def _named(name: str, group: int) -> bytes:
    return bytes([len(name), group & 0xFF]) + name.encode("ascii")


def _body(name: str, value: Value) -> bytes:
    """Type, dimensions, values and an empty description of a parameter."""
    if isinstance(value, int | float | str):
        kind, extents, raw = _bare(name, [value])
        shape = extents[:-1]
    else:
        kind, shape, raw = _bare(name, list(value))
    # Events are pairs of minutes and seconds.
    if name == "TIMES":
        shape = [2, shape[0] // 2]
    if any(extent > _EXTENT for extent in shape):
        raise MocapError(f"C3D cannot hold {len(raw)} bytes in {name}")
    return bytes([kind & 0xFF, len(shape), *shape]) + raw + b"\x00"


def _bare(name: str, values: Sequence[int | float | str]) -> tuple[int, list[int], bytes]:
    """Type, dimensions and bytes of a list of values."""
    texts = [one.encode() for one in values if isinstance(one, str)]
    if texts:
        width = max(1, *map(len, texts))
        return -1, [width, len(texts)], b"".join(text.ljust(width) for text in texts)
    numbers = [one for one in values if not isinstance(one, str)]
    if all(isinstance(one, int) for one in numbers):
        return 2, [len(numbers)], _words(*(int(one) for one in numbers))
    return 4, [len(numbers)], _reals(*numbers)


def _words(*values: int) -> bytes:
    return np.array(values, dtype=np.int64).astype(np.uint16).astype("<u2").tobytes()


def _reals(*values: float) -> bytes:
    return _INTEL.floats_bytes(np.array(values, dtype=np.float32))
