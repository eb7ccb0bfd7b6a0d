"""What markers are for, told by their labels: the families of names that laboratories use.

Known are the karate set of paper 4, Vicon's Plug-in Gait, CMU's and OpenCap's sets, and names that
spell the part out.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from mocapstudio.motion.marker_labels import bare, split_side

LIMBS = ("spine", "head", "left arm", "right arm", "left leg", "right leg", "other")
"""Limbs in the order of display."""

_HEAD = re.compile(r"^(fhd|bhd|bkhd|head|hed|rfhd|forehead|nose|eye|ear)")
_TRUNK = re.compile(
    r"^(c7|t\d+|clav|strn|stern|bac|nck|neck|chest|spine|torso|thor|sac|pelvis|hips?$|asi|psi|iliac"
    r"|fwt|bwt|mwt|fhp|bhp|asis|psis|midhip|midasis|waist|root)"
)
_ARM = re.compile(
    r"^(sho|shd|acr|as[hk]|psh|upa|ua\d|uarm|upperarm|arm|elb|lel|mel|frm|fa(?!k)|fore"
    r"|wr|fin|ind|pnk|hand|thumb|thm|ejc|sjc|wjc|clavicle)"
)
_LEG = re.compile(
    r"^(thi|th\d|kne|mkne|mknee|lfc|mfc|fem|tib|tb\d|shn|shin|shank|ank|mank|lmal|mmal|mal|hee"
    r"|cal|toe|mt\d|met|5met|1met|big|small|fak|bak|foot|leg|hjc|kjc|ajc|hip|postfem|antfem"
    r"|posttib|anttib|up|low)"
)

# Roles as `joint_rows.joint_roles` names them; labels without side, in order of preference.
_ROLES = {
    "head": ("bkhd", "head", "hed"),
    "neck": ("nck", "clav", "neck"),
    "chest": ("strn", "t10", "chest"),
    "pelvis": ("midhip", "pelvis", "sac", "hips"),
}
_SIDED_ROLES = {
    "shoulder": ("sho", "shd", "arm", "upperarm", "shoulder", "sjc", "acr"),
    "elbow": ("elb", "elbow", "forearm", "lowerarm", "ejc", "lel"),
    "hand": ("wra", "wrs", "wrist", "wrb", "wjc", "hand"),
    "fingers": ("fin", "ind"),
    "hip": ("hip", "thigh", "upleg", "upperleg", "hjc"),
    "knee": ("kne", "knee", "leg", "lowerleg", "shin", "kjc", "lfc"),
    "foot": ("ank", "fak", "ankle", "foot", "ajc", "lmal"),
    "toes": ("toe", "bigtoe", "mt5"),
}


def limb_of(label: str) -> str:
    """Return the limb that a marker sits on, ``"other"`` where its label tells none."""
    name = bare(label)
    if _HEAD.match(name):
        return "head"
    if _TRUNK.match(name):
        return "spine"
    side, part = split_side(name)
    if not side:
        return "other"
    if _HEAD.match(part):
        return "head"
    if _TRUNK.match(part) and part != "hip":
        return "spine"
    kind = "arm" if _ARM.match(part) else "leg" if _LEG.match(part) else ""
    return f"{side} {kind}" if kind else "other"


def marker_roles(labels: Sequence[str]) -> dict[int, str]:
    """Tell which markers stand for the joints of any body; one marker a role."""
    names = [bare(label) for label in labels]
    roles: dict[int, str] = {}
    for role, known in _ROLES.items():
        at = next((names.index(one) for one in known if one in names), None)
        if at is not None:
            roles[at] = role
    split = [split_side(name) for name in names]
    for side in ("left", "right"):
        for role, known in _SIDED_ROLES.items():
            wanted = ((side, one) for one in known)
            at = next((split.index(one) for one in wanted if one in split), None)
            if at is not None:
                roles.setdefault(at, f"{side} {role}")
    return roles


def find(labels: Sequence[str], *alternatives: Sequence[str]) -> list[int]:
    """Return the markers of the first alternative of which all bare labels are there."""
    names = [bare(label) for label in labels]
    for wanted in alternatives:
        if all(one in names for one in wanted):
            return [names.index(one) for one in wanted]
    return []
