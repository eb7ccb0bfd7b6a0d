"""How much each joint or bone counts in the online alignment, for pictures. No Qt."""

from __future__ import annotations

from dataclasses import dataclass

from mocapstudio.comparison.online_features import features_of
from mocapstudio.comparison.online_reference import MOTION, MOTION_WEIGHT, pose_weights
from mocapstudio.comparison.weights import JointWeights
from mocapstudio.review.comparing import Recording


@dataclass(frozen=True)
class WeightRow:
    """One joint, or one bone ``"marker-marker"``.

    Parameters
    ----------
    name
        Of the joint or bone.
    pose, motion
        Weight of where it points, and of how it moves.
    """

    name: str
    pose: float
    motion: float

    @property
    def total(self) -> float:
        """Both together."""
        return self.pose + self.motion


def weight_rows(weights: JointWeights | None, reference: Recording | None) -> tuple[WeightRow, ...]:
    """Return the rows of weights, the heaviest first; those of the reference where none are given.

    Raises
    ------
    MocapError
        If nothing of the reference can be compared.
    """
    if weights is None:
        if reference is None:
            return ()
        features = features_of(reference)
        plain = zip(features.names, pose_weights(features).tolist(), strict=True)
        rows = [WeightRow(name, weight, MOTION_WEIGHT * weight) for name, weight in plain]
    else:
        names = dict.fromkeys(name.removesuffix(MOTION) for name in weights.weights)
        found = weights.weights
        rows = [
            WeightRow(name, float(found.get(name, 0.0)), float(found.get(name + MOTION, 0.0)))
            for name in names
        ]
    return tuple(sorted(rows, key=lambda row: -row.total))


def check_weights(weights: JointWeights, reference: Recording) -> None:
    """Refuse weights that do not fit a reference.

    Raises
    ------
    SkeletonMismatchError
        If most of the weight is on what the reference does not have; names it.
    MocapError
        If nothing of the reference can be compared.
    """
    names = features_of(reference).names
    weights.check(reference.name, (*names, *(name + MOTION for name in names)))
