"""Hands of two dancers that hold each other: marked by eye, and found."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mocapstudio import formats
from mocapstudio.cleaning.contacts.detection import detect_contacts
from mocapstudio.cleaning.contacts.model import Contact, Following
from mocapstudio.evaluation.contacts_cases import Mask, below, mask_of, parsed
from mocapstudio.evaluation.contacts_scoring import ContactScores, Tally, tally, tolerated
from mocapstudio.motion.errors import FileError
from mocapstudio.motion.take import Take

Detector = Callable[[Take, Take], Sequence[Contact]]


@dataclass(frozen=True, eq=False)
class HandCase:
    """Two dancers, and when which hand of the one holds which of the other.

    Parameters
    ----------
    take, partner
        F frames each.
    truth
        (F,) held or not, by joint of the one and joint of the other.
    sure
        (F,) frames in which that is known.
    """

    take: Take
    partner: Take
    truth: Mapping[tuple[str, str], Mask]
    sure: Mapping[tuple[str, str], Mask]


def marked_hands(data: Sequence[Path], labels: Path) -> list[HandCase]:
    """Read hands that were marked by eye; takes that are not below `data` are left out.

    Parameters
    ----------
    data
        Folders of takes.
    labels
        A file of marked contacts or of marked hands, or a folder of them, with those of hands in
        its folder ``hands``: ``{"take", "partner", "span", "held", "unsure"}``.

    Raises
    ------
    FileError
        If a file holds no such labels.
    """
    files = sorted({*labels.glob("*.json"), *labels.glob("hands/*.json")})
    cases = []
    for file in files if labels.is_dir() else [labels]:
        record = parsed(file)
        if "held" not in record:
            continue
        try:
            paths = [below(data, record[name]) for name in ("take", "partner")]
            if paths[0] is not None and paths[1] is not None:
                one, other = (formats.read(path)[0][0] for path in paths if path is not None)
                cases.append(_marked(one, other, record))
        except (KeyError, TypeError, ValueError, AttributeError) as cause:
            raise FileError(file, f"does not hold marked hands: {cause}") from cause
    return cases


def _marked(take: Take, partner: Take, record: Mapping[str, Any]) -> HandCase:
    truth, sure = {}, {}
    for name, spans in record["held"].items():
        one, other = name.split(" ")
        truth[one, other] = mask_of(take.frames, spans)
        sure[one, other] = mask_of(take.frames, [record["span"]])
        sure[one, other] &= ~mask_of(take.frames, record["unsure"].get(name, []))
    return HandCase(take, partner, truth, sure)


def score_hands(
    name: str, cases: Sequence[HandCase], detector: Detector | None = None
) -> ContactScores:
    """Run a detector over pairs, by default ours, and add its scores up.

    Right is only the very hand that is held: another one of the partner's counts as found wrongly.
    """
    detector = detector or _ours
    tolerant, strict, worst = Tally(), Tally(), (1.0, "")
    for case in cases:
        found, own, rate = detector(case.take, case.partner), Tally(), float(case.take.rate)
        for pair, truth in case.truth.items():
            spans = [(c.start, c.end) for c in found if _pair(c) == pair]
            claimed = mask_of(case.take.frames, spans)
            strict += tally(claimed, truth, case.sure[pair], rate)
            own += tally(claimed, truth, tolerated(truth, case.sure[pair], rate), rate)
        tolerant += own
        worst = min(worst, (own.f1, case.take.name))
    return ContactScores(name, tolerant, strict, {"palm": tolerant}, worst)


def _ours(take: Take, partner: Take) -> Sequence[Contact]:
    return detect_contacts(take, (partner,))


def _pair(contact: Contact) -> tuple[str, str]:
    target = contact.target
    return contact.joint, target.joint if isinstance(target, Following) else ""
