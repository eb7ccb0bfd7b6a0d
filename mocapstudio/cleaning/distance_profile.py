"""Distance over time: how far a flagged span is from every span of its length (paper 1, figure 3).

The minima of this curve are the neighbours. The flagged joints are left out inside the span, which
keeps an error from choosing its own neighbours; their values just outside still count, so that a
neighbour also fits where the replacement must join.
"""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.model import Flag
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.motion.progress import Progress, run
from mocapstudio.motion.take import Take
from mocapstudio.similarity import kernels
from mocapstudio.similarity.parallel import for_blocks
from mocapstudio.similarity.texture import MotionTexture
from mocapstudio.similarity.words import trim_count

F32 = NDArray[np.float32]
I64 = NDArray[np.int64]
Flags = NDArray[np.bool_]

_MARGIN = 5
_SLACK = 4 / 3
_LONGEST = 240
_FAR = np.float32(1e30)
# About a quarter of a second on two cores.
_PAIRS_A_STEP = 2_000_000


@dataclass(frozen=True)
class Window:
    """The flagged span and its margins, in texture frames: low <= start < end <= high."""

    low: int
    start: int
    end: int
    high: int

    @property
    def longest(self) -> int:
        """Length of a target span: what a warping path may cover at most."""
        return int(np.ceil((self.high - self.low) * _SLACK))


@dataclass(frozen=True, eq=False)
class TakeDistances:
    """The part of a distance profile that lies in one take.

    Parameters
    ----------
    take
        The take.
    index
        0 for the analysed take itself, else one more than its place in the context.
    first
        Position in the corpus of its first value.
    frames
        (n,) frames of the take, fractional, on which the flagged span would begin.
    degrees
        (n,) float32 root mean square joint angle to the flagged motion.
    barred
        (n,) whether a span that begins there may not be a neighbour: it overlaps the flagged one,
        or is flagged itself.
    """

    take: Take
    index: int
    first: int
    frames: NDArray[np.float64]
    degrees: F32
    barred: Flags


@dataclass(frozen=True, eq=False)
class DistanceProfile:
    """How far the flagged span is from each of the W spans of its length in the corpus.

    Parameters
    ----------
    window
        What was compared.
    degrees
        (W,) float32 root mean square joint angle along the warping path, over the joints that are
        not flagged; W counts positions of the corpus, straddling ones too.
    ends
        (2, W) int16: how many frames of the window and of the target the path covers.
    barred
        (W,) whether a position is no candidate.
    minima
        (k,) the smallest local minima that are not barred, best first; at most K.
    takes
        The same values, a take each; takes shorter than the span are left out.
    """

    window: Window
    degrees: F32
    ends: NDArray[np.int16]
    barred: Flags
    minima: I64
    takes: tuple[TakeDistances, ...]


def distance_profile(analysis: Analysis, flag: Flag) -> DistanceProfile | None:
    """Do what `measuring` does, at once."""
    return run(measuring(analysis, flag))


def measuring(analysis: Analysis, flag: Flag) -> Generator[Progress, None, DistanceProfile | None]:
    """Measure a flagged span against every span of the take itself and of its context.

    Constrained DTW over squared pose distances, as for motion-words (paper 1, equation 1 and
    appendix); yields progress a few times a second. The latest few are kept.

    Parameters
    ----------
    analysis
        The analysis that raised the flag.
    flag
        Any of its flags; a flag of another threshold will do.

    Returns
    -------
    The profile, or None where the span is too short, too long (over ten seconds) or longer than
    everything it could be compared with.
    """
    kept = _kept(analysis, flag)
    if not kept:
        kept.append((yield from _measured(analysis, flag)))
    return kept[0]


@lru_cache(maxsize=16)
def _kept(_analysis: Analysis, _flag: Flag) -> list[DistanceProfile | None]:
    """Return the place where the profile of a flag is kept; empty at first."""
    return []


