"""Where in a JSON text its elements begin, so that an error can name its line."""

from __future__ import annotations

import json
import re
from typing import Any

_SPACE = re.compile(r"[ \t\n\r]*")


def element_lines(text: str, key: str) -> list[int]:
    """1-based line on which each element of the array under a top-level `key` begins.

    Parameters
    ----------
    text
        Valid JSON. Where it is no object, or `key` holds no array, the result is empty.
    """
    at = _skip(text, 0)
    if not text.startswith("{", at):
        return []
    decoder = json.JSONDecoder()
    at = _skip(text, at + 1)
    lines: list[int] = []
    while not text.startswith("}", at):
        name, at = decoder.raw_decode(text, at)
        at = _skip(text, _skip(text, at) + 1)
        # Of repeated keys the last one counts, as it does for the parser.
        if name == key and text.startswith("[", at):
            lines, at = _elements(text, at, decoder)
        else:
            lines = [] if name == key else lines
            at = _after(text, at, decoder)
        at = _next(text, at)
    return lines


def _elements(text: str, at: int, decoder: json.JSONDecoder) -> tuple[list[int], int]:
    lines = []
    at = _skip(text, at + 1)
    while not text.startswith("]", at):
        lines.append(text.count("\n", 0, at) + 1)
        at = _next(text, _after(text, at, decoder))
    return lines, at + 1


def _after(text: str, at: int, decoder: json.JSONDecoder) -> int:
    value: tuple[Any, int] = decoder.raw_decode(text, at)
    return value[1]


def _next(text: str, at: int) -> int:
    """Skip space, and a comma if there is one."""
    at = _skip(text, at)
    return _skip(text, at + 1) if text.startswith(",", at) else at


def _skip(text: str, at: int) -> int:
    found = _SPACE.match(text, at)
    return at if found is None else found.end()
