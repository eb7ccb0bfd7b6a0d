"""C3D files put together byte by byte, as the format's manual has it, for the reader's tests."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

INTEL, DEC, MIPS = 84, 85, 86


def vax_float(value: float) -> bytes:
    """A VAX F float: sign, exponent of base 2 with bias 128, fraction of 0.1f; words swapped."""
    if value == 0:
        return bytes(4)
    sign, value = (1, -value) if value < 0 else (0, value)
    fraction, exponent = np.frexp(value)
    mantissa = round((float(fraction) * 2 - 1) * 2**23)
    bits = sign << 31 | (int(exponent) + 128) << 23 | mantissa
    return struct.pack("<HH", bits >> 16, bits & 0xFFFF)


@dataclass
class Made:
    """What a made file states, each of which may be stated wrongly on purpose."""

    xyz: np.ndarray
    fourth: np.ndarray | None = None
    scale: float = -1.0
    rate: float = 100.0
    first: int = 1
    last: int | None = None
    processor: int = INTEL
    units: Sequence[str] = ("mm",)
    labels: Sequence[str] | None = None
    labels_each: int = 255
    analog: int = 0
    used: int | None = None
    frames: int | None = None
    header_events: Sequence[tuple[str, float]] = ()
    more: dict[str, dict[str, object]] = field(default_factory=dict)

    def real(self, value: float) -> bytes:
        if self.processor == DEC:
            return vax_float(value)
        return struct.pack(">f" if self.processor == MIPS else "<f", value)

    def word(self, value: int) -> bytes:
        return struct.pack(">H" if self.processor == MIPS else "<H", value & 0xFFFF)

    def value(self, value: object) -> bytes:
        values = value if isinstance(value, list | tuple | np.ndarray) else [value]
        shape = list(np.shape(value))[::-1]
        values = list(np.ravel(np.array(values, dtype=object)))
        if values and isinstance(values[0], str):
            width = max(len(v.encode()) for v in values)
            body = b"".join(v.encode().ljust(width) for v in values)
            return bytes([0xFF, 1 + len(shape), width, *shape]) + body + b"\x00"
        if all(isinstance(v, int) for v in values):
            body, kind = b"".join(self.word(v) for v in values), 2
        else:
            body, kind = b"".join(self.real(float(v)) for v in values), 4
        return bytes([kind, len(shape), *shape]) + body + b"\x00"

    def parameters(self, begin: int) -> bytes:
        frames, points = self.xyz.shape[:2]
        labels = self.labels
        if labels is None:
            labels = [f"M{i}" for i in range(points)]
        point: dict[str, object] = {
            "USED": points if self.used is None else self.used,
            "SCALE": float(self.scale),
            "RATE": float(self.rate),
            "DATA_START": begin,
            "FRAMES": min(frames, 0xFFFF) if self.frames is None else self.frames,
        }
        if self.units:
            point["UNITS"] = self.units[0] if len(self.units) == 1 else list(self.units)
        for i in range(0, len(labels), self.labels_each):
            name = "LABELS" if i == 0 else f"LABELS{i // self.labels_each + 1}"
            point[name] = list(labels[i : i + self.labels_each])
        groups = {"POINT": point | dict(self.more.get("POINT", {}))}
        groups |= {name: dict(g) for name, g in self.more.items() if name != "POINT"}
        out = b"\x01\x50\xff" + bytes([self.processor])
        for number, (group, inside) in enumerate(groups.items(), 1):
            out += bytes([len(group), 256 - number]) + group.encode() + self.word(3) + b"\x00"
            for name, value in inside.items():
                body = self.value(value)
                out += bytes([len(name), number]) + name.encode() + self.word(2 + len(body)) + body
        out += bytes(2)
        return out + bytes(-len(out) % 512)

    def samples(self) -> bytes:
        frames, points = self.xyz.shape[:2]
        fourth = np.zeros((frames, points)) if self.fourth is None else self.fourth
        table = np.concatenate([self.xyz, fourth[..., None]], axis=2).reshape(frames, 4 * points)
        if self.scale > 0:
            steps = table.copy().reshape(frames, points, 4)
            steps[..., :3] = np.round(steps[..., :3] / self.scale)
            table = steps.reshape(frames, 4 * points)
            put = lambda row: b"".join(self.word(int(v)) for v in row)  # noqa: E731
            filler = self.word(7) * self.analog
        else:
            put = lambda row: b"".join(self.real(float(v)) for v in row)  # noqa: E731
            filler = self.real(7.0) * self.analog
        if self.processor == INTEL and self.scale < 0:
            put = lambda row: row.astype("<f4").tobytes()  # noqa: E731
        return b"".join(put(row) + filler for row in table)

    def data(self) -> bytes:
        frames, points = self.xyz.shape[:2]
        begin = 2 + len(self.parameters(0)) // 512
        section = self.parameters(begin)
        header = bytearray(512)
        header[0:2] = b"\x02\x50"
        header[2:4] = self.word(points if self.used is None else self.used)
        header[4:6] = self.word(self.analog)
        header[6:8] = self.word(self.first)
        last = self.first + frames - 1 if self.last is None else self.last
        header[8:10] = self.word(min(last, 0xFFFF))
        header[12:16] = self.real(self.scale)
        header[16:18] = self.word(begin)
        header[18:20] = self.word(1 if self.analog else 0)
        header[20:24] = self.real(self.rate)
        if self.header_events:
            header[298:300] = self.word(12345)
            header[300:302] = self.word(len(self.header_events))
            for i, (name, time) in enumerate(self.header_events):
                header[304 + 4 * i : 308 + 4 * i] = self.real(time)
                header[396 + 4 * i : 400 + 4 * i] = name.encode().ljust(4)
        out = bytes(header) + section + self.samples()
        return out + bytes(-len(out) % 512)