def _measured(analysis: Analysis, flag: Flag) -> Generator[Progress, None, DistanceProfile | None]:
    texture, corpus = analysis.texture, analysis.corpus
    start, end = texture_span(texture, flag)
    window = Window(max(start - _MARGIN, 0), start, end, min(end + _MARGIN, len(texture)))
    length, longest = window.high - window.low, window.longest
    words = corpus.frames - longest + 1
    if length < 4 or length > _LONGEST or max(len(one) for one in corpus.textures) < longest:
        return None
    squared, ends = np.empty(words, np.float32), np.empty((2, words), np.int16)
    step = max(_PAIRS_A_STEP // length, longest)
    for first in range(0, words, step):
        yield Progress(first / words, "measuring distances")
        last = min(first + step, words)
        poses = pose_distances(analysis, flag, window, first, last + longest - 1)
        row, reached = np.empty(last - first, np.float32), np.empty((2, last - first), np.int16)
        kernels.dtw_word(poses, longest, row, reached)
        squared[first:last], ends[:, first:last] = row, reached
    barred = _barred(analysis, flag, words, window)
    found = np.empty(analysis.parameters.neighbours, np.int64)
    allowed = np.where(barred, _FAR, squared)
    nothing = np.zeros(2, np.int64)
    count = kernels.smallest_minima(allowed, corpus.starts, len(found), nothing, found)
    compared = max(1, len(texture.joints) - len(flag.joints))
    degrees = np.rad2deg(2.0 * np.sqrt(np.maximum(squared / compared, 0.0))).astype(np.float32)
    takes = _by_take(analysis, window, degrees, barred)
    return DistanceProfile(window, degrees, ends, barred, found[:count], takes)


def texture_span(texture: MotionTexture, flag: Flag | Declared) -> tuple[int, int]:
    """Half-open span of texture frames that a span of own frames covers, at least one."""
    start = int(np.floor((flag.start - texture.start) / texture.frames_each))
    end = int(np.ceil((flag.end - texture.start) / texture.frames_each))
    start = min(max(start, 0), len(texture) - 1)
    return start, min(max(end, start + 1), len(texture))


def pose_distances(analysis: Analysis, flag: Flag, window: Window, first: int, last: int) -> F32:
    """Pose distances (high - low, last - first) to a stretch of the corpus.

    The flagged joints count outside the span only.
    """
    texture = analysis.texture
    everything = np.ascontiguousarray(analysis.corpus.planes[:, :, first:last])
    trusted = np.array([name not in flag.joints for name in texture.joints])
    if not trusted.any():
        trusted[:] = True
    planes = np.ascontiguousarray(everything[trusted])
    inside = np.ascontiguousarray(texture.quaternions[:, trusted])
    trim = trim_count(int(trusted.sum()), whole_body=True)
    low = window.low
    out = np.empty((window.high - low, last - first), dtype=np.float32)

    def fill(begin: int, stop: int) -> None:
        for a, b, q, p, out_of in (
            (low, window.start, texture.quaternions, everything, 0),
            (window.start, window.end, inside, planes, trim),
            (window.end, window.high, texture.quaternions, everything, 0),
        ):
            a, b = max(a, low + begin), min(b, low + stop)
            if a < b:
                kernels.pose_distances(q[a:b], p, out_of, out[a - low : b - low])

    for_blocks(len(out), fill, at_least=8)
    return out


def _barred(analysis: Analysis, flag: Flag, words: int, window: Window) -> Flags:
    """Words that straddle takes, overlap the flagged span itself, or look wrong themselves."""
    corpus, texture, longest = analysis.corpus, analysis.texture, window.longest
    bad = np.zeros(corpus.frames + 1, dtype=bool)
    bad[window.low : window.high] = True
    for other in analysis.flags:
        if set(other.joints) & set(flag.joints) or other.joint in ROOT_ROWS:
            bad[slice(*texture_span(texture, other))] = True
    for at, doubts in enumerate(analysis.doubts, start=1):
        first, one = int(corpus.starts[at]), corpus.textures[at]
        for doubt in doubts:
            if doubt.row in flag.joints or doubt.row in ROOT_ROWS:
                low, high = texture_span(one, doubt)
                bad[first + low : first + high] = True
    count = np.concatenate([[0], np.cumsum(bad)])
    barred = np.asarray(count[longest : longest + words] - count[:words] > 0)
    for start in corpus.starts[1:]:
        barred[max(int(start) - longest + 1, 0) : int(start)] = True
    return barred


def _by_take(
    analysis: Analysis, window: Window, degrees: F32, barred: Flags
) -> tuple[TakeDistances, ...]:
    takes = (analysis.take, *analysis.context)
    parts = []
    for index, texture in enumerate(analysis.corpus.textures):
        first = int(analysis.corpus.starts[index])
        count = len(texture) - window.longest + 1
        if count < 1:
            continue
        place = np.arange(count, dtype=np.float64) + (window.start - window.low)
        frames = texture.start + place * texture.frames_each
        part = slice(first, first + count)
        one = TakeDistances(takes[index], index, first, frames, degrees[part], barred[part])
        parts.append(one)
    return tuple(parts)
