"""Why a span was flagged: the K similar spans, found without the flagged joints.

Leaving the flagged joints out keeps an error from choosing its own neighbours; their values just
outside the span still count, so that a neighbour also fits where the replacement must join.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.model import Flag, Neighbour
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.similarity import kernels
from mocapstudio.similarity.parallel import for_blocks
from mocapstudio.similarity.texture import MotionTexture
from mocapstudio.similarity.words import Corpus, trim_count

F32 = NDArray[np.float32]

_MARGIN = 5
_SLACK = 4 / 3
_LONGEST = 240
_FAR = np.float32(1e30)


def neighbours(analysis: Analysis, flag: Flag) -> tuple[Neighbour, ...]:
    """Find up to K spans that resemble the flagged one, best first.

    Parameters
    ----------
    analysis
        The analysis that raised the flag.
    flag
        Any of its flags; a flag of another threshold will do.

    Returns
    -------
    Neighbours at their own takes' rates, each as long as the flagged span, time-warped. Spans of
    the analysed take that are flagged on one of the same joints are never neighbours. Empty where
    nothing long enough exists.
    """
    return _neighbours(analysis, flag)


@lru_cache(maxsize=512)
def _neighbours(analysis: Analysis, flag: Flag) -> tuple[Neighbour, ...]:
    texture, corpus = analysis.texture, analysis.corpus
    start, end = _texture_span(texture, flag)
    low, high = max(start - _MARGIN, 0), min(end + _MARGIN, len(texture))
    longest = int(np.ceil((high - low) * _SLACK))
    if high - low < 4 or high - low > _LONGEST or corpus.frames < longest:
        return ()
    distances = _distances(texture, corpus, flag, (low, start, end, high))
    words = corpus.frames - longest + 1
    row, ends = np.empty(words, np.float32), np.empty((2, words), np.int16)
    kernels.dtw_word(distances, longest, row, ends)
    row[_barred(analysis, flag, words, longest, (low, high))] = _FAR
    found = np.empty(analysis.parameters.neighbours, np.int64)
    count = kernels.smallest_minima(row, corpus.starts, len(found), np.zeros(2, np.int64), found)
    joints = max(1, len(texture.joints) - len(flag.joints))
    return tuple(
        _neighbour(analysis, int(at), ends[:, at], row[at] / joints, (low, start, end, high))
        for at in found[:count]
    )


def _texture_span(texture: MotionTexture, flag: Flag) -> tuple[int, int]:
    start = int(np.floor((flag.start - texture.start) / texture.frames_each))
    end = int(np.ceil((flag.end - texture.start) / texture.frames_each))
    start = min(max(start, 0), len(texture) - 1)
    return start, min(max(end, start + 1), len(texture))


def _distances(
    texture: MotionTexture, corpus: Corpus, flag: Flag, span: tuple[int, int, int, int]
) -> F32:
    """(high - low, T) pose distances; the flagged joints count outside the span only."""
    low, start, end, high = span
    out = np.empty((high - low, corpus.frames), dtype=np.float32)
    trusted = np.array([name not in flag.joints for name in texture.joints])
    if not trusted.any():
        trusted[:] = True
    planes = np.ascontiguousarray(corpus.planes[trusted])
    inside = np.ascontiguousarray(texture.quaternions[:, trusted])
    trim = trim_count(int(trusted.sum()), whole_body=True)

    def fill(first: int, last: int) -> None:
        for a, b, q, p, out_of in (
            (low, start, texture.quaternions, corpus.planes, 0),
            (start, end, inside, planes, trim),
            (end, high, texture.quaternions, corpus.planes, 0),
        ):
            a, b = max(a, low + first), min(b, low + last)
            if a < b:
                kernels.pose_distances(q[a:b], p, out_of, out[a - low : b - low])

    for_blocks(high - low, fill, at_least=8)
    return out


def _barred(
    analysis: Analysis, flag: Flag, words: int, longest: int, span: tuple[int, int]
) -> NDArray[np.bool_]:
    """Words that straddle takes, overlap the flagged span itself, or are flagged themselves."""
    corpus, texture = analysis.corpus, analysis.texture
    bad = np.zeros(corpus.frames + 1, dtype=bool)
    bad[span[0] : span[1]] = True
    for other in analysis.flags:
        if set(other.joints) & set(flag.joints) or other.joint in ROOT_ROWS:
            bad[slice(*_texture_span(texture, other))] = True
    count = np.concatenate([[0], np.cumsum(bad)])
    barred = np.asarray(count[longest : longest + words] - count[:words] > 0)
    for start in corpus.starts[1:]:
        barred[max(int(start) - longest + 1, 0) : int(start)] = True
    return barred


def _neighbour(
    analysis: Analysis,
    at: int,
    ends: NDArray[np.int16],
    distance: float,
    span: tuple[int, int, int, int],
) -> Neighbour:
    """Cut the margins off the matched span and translate it to the neighbour's own frames."""
    low, start, end, _ = span
    which, first = analysis.corpus.locate(at)
    texture = analysis.corpus.textures[which]
    pace = float(ends[1] - 1) / max(float(ends[0] - 1), 1.0)
    a = texture.frame(first + (start - low) * pace)
    b = texture.frame(first + (end - low) * pace)
    take = analysis.take if which == 0 else analysis.context[which - 1]
    # What lies beyond the matched path was neither compared nor checked for flags.
    matched = texture.frame(first + int(ends[1]) - 1) + 1.0
    begin = round(a)
    finish = min(max(int(min(round(b), matched)), begin + 1), take.frames)
    degrees = float(np.rad2deg(2.0 * np.sqrt(max(distance, 0.0))))
    return Neighbour(take.name, begin, finish, degrees, which)
