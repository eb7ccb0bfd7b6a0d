"""Joint weights of the online alignment, and their file."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mocapstudio.comparison.online import Variant
from mocapstudio.comparison.online_reference import MOTION, Reference
from mocapstudio.formats.atomic import write_whole
from mocapstudio.formats.json_file import read_json
from mocapstudio.motion.errors import FileError, MocapError, ParameterError, SkeletonMismatchError

_NAMED = 5
"""How many of what does not fit are named."""


@dataclass(frozen=True)
class FoldQuality:
    """What one fold of a cross-validation gave.

    Parameters
    ----------
    performers
        Whose takes were left out of training and then aligned.
    training, test, unweighted
        Mean quality of the takes trained on, of those left out, and of the latter with the
        weights of a reference for which none were learnt, each averaged over the shares of the
        movement seen.
    """

    performers: tuple[str, ...]
    training: float
    test: float
    unweighted: float

    def to_json(self) -> dict[str, Any]:
        """Plain objects for JSON."""
        return {
            "performers": list(self.performers),
            "training": self.training,
            "test": self.test,
            "unweighted": self.unweighted,
        }


@dataclass(frozen=True)
class JointWeights:
    """Weights by the name of a joint or bone, with a mean of 1 over those that were trained.

    Parameters
    ----------
    weights
        At least 0.
    variant
        How paths are accumulated with them.
    reference
        Name of the take they were learnt for.
    folds
        How well they do on performers that they were not learnt from.
    provenance
        Version, parameters and takes.
    """

    weights: Mapping[str, float]
    variant: Variant = Variant.PLAIN
    reference: str = ""
    folds: tuple[FoldQuality, ...] = ()
    provenance: Mapping[str, Any] = field(default_factory=dict)

    def to_json(self) -> dict[str, Any]:
        """Plain objects for JSON."""
        return {
            "reference": self.reference,
            "variant": self.variant.value,
            "weights": dict(self.weights),
            "folds": [fold.to_json() for fold in self.folds],
            "provenance": dict(self.provenance),
        }

    @property
    def motion(self) -> bool:
        """Whether there are weights for how joints move, beside those of their poses."""
        return any(name.endswith(MOTION) for name in self.weights)

    def fitting(self, reference: Reference) -> dict[str, float]:
        """Weights of the rows that are compared; rows without one count nothing.

        Raises
        ------
        SkeletonMismatchError
            If rows with less than half of the whole weight are compared.
        """
        self.check(reference.name, reference.names)
        return {name: self.weights[name] for name in reference.names if name in self.weights}

    def check(self, name: str, rows: Iterable[str]) -> None:
        """Refuse weights that are not for what is compared.

        Parameters
        ----------
        name
            Of the reference.
        rows
            Joints or bones that are compared, and how they move where that counts.

        Raises
        ------
        SkeletonMismatchError
            If rows with less than half of the whole weight are compared; names what is not.
        """
        there = set(rows)
        absent = [one for one in self.weights if one not in there]
        if 2 * sum(self.weights[one] for one in absent) > sum(self.weights.values()):
            fit = len(self.weights) - len(absent)
            absent.sort(key=lambda one: -self.weights[one])
            which = ", ".join(absent[:_NAMED])
            more = f" and {len(absent) - _NAMED} more" if len(absent) > _NAMED else ""
            raise SkeletonMismatchError(
                f"the weights are not for {name}: only {fit} of {len(self.weights)} belong to"
                f" something that is compared; {which}{more} do not"
            )


def write_weights(weights: JointWeights, path: Path) -> None:
    """Write weights as JSON.

    Raises
    ------
    FileError
        If the file cannot be written; an older file of that name is then left as it was.
    """
    text = json.dumps(weights.to_json(), indent=2, ensure_ascii=False, allow_nan=False)
    write_whole(path, [(text + "\n").encode()])


def read_weights(path: Path) -> JointWeights:
    """Read what `write_weights` wrote; an object ``{"weights": {name: weight}}`` is enough.

    Raises
    ------
    FileError
        If the file cannot be read, is no JSON, or does not hold weights.
    """
    content = read_json(path, "joint weights")
    try:
        return _from_json(content)
    except (MocapError, KeyError, TypeError, ValueError, AttributeError) as cause:
        raise FileError(path, f"does not hold joint weights: {_said(cause)}") from cause


def _from_json(content: Any) -> JointWeights:
    if not isinstance(content, dict) or not isinstance(content.get("weights"), dict):
        raise ParameterError("an object with weights is wanted")
    weights = content["weights"]
    for name, weight in weights.items():
        if isinstance(weight, bool) or not isinstance(weight, int | float):
            raise ParameterError(f"the weight of {name} is no number")
        if not 0 <= weight < float("inf"):
            raise ParameterError(f"the weight of {name} is {weight}, not a number of at least 0")
    if not any(weights.values()):
        raise ParameterError("no weight is above 0")
    folds = tuple(
        FoldQuality(
            tuple(map(str, one["performers"])),
            float(one["training"]),
            float(one["test"]),
            float(one["unweighted"]),
        )
        for one in content.get("folds", ())
    )
    provenance = dict(content.get("provenance", {}))
    variant = Variant(content.get("variant", Variant.PLAIN))
    return JointWeights(weights, variant, str(content.get("reference", "")), folds, provenance)


def _said(cause: Exception) -> str:
    return f"{cause.args[0]} is missing" if isinstance(cause, KeyError) else str(cause)
