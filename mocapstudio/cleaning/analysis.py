"""The result of an analysis, with all that reasons and proposals need."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from mocapstudio.cleaning.flags import find_flags
from mocapstudio.cleaning.model import DigressionMap, Flag
from mocapstudio.cleaning.own_rate import OwnRate
from mocapstudio.cleaning.parameters import DetectionParameters
from mocapstudio.motion.declared import Declared
from mocapstudio.motion.take import Take
from mocapstudio.similarity.texture import MotionTexture
from mocapstudio.similarity.words import Corpus


@dataclass(frozen=True, eq=False)
class Analysis:
    """What was found in one take against one context.

    Parameters
    ----------
    take
        The analysed take.
    context
        The takes it was compared with, apart from itself.
    parameters
        As asked for.
    corpus
        Textures of the take (first) and its context.
    map
        The digression map at the take's own rate.
    flags
        Worst first.
    own_rate
        Pops and jitter, (F, R) over the rows of the map.
    learnt
        Whether the learnt decision drew the map.
    unanalysed
        Names of joints that were left out: fingers, eyes, or unknown to the context.
    doubts
        Spans of each take of the context that look wrong themselves: they serve no repair. Empty
        where nothing was learnt.
    """

    take: Take
    context: tuple[Take, ...]
    parameters: DetectionParameters
    corpus: Corpus
    map: DigressionMap
    flags: tuple[Flag, ...]
    own_rate: OwnRate
    unanalysed: tuple[str, ...]
    learnt: bool = False
    doubts: tuple[tuple[Declared, ...], ...] = ()

    @property
    def texture(self) -> MotionTexture:
        """The analysed take's own texture."""
        return self.corpus.textures[0]

    def with_threshold(self, threshold: float) -> Analysis:
        """Return the same analysis with other flags; nothing is searched anew."""
        parameters = replace(self.parameters, threshold=threshold)
        flags = find_flags(self.take, self.map, self.own_rate, threshold)
        return replace(self, parameters=parameters, flags=flags)

    def peak(self, row: str, start: int, end: int) -> float:
        """Highest map value of a row within a span."""
        column: NDArray[np.float32] = self.map.values[start:end, self.map.rows.index(row)]
        return float(column.max(initial=0.0))
