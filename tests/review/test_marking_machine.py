"""Random edits over marker takes, and what must hold whatever they are."""

from __future__ import annotations

import tempfile
from fractions import Fraction
from pathlib import Path

import numpy as np
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule

from mocapstudio.motion.errors import MocapError
from mocapstudio.motion.markers import MarkerTake
from mocapstudio.review import session_file
from mocapstudio.review.document import Document
from mocapstudio.review.history import same
from mocapstudio.review.marker_model import Fill, MarkerEditKind
from mocapstudio.review.model import Sitting

_FRAMES, _LABELS = 24, ("a", "b", "c")
_frames = st.integers(-1, _FRAMES + 1)
_labels = st.sampled_from(_LABELS)


def _take(seed: int) -> MarkerTake:
    random = np.random.default_rng(seed)
    places = random.normal(0, 1, (_FRAMES, len(_LABELS), 3))
    places[random.random(places.shape[:2]) < 0.3] = np.nan
    filled = random.random(places.shape[:2]) < 0.1
    return MarkerTake("m", _LABELS, places, Fraction(30), filled=filled if seed % 2 else None)


class Markings(RuleBasedStateMachine):
    @initialize(seed=st.integers(0, 9))
    def start(self, seed: int) -> None:
        self.document = Document("ana")
        self.take = _take(seed)
        self.kept = self.take.positions.copy()
        self.name = self.document.open_markers(self.take)
        self.random = np.random.default_rng(seed)

    def attempt(self, intent, *arguments) -> None:
        before = self.document.state
        try:
            intent(self.name, *arguments)
        except MocapError:
            assert self.document.state is before

    def edit(self, n: int) -> str:
        edits = self.document.state.sitting.marker_edits
        return edits[n % len(edits)].id if edits else ""

    @rule(label=_labels, start=_frames, length=st.integers(0, 9), part=st.booleans())
    def fill(self, label: str, start: int, length: int, part: bool) -> None:
        samples = self.random.normal(0, 1, (length, 3))
        samples[: length // 2 if part else 0] = np.nan
        one = Fill(label, start, start + length, samples)
        self.attempt(self.document.fill_gaps, (one,), "spline")

    @rule(one=_labels, other=_labels, start=_frames, end=_frames)
    def exchange(self, one: str, other: str, start: int, end: int) -> None:
        self.attempt(self.document.exchange_markers, one, other, start, end)

    @rule(labels=st.lists(_labels, max_size=2), start=_frames, end=_frames)
    def clear(self, labels, start: int, end: int) -> None:
        self.attempt(self.document.clear_markers, labels, start, end)

    @rule(n=st.integers(0, 30), muted=st.booleans())
    def mute(self, n: int, muted: bool) -> None:
        if one := self.edit(n):
            self.document.mute_marker_edit(one, muted)

    @rule(n=st.integers(0, 30))
    def delete(self, n: int) -> None:
        if one := self.edit(n):
            self.document.delete_marker_edits([one])

    @rule()
    def undo(self) -> None:
        self.document.undo()

    @rule()
    def redo(self) -> None:
        self.document.redo()

    @rule()
    def there_and_back(self) -> None:
        sitting = self.document.state.sitting
        steps = 0
        while self.document.state.can_undo:
            self.document.undo()
            steps += 1
        assert same(self.document.state.sitting, Sitting())
        assert self.document.marker_result(self.name) is self.take
        for _ in range(steps):
            self.document.redo()
        assert same(self.document.state.sitting, sitting)

    @rule()
    def save_and_load(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "sitting.mocapstudio"
            session_file.save(self.document, path)
            loaded = session_file.load(path)
        ours, theirs = (one.marker_result(self.name) for one in (self.document, loaded))
        assert np.array_equal(ours.positions, theirs.positions, equal_nan=True)
        assert np.array_equal(_mask(ours), _mask(theirs))
        assert [e.id for e in loaded.marker_edits(self.name)] == [
            e.id for e in self.document.marker_edits(self.name)
        ]

    @invariant()
    def the_source_is_what_it_was(self) -> None:
        assert np.array_equal(self.take.positions, self.kept, equal_nan=True)

    @invariant()
    def nothing_changes_that_was_not_declared(self) -> None:
        result = self.document.marker_result(self.name)
        declared = np.zeros((_FRAMES, len(_LABELS)), dtype=bool)
        for one in self.document.marker_declared(self.name):
            declared[one.start : one.end, _LABELS.index(one.row)] = True
        rest = ~declared
        assert np.array_equal(result.positions[rest], self.kept[rest], equal_nan=True)
        assert np.array_equal(_mask(result)[rest], _mask(self.take)[rest])

    @invariant()
    def every_measured_sample_is_one_of_that_frame(self) -> None:
        """Whatever is exchanged, and in whatever order: what is not filled was measured."""
        result = self.document.marker_result(self.name)
        frames, markers = np.nonzero(~result.missing & ~_mask(result))
        same_place = self.kept[frames] == result.positions[frames, markers][:, None]
        assert same_place.all(axis=2).any(axis=1).all()

    @invariant()
    def fills_alone_hold_samples(self) -> None:
        for edit in self.document.marker_edits(self.name):
            assert (edit.positions is not None) == (edit.kind is MarkerEditKind.FILL)


def _mask(take: MarkerTake) -> np.ndarray:
    return np.zeros(take.missing.shape, dtype=bool) if take.filled is None else take.filled


TestMarkings = Markings.TestCase
TestMarkings.settings = settings(
    max_examples=15,
    stateful_step_count=25,
    deadline=None,
    suppress_health_check=list(HealthCheck),
)
