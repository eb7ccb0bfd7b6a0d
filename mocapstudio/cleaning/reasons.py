"""Why a span was flagged: the K similar spans, the minima of its distance over time."""

from __future__ import annotations

from functools import lru_cache

from mocapstudio.cleaning.analysis import Analysis
from mocapstudio.cleaning.distance_profile import DistanceProfile, distance_profile
from mocapstudio.cleaning.model import Flag, Neighbour


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
    the analysed take that are flagged on one of the same joints, and such of the context that look
    wrong themselves, are never neighbours. Empty where nothing long enough exists.
    """
    return _neighbours(analysis, flag)


@lru_cache(maxsize=512)
def _neighbours(analysis: Analysis, flag: Flag) -> tuple[Neighbour, ...]:
    profile = distance_profile(analysis, flag)
    if profile is None:
        return ()
    return tuple(_neighbour(analysis, profile, int(at)) for at in profile.minima)


def _neighbour(analysis: Analysis, profile: DistanceProfile, at: int) -> Neighbour:
    """Cut the margins off the matched span and translate it to the neighbour's own frames."""
    window, ends = profile.window, profile.ends[:, at]
    which, first = analysis.corpus.locate(at)
    texture = analysis.corpus.textures[which]
    pace = float(ends[1] - 1) / max(float(ends[0] - 1), 1.0)
    a = texture.frame(first + (window.start - window.low) * pace)
    b = texture.frame(first + (window.end - window.low) * pace)
    take = analysis.take if which == 0 else analysis.context[which - 1]
    # What lies beyond the matched path was neither compared nor checked for flags.
    matched = texture.frame(first + int(ends[1]) - 1) + 1.0
    begin = round(a)
    finish = min(max(int(min(round(b), matched)), begin + 1), take.frames)
    return Neighbour(take.name, begin, finish, float(profile.degrees[at]), which)
