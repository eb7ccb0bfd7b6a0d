"""Random intents, and what must hold whatever they are."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np
from hypothesis import HealthCheck, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule
from review_pieces import ROWS, analysed, flag, proposal, random_map, small_take

from mocapstudio.formats.changes import covered
from mocapstudio.motion.errors import MocapError
from mocapstudio.review import session_file
from mocapstudio.review.document import Document
from mocapstudio.review.history import same
from mocapstudio.review.model import Edit, Sitting, Verdict

_FRAMES = 60
_rows = st.frozensets(st.sampled_from(ROWS), max_size=3)
_picks = st.lists(st.integers(0, 30), min_size=1, max_size=4)
_frames = st.integers(-2, _FRAMES + 2)


class Sittings(RuleBasedStateMachine):
    @initialize(seed=st.integers(0, 9))
    def start(self, seed: int) -> None:
        self.document = Document("ana")
        self.heard = self.document.state
        self.document.subscribe(self.hear)
        self.take = small_take(frames=_FRAMES, seed=seed)
        self.document.open_take(self.take)
        self.source = self.take.rotations.copy(), self.take.translations.copy()
        self.analyse(seed)
        self.seed = seed

    def hear(self, old, new) -> None:
        assert old is self.heard
        assert old is not new
        self.heard = new

    def ids(self, picks) -> list[str]:
        queue = self.document.state.queue
        return [queue[n % len(queue)].flag.id for n in picks] if queue else []

    def attempt(self, intent, *arguments) -> None:
        before, result = self.document.state, self.document.result("walk")
        closed = covered(self.take, self.document.protected("walk"))
        try:
            intent(*arguments)
        except MocapError:
            assert self.document.state is before
        after = self.document.result("walk")
        for mask, ours, theirs in (
            (closed.rotations, result.rotations, after.rotations),
            (closed.translations, result.translations, after.translations),
        ):
            assert np.array_equal(ours[mask], theirs[mask]), "a protected sample changed"

    def offer(self, ids) -> None:
        for one in ids:
            self.seed += 1
            item = self.document.state.item(one)
            made = proposal(self.take, item.flag, self.seed, pad=self.seed % 3)
            assert self.document.set_proposal(one, self.seed % 5, made)

    @rule(seed=st.integers(0, 20))
    def analyse(self, seed: int) -> None:
        found = analysed(self.take, random_map(self.take, seed), 0.5)
        generation = self.document.begin_analysis("walk")
        assert self.document.finish_analysis("walk", generation, found)

    @rule(x=st.floats(0.05, 0.95))
    def threshold(self, x: float) -> None:
        self.document.set_threshold(x)

    @rule(picks=_picks)
    def accept(self, picks) -> None:
        self.offer(ids := self.ids(picks))
        self.attempt(self.document.accept, ids)

    @rule(picks=_picks, word=st.sampled_from(["reject", "defer", "reopen"]))
    def judge(self, picks, word: str) -> None:
        self.attempt(getattr(self.document, word), self.ids(picks))

    @rule(pick=st.integers(0, 30), band=st.floats(0, 1))
    def reject_like(self, pick: int, band: float) -> None:
        for one in self.ids([pick]):
            self.attempt(self.document.reject_like, one, band)

    @rule(picks=_picks)
    def several_at_once(self, picks) -> None:
        ids = self.ids(picks)
        self.offer(ids)
        before = self.document.state.sitting
        try:
            with self.document.group("Several"):
                self.document.accept(ids[:1])
                self.document.trim(0, _FRAMES // 2)
                self.document.reject(ids[1:])
        except MocapError:
            assert self.document.state.sitting is before

    @rule(rows=_rows, start=_frames, end=_frames)
    def protect(self, rows, start: int, end: int) -> None:
        self.attempt(self.document.protect, rows, start, end)

    @rule(rows=_rows, start=_frames, end=_frames)
    def unprotect(self, rows, start: int, end: int) -> None:
        self.attempt(self.document.unprotect, rows, start, end)

    @rule(start=_frames, end=_frames)
    def trim(self, start: int, end: int) -> None:
        self.attempt(self.document.trim, start, end)

    @rule(row=st.sampled_from(ROWS), start=st.integers(0, 50), seed=st.integers(0, 99))
    def edit_freely(self, row: str, start: int, seed: int) -> None:
        self.attempt(self.document.add_edit, proposal(self.take, flag(row, start, start + 5), seed))

    @rule(n=st.integers(0, 30), muted=st.booleans())
    def mute(self, n: int, muted: bool) -> None:
        if edits := self.document.state.sitting.edits:
            self.attempt(self.document.mute_edit, edits[n % len(edits)].id, muted)

    @rule(n=st.integers(0, 30))
    def delete(self, n: int) -> None:
        if edits := self.document.state.sitting.edits:
            self.attempt(self.document.delete_edit, edits[n % len(edits)].id)

    @rule(n=st.integers(0, 30))
    def walk(self, n: int) -> None:
        if queue := self.document.state.queue:
            self.document.select_flag(queue[n % len(queue)].flag.id)

    @rule()
    def undo(self) -> None:
        self.document.undo()

    @rule()
    def redo(self) -> None:
        self.document.redo()

    @rule()
    def save_and_load(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "sitting.mocapstudio"
            session_file.save(self.document, path)
            loaded = session_file.load(path)
        assert loaded.state.problems == ()
        assert_alike(loaded.state.sitting, self.document.state.sitting)
        assert loaded.state.queue == self.document.state.queue
        assert loaded.state.selection == self.document.state.selection
        assert loaded.state.choices == self.document.state.choices
        assert loaded.state.parameters == self.document.state.parameters
        ours, theirs = self.document.result("walk"), loaded.result("walk")
        assert np.array_equal(ours.rotations, theirs.rotations)
        assert np.array_equal(ours.translations, theirs.translations)
        assert ours.trim == theirs.trim

    @invariant()
    def listeners_know_the_state(self) -> None:
        assert self.heard is self.document.state

    @invariant()
    def only_declared_samples_differ(self) -> None:
        result = self.document.result("walk")
        allowed = covered(self.take, self.document.declared("walk"))
        rotations, translations = self.source
        assert np.array_equal(self.take.rotations, rotations), "the source was written to"
        assert np.array_equal(self.take.translations, translations), "the source was written to"
        assert np.array_equal(result.rotations[~allowed.rotations], rotations[~allowed.rotations])
        untouched = ~allowed.translations
        assert np.array_equal(result.translations[untouched], translations[untouched])

    @invariant()
    def the_result_is_what_the_list_says(self) -> None:
        rotations, translations = self.source[0].copy(), self.source[1].copy()
        for edit in self.document.state.sitting.edits:
            if edit.muted:
                continue
            for f in range(edit.start, edit.end):
                for j, name in enumerate(edit.joints):
                    rotations[f, self.take.skeleton.names.index(name)] = edit.rotations[
                        f - edit.start, j
                    ]
                if edit.translations is not None:
                    translations[f, 0] = edit.translations[f - edit.start]
        result = self.document.result("walk")
        assert np.array_equal(result.rotations, rotations)
        assert np.array_equal(result.translations, translations)

    @invariant()
    def every_decision_and_every_flag_is_in_the_queue(self) -> None:
        state = self.document.state
        shown = {id(i.decision) for i in state.queue if i.decision is not None}
        assert shown == {id(decision) for decision in state.sitting.decisions}
        current = sorted(i.flag.id for i in state.queue if i.current)
        assert current == sorted(one.id for one in state.analysis.flags)
        assert len({i.flag.id for i in state.queue}) == len(state.queue)

    @invariant()
    def accepted_flags_and_edits_belong_together(self) -> None:
        sitting = self.document.state.sitting
        edits = {edit.id: edit for edit in sitting.edits}
        assert len(edits) == len(sitting.edits)
        linked = [d.edit for d in sitting.decisions if d.verdict is Verdict.ACCEPTED]
        assert all(one in edits for one in linked)
        assert len(set(linked)) == len(linked)
        assert {e.id for e in sitting.edits if e.flag is not None} == set(linked)
        assert all(d.edit is None for d in sitting.decisions if d.verdict is not Verdict.ACCEPTED)

    def teardown(self) -> None:
        if not hasattr(self, "document"):
            return
        document = self.document
        while document.state.can_redo:
            document.redo()
        end = document.state.sitting
        ended = document.result("walk")
        steps = 0
        while document.state.can_undo:
            document.undo()
            self.only_declared_samples_differ()
            steps += 1
        assert same(document.state.sitting, Sitting())
        begun = document.result("walk")
        assert begun.rotations is self.take.rotations
        assert begun.translations is self.take.translations
        for _ in range(steps):
            document.redo()
        assert document.state.sitting is end
        assert np.array_equal(document.result("walk").rotations, ended.rotations)
        assert np.array_equal(document.result("walk").translations, ended.translations)


def assert_alike(ours: Sitting, theirs: Sitting) -> None:
    """Everything is equal, samples bit for bit."""
    assert ours.decisions == theirs.decisions
    assert ours.protected == theirs.protected
    assert ours.trims == theirs.trims
    assert [_plain(e) for e in ours.edits] == [_plain(e) for e in theirs.edits]


def _plain(edit: Edit) -> dict[str, object]:
    values = dict(vars(edit))
    for name in ("rotations", "translations"):
        samples = values.pop(name)
        values[name] = None if samples is None else (samples.shape, samples.tobytes())
    return values


TestSittings = Sittings.TestCase
TestSittings.settings = settings(
    max_examples=40,
    stateful_step_count=30,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
)
