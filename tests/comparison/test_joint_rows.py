"""What a joint is in any body, read off the shape of its limb."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from made_takes import nameless, person

from mocapstudio.comparison.joint_rows import joint_roles


@pytest.mark.parametrize("collar", [0.05, 0.15, 0.24])
def test_the_elbow_is_where_upper_arm_and_forearm_meet(collar: float) -> None:
    # Upper arm and forearm measure 0.26 and 0.23: a collar bone may be as long as a forearm.
    skeleton = person()
    offsets = skeleton.offsets.copy()
    for joint, length in (("Arm", collar), ("ForeArm", 0.26), ("Hand", 0.23)):
        for side in ("Left", "Right"):
            bone = offsets[skeleton.index[side + joint]]
            bone *= length / np.linalg.norm(bone)
    body = replace(skeleton, offsets=offsets)
    for one in (body, nameless(body)):
        roles = {role: body.names[joint] for joint, role in joint_roles(one).items()}
        found = [roles[f"left {role}"] for role in ("collar", "shoulder", "elbow", "hand")]
        assert found == ["LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand"]
        assert roles["right knee"] == "RightLeg"
