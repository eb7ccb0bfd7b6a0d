"""What live mode says in words, and which class of timing it is. No Qt."""

from __future__ import annotations

from mocapstudio.comparison.labels import Labels
from mocapstudio.comparison.live import Note
from mocapstudio.comparison.online_begin import Following
from mocapstudio.gui.compare.live_bridge import LiveShown, Phase
from mocapstudio.gui.plots.ticks import clock
from mocapstudio.review.comparing import ComparingState

_KINDS = {1: "early", 0: "on time", -1: "late"}
_NOTES = {
    Note.REPEATED: "repeated",
    Note.LATE: "out of order",
    Note.UNSEEN: "unseen",
    Note.BRIDGED: "bridged",
    Note.GAP: "long gaps",
    Note.RESTARTED: "clock set back",
}


def timing_kind(ahead: float | None, tolerance: float) -> int:
    """Tell whether a performer is early (1), late (-1) or on time (0)."""
    if ahead is None or abs(ahead) <= tolerance:
        return 0
    return 1 if ahead > 0 else -1


def ahead_words(shown: LiveShown, tolerance: float) -> tuple[str, str, int]:
    """How far ahead the performer is: seconds with their sign, a word, and the class of timing."""
    ahead = None if shown.step is None else shown.step.misalignment
    if ahead is None:
        return "", "", 0
    kind = timing_kind(ahead, tolerance)
    return f"{ahead:+.2f} s".replace("-", "−"), _KINDS[kind], kind


def phase_words(shown: LiveShown) -> str:
    """What live mode is doing."""
    if shown.phase is Phase.PREPARING:
        return "Waiting for frames" if shown.streams else "Preparing"
    if shown.phase is Phase.PAUSED:
        return "Paused"
    if shown.phase is Phase.ENDED:
        return "The stream has ended" if shown.streams else "At the end"
    if shown.now is None or shown.now.following is Following.WAITING:
        return "Waiting for the beginning"
    return "Following"


def segment_words(shown: LiveShown, state: ComparingState) -> str:
    """The segment of the reference that the performer is in, by the reference's segments."""
    if shown.step is None or state.reference is None or not state.segments:
        return ""
    labels = Labels(state.reference.name, state.reference.rate, state.segments)
    return labels.at(shown.step.reference_frame) or "between segments"


def action_words(shown: LiveShown) -> str:
    """Which action it is and since when."""
    now = shown.now
    if now is None or now.action == 0:
        return ""
    since = ""
    if now.began is not None and shown.alignment is not None and shown.seconds is not None:
        ago = (now.frame - now.began) / shown.alignment.aligner.reference.rate
        since = f", began at {clock(max(shown.seconds - ago, 0.0), 0.1)}"
    return f"action {now.action}{since}"


def cost_words(shown: LiveShown) -> str:
    """Cost of the path and of the pose."""
    step = shown.step
    return "" if step is None else f"cost {step.cost:.3f} · pose {step.pose_cost:.3f}"


def note_words(shown: LiveShown) -> str:
    """What was odd about frames, and how often."""
    return " · ".join(f"{count} {_NOTES[note]}" for note, count in shown.notes)


def fault_words(shown: LiveShown) -> str:
    """What is wrong with lines of the stream."""
    if not shown.faults:
        return ""
    more = f" ({shown.faults} bad lines)" if shown.faults > 1 else ""
    return f"{shown.fault}{more}"
