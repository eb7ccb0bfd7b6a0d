"""Where markers of known names sit: the sets of Vicon, CMU, OpenSim, OpenCap, Qualisys.

A site is counted on a body whose leg, hip to ankle, is `LEG` metres long. It is where the solver
starts from; the take itself tells the rest.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from mocapstudio.motion.marker_labels import bare, split_side

LEG = 0.82
"""Metres from hip to ankle of the body that the sites are given for."""
LANDMARK = 0.015
"""Metres that a marker is off from bone felt through the skin, at the end of a segment."""


@dataclass(frozen=True)
class Site:
    """A place on a segment.

    Attributes
    ----------
    segment
        Name of the segment, without side.
    along
        Share of its bone, from its start (metres for a hand).
    outer, front, up
        Metres from there.
    spread
        Metres: how far off a marker of that name usually is (standard deviation).
    """

    segment: str
    along: float = 0.0
    outer: float = 0.0
    front: float = 0.0
    up: float = 0.0
    spread: float = 0.03


# What a label without side and punctuation starts with, and the site. The first that fits counts.
_SIDED = (
    (r"hjc|hip$|hipjoint|hipcent", Site("thigh", spread=0.015)),
    (r"kjc|kneejoint|kneecent", Site("thigh", 1.0, spread=0.015)),
    (r"ajc|anklejoint|anklecent", Site("shank", 1.0, spread=0.015)),
    (r"sjc|shoulderjoint", Site("upper arm", spread=0.02)),
    (r"ejc|elbowjoint", Site("upper arm", 1.0, spread=0.015)),
    (r"wjc|wristjoint", Site("forearm", 1.0, spread=0.015)),
    (r"fhd|fronthead|headfront|temple", Site("head", 0, 0.075, 0.095, 0.125, 0.05)),
    (r"bhd|backhead|headback", Site("head", 0, 0.06, -0.035, 0.085, 0.05)),
    (r"ear|hed|head", Site("head", 0, 0.08, 0.01, 0.08, 0.05)),
    (
        r"asi|fwt|iliacfront|frontwaist|waistfront|waistlfront",
        Site("pelvis", 0, 0.125, 0.06, 0.085),
    ),
    (r"psi|bwt|backwaist|waistback|post(sup)?iliac", Site("pelvis", 0, 0.045, -0.125, 0.09)),
    (r"ash$|ashv", Site("clavicle", 0, 0.0, 0.05, 0.0)),
    (r"psh$|pshv", Site("clavicle", 0, 0.0, -0.05, 0.0)),
    (r"sho|shd|acr", Site("clavicle", 0, -0.02, 0.0, 0.045)),
    (r"bac|bak|scap|tricepback", Site("chest", 0, 0.085, -0.10, -0.03, 0.05)),
    (
        r"lel|elbout|elbowout|elbowlat|elblat|lelb|lelbow",
        Site("upper arm", 1.0, 0.035, spread=LANDMARK),
    ),
    (
        r"mel|elbin|elbowin|elbowmed|elbmed|melb|melbow",
        Site("upper arm", 1.0, -0.035, spread=LANDMARK),
    ),
    (r"elb", Site("upper arm", 1.0, 0.045, spread=LANDMARK)),
    (r"upa|ua\d|uarm|upperarm|tricep|bicep|^arm", Site("upper arm", 0.5, 0.05, spread=0.05)),
    (
        r"wra|lwr|wristin|wrthumb|wristrad|faradius|radius",
        Site("forearm", 1.0, 0.03, 0.05, spread=LANDMARK),
    ),
    (
        r"wrb|mwr|wristout|wrpinky|wristuln|faulna|ulna",
        Site("forearm", 1.0, 0.03, -0.055, spread=LANDMARK),
    ),
    (r"wr", Site("forearm", 1.0, 0.02, spread=0.04)),
    (r"frm|fore|fa\D|frarm|lowerarm", Site("forearm", 0.5, 0.03, spread=0.05)),
    (r"fin|hand|hnd|ind|knu|mcp", Site("hand", 0.08, 0.028, spread=0.04)),
    (r"thm|thumb", Site("hand", 0.05, 0.0, 0.05, spread=0.04)),
    (r"pnk|pinky", Site("hand", 0.06, 0.01, -0.04, spread=0.04)),
    (r"mkne|mfc|kneemed|kneein|medknee", Site("thigh", 1.0, -0.05, spread=LANDMARK)),
    (r"kne|lfc|lkne", Site("thigh", 1.0, 0.06, spread=LANDMARK)),
    (
        r"thi|th\d|thigh|upperleg|upleg|postfem|antfem",
        Site("thigh", 0.55, 0.085, -0.01, spread=0.06),
    ),
    (r"mank|mmal|anklemed|anklein|medankle|mma", Site("shank", 1.0, -0.04, spread=LANDMARK)),
    (r"ank|lmal|mal|lank", Site("shank", 1.0, 0.045, spread=LANDMARK)),
    (
        r"tib|tb\d|shn|shin|shank|sh\d|posttib|anttib|lowerleg",
        Site("shank", 0.45, 0.07, -0.01, spread=0.06),
    ),
    (r"hee|cal|heel", Site("foot", 0, 0.0, -0.045, -0.035)),
    (r"mt5|5met|met5|smalltoe|toeout|forefoot5|fifth", Site("foot", 0, 0.065, 0.11, -0.04)),
    (r"mt1|1met|met1|toein|forefoot1|first", Site("foot", 0, -0.03, 0.12, -0.06)),
    (r"toe|bigtoe|mt2|met2|2met|forefoot|foot", Site("foot", 0, 0.01, 0.16, -0.04)),
)
_MIDDLE = (
    (r"midhip|midpelvis", Site("pelvis", spread=0.02)),
    (r"midasi", Site("pelvis", 0, 0, 0.065, 0.07)),
    (r"midpsi|sac|mwt|waistback|hipsback", Site("pelvis", 0, 0, -0.12, 0.08)),
    (r"c7", Site("chest", 0, 0, -0.05, 0.075)),
    (r"t10|t8|t12|spinelow|backl", Site("chest", 0, 0, -0.095, -0.14, 0.04)),
    (r"t2|t3|t4|t5|backr|spinetop", Site("chest", 0, 0, -0.10, -0.03, 0.04)),
    (r"clav|jug|ij|chesttop", Site("chest", 0, 0, 0.08, 0.0)),
    (r"strn|ster|xiph|chest", Site("chest", 0, 0, 0.125, -0.17, 0.04)),
    (r"neck|nck", Site("chest", spread=0.04)),
    (r"forehead|fhd|headfront|nose|nas", Site("head", 0, 0, 0.11, 0.10, 0.05)),
    (r"(headtop|tophead|head|hed)$", Site("head", 0, 0, 0, 0.18, 0.06)),
    (r"bkhd|bhd|headback", Site("head", 0, 0, -0.10, 0.10, 0.05)),
)
# Markerless tracking calls a joint's own centre by its plain name; the same name with a suffix
# is a place on the skin.
_CENTRES = {
    "shoulder": Site("upper arm", spread=0.02),
    "elbow": Site("upper arm", 1.0, spread=0.02),
    "wrist": Site("forearm", 1.0, spread=0.02),
    "hip": Site("thigh", spread=0.02),
    "knee": Site("thigh", 1.0, spread=0.02),
    "ankle": Site("shank", 1.0, spread=0.02),
}


def site_of(label: str) -> tuple[str, Site] | None:
    """Return the side (``"left"``, ``"right"`` or ``""``) and the site of a marker, if known."""
    name = bare(label)
    for pattern, site in _MIDDLE:
        if re.match(pattern, name):
            return "", site
    side, part = split_side(name)
    if not side:
        return None
    if part in _CENTRES and not label.lower().endswith("_study"):
        return side, _CENTRES[part]
    for pattern, site in _SIDED:
        if re.match(pattern, part):
            return side, site
    return None
