"""What a decision, a step of the frame and a session file cost with 400 flags on 20,000 frames."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from mocapstudio.cleaning.model import Flag, Kind, Proposal
from mocapstudio.cleaning.parameters import DetectionParameters
from mocapstudio.evaluation.demo.skeleton import demo_skeleton
from mocapstudio.motion.take import Take
from mocapstudio.review import session_file
from mocapstudio.review.document import Document
from mocapstudio.review.journal import Journal

FRAMES, FLAGS = 20_000, 400


@dataclass(frozen=True, eq=False)
class Raised:
    """An analysis that raised given flags."""

    take: Take
    flags: tuple[Flag, ...]
    context: tuple[Take, ...] = ()
    parameters: DetectionParameters = field(default_factory=DetectionParameters)

    def with_threshold(self, threshold: float) -> Raised:
        return replace(self, parameters=replace(self.parameters, threshold=threshold))


@pytest.fixture
def document(tmp_path: Path):
    """Half of the flags are accepted; a journal is kept."""
    skeleton = demo_skeleton()
    still = np.tile([0.0, 0.0, 0.0, 1.0], (FRAMES, len(skeleton), 1))
    take = Take("long", skeleton, still, np.zeros((FRAMES, 1, 3)), Fraction(120))
    document = Document("ana")
    document.open_take(take)
    journal = Journal(document, tmp_path / "state")
    flags = []
    for n in range(FLAGS):
        joint, start = skeleton.names[n % len(skeleton)], n * (FRAMES - 100) // FLAGS
        span = (start, start + 30, 1.0, start, 1 - n / FLAGS)
        flags.append(Flag(f"{joint}:{start}", joint, (joint,), *span, Kind.SPIKE))
    document.finish_analysis("long", document.begin_analysis("long"), Raised(take, tuple(flags)))
    for one in flags:
        samples = np.tile([0.6, 0.0, 0.0, 0.8], (30, 1, 1))
        made = Proposal((one.joint,), one.start, one.end, samples, None, "neighbours")
        document.set_proposal(one.id, None, made)
    document.accept([one.id for one in flags[::2]])
    yield document
    journal.close()


def test_accept_and_undo(benchmark, document: Document) -> None:
    one = document.state.queue[1].flag.id

    def decide() -> None:
        document.accept(one)
        document.result("long")
        document.undo()

    benchmark(decide)
    assert document.state.can_redo is not None


def test_step_a_frame(benchmark, document: Document) -> None:
    def step() -> None:
        document.set_frame((document.state.frame + 1) % FRAMES)

    benchmark(step)


def test_save(benchmark, document: Document, tmp_path: Path) -> None:
    benchmark(session_file.save, document, tmp_path / "one.mocapstudio")
    assert not document.state.dirty
