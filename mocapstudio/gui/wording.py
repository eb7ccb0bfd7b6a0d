"""How the desk says things: times, frames, and why a span was flagged."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from mocapstudio.cleaning.contacts.model import ENDS_KEPT, ON_CONTACTS
from mocapstudio.cleaning.model import DigressionMap, Flag, Kind, Neighbour
from mocapstudio.formats import Recording
from mocapstudio.motion.facing import ROOT_POSITION
from mocapstudio.motion.take import Take

_MEANING = {
    Kind.SPIKE: "It leaves the motion and comes straight back: a spike, as from a marker lost or "
    "confused for a moment.",
    Kind.OFFSET: "It is turned by a steady amount: an offset, as from a marker that slipped or was "
    "mislabelled.",
    Kind.FREEZE: "It stands still while its neighbours move: a freeze, as from a lost signal.",
    Kind.NOISE: "It trembles where its neighbours run smoothly: noise.",
    Kind.GAP: "It runs straight through where its neighbours curve: a filled gap.",
    Kind.DRIFT: "It moves slowly away from its neighbours: a drift.",
    Kind.SWAP: "It follows its mirror image: left and right look swapped.",
    Kind.FLIP: "It turns over between two frames: a flip.",
    Kind.LIMB: "Several joints of the limb depart together.",
    Kind.POP: "It jumps from one frame to the next: a pop.",
    Kind.JITTER: "It shakes faster than a body can: jitter.",
    Kind.ROOT_POP: "The hips jump from one frame to the next.",
    Kind.HEIGHT_DRIFT: "The hips rise or sink against the floor: the height drifts.",
    Kind.HEADING_FLIP: "The body turns about between two frames: the heading flips.",
}


def number(take: Recording, frame: int) -> int:
    """Return the file's own number of a 0-based frame."""
    return take.first_frame + frame


def seconds(take: Recording, frame: float) -> str:
    """Write the time of a 0-based frame."""
    return f"{take.seconds(frame):.2f} s"


def span(take: Recording, start: int, end: int) -> str:
    """Write a half-open span as time, length and the file's own frame numbers."""
    length = take.seconds(end - start)
    first, last = number(take, start), number(take, end - 1)
    frames = f"frame {first}" if first == last else f"frames {first}–{last}"
    return f"{take.seconds(start):.2f}–{take.seconds(end):.2f} s ({length:.2f} s, {frames})"


def rate(take: Recording) -> str:
    """Write the rate as users know it: 120 Hz, 119.88 Hz."""
    return f"{float(take.rate):.2f}".rstrip("0").rstrip(".") + " Hz"


def departure(flag: Flag, mapped: DigressionMap) -> tuple[float, str] | None:
    """Return how far the flagged row departs at most, and the unit; None where it is unmapped."""
    if flag.joint not in mapped.rows:
        return None
    row = mapped.rows.index(flag.joint)
    residuals = mapped.residuals[flag.start : flag.end, row]
    unit = "cm" if flag.joint == ROOT_POSITION else "°"
    return float(residuals.max()), unit


def explain(flag: Flag, take: Take, mapped: DigressionMap, neighbours: Sequence[Neighbour]) -> str:
    """Say in plain words why a span was flagged."""
    length = take.seconds(flag.end - flag.start)
    far = departure(flag, mapped)
    how_far = "departs" if far is None else f"departs up to {_amount(*far)}"
    count = len(neighbours)
    whom = f"its {count} nearest neighbours" if count > 1 else "its nearest neighbour"
    if not count:
        whom = "what this motion does elsewhere"
    text = f"{flag.joint} {how_far} from {whom} for {length:.2f} s. {_MEANING[flag.kind]}"
    others = [joint for joint in flag.joints if joint != flag.joint]
    if others:
        text += f" {_list(others)} {'departs' if len(others) == 1 else 'depart'} with it."
    return text


def displacement(moved: Mapping[str, float]) -> str:
    """Say how far hands, feet and head move with a proposal, largest first."""
    largest = sorted(moved.items(), key=lambda item: -item[1])
    seen = [f"{name} {100 * metres:.1f} cm" for name, metres in largest if metres >= 0.0005]
    return ", ".join(seen) if seen else "hands, feet and head stay where they are"


def method(name: str) -> str:
    """Say how replacement motion was made."""
    words = {
        "neighbours": "motion of a neighbour, blended at both ends",
        "prediction": "what the other joints let expect, led into both ends",
        "interpolation": "interpolated across the span",
        "turned back": "turned back by the angle of the flip",
        "swap": "left and right swapped back",
        ENDS_KEPT: "hands and feet kept where they were",
        ON_CONTACTS: "brought to what it touches",
        "contacts": "bent to meet contacts",
    }
    return "; ".join(words.get(one, one) for one in name.split(", "))


def time_left(left: float | None) -> str:
    """Write the time that long work still needs; empty while unknown."""
    if left is None:
        return ""
    if left < 1:
        return "under a second left"
    if left < 90:
        return f"{left:.0f} s left"
    return f"{left / 60:.0f} min left"


def _amount(value: float, unit: str) -> str:
    return f"{value:.0f}{unit}" if unit == "°" else f"{value:.1f} {unit}"


def _list(words: Sequence[str]) -> str:
    if len(words) > 4:
        return f"{', '.join(words[:3])} and {len(words) - 3} more"
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
