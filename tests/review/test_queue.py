from __future__ import annotations

from dataclasses import replace

from hypothesis import given
from hypothesis import strategies as st
from review_pieces import flag

from mocapstudio.cleaning.model import Kind
from mocapstudio.review.model import Decision, Verdict
from mocapstudio.review.queue import Queue, succeeds


def merge(flags, decisions):
    return Queue(flags).merged(decisions)


def _decided(one, verdict=Verdict.REJECTED, time="2026-01-01T00:00:00Z"):
    return Decision("walk", one, verdict, "ana", time)


def test_worst_first_then_deferred_then_no_longer_flagged() -> None:
    worst, middle, least = (
        flag("Hips", 0, 9, 0.9),
        flag("Spine", 0, 9, 0.5),
        flag("Spine", 20, 29, 0.2),
    )
    gone = flag("LeftLeg", 40, 50, 1.0)
    decisions = [_decided(worst, Verdict.DEFERRED), _decided(gone, Verdict.ACCEPTED)]
    queue = merge([least, worst, middle], decisions)
    assert [item.flag for item in queue] == [middle, least, worst, gone]
    assert [item.current for item in queue] == [True, True, True, False]
    assert queue[-1].verdict is Verdict.ACCEPTED


def test_a_verdict_passes_on_to_a_shifted_flag_of_the_same_joint_only() -> None:
    decision = _decided(flag("Spine", 10, 20))
    shifted, elsewhere = flag("Spine", 12, 23), flag("Hips", 10, 20)
    queue = merge([shifted, elsewhere], [decision])
    verdicts = {item.flag.joint: item.verdict for item in queue}
    assert verdicts == {"Spine": Verdict.REJECTED, "Hips": Verdict.OPEN}
    assert all(item.current for item in queue)


def test_a_rejected_blip_does_not_speak_for_a_long_flag_around_it() -> None:
    blip = flag("Spine", 100, 105)
    long = flag("Spine", 60, 200, peak=150)
    assert not succeeds(long, blip)
    queue = merge([long], [_decided(blip)])
    assert {(i.flag.id, i.verdict, i.current) for i in queue} == {
        (long.id, Verdict.OPEN, True),
        (blip.id, Verdict.REJECTED, False),
    }


def test_a_flag_that_grew_around_its_own_peak_keeps_its_verdict() -> None:
    small, large = flag("Spine", 100, 105, peak=102), flag("Spine", 80, 140, peak=102)
    assert [i.verdict for i in merge([large], [_decided(small)])] == [Verdict.REJECTED]


def test_ids_stay_apart_where_an_old_flag_began_at_the_same_frame() -> None:
    old, new = flag("Spine", 100, 105), flag("Spine", 100, 200, peak=190)
    assert old.id == new.id
    queue = merge([new], [_decided(old)])
    assert len({item.flag.id for item in queue}) == 2
    assert queue[0].flag.id == new.id


def test_the_better_fit_wins_and_the_other_stays_listed() -> None:
    left, right = flag("Spine", 10, 20), flag("Spine", 22, 40)
    merged = flag("Spine", 10, 40, peak=30)
    queue = merge([merged], [_decided(left, Verdict.ACCEPTED), _decided(right)])
    assert [(i.verdict, i.current) for i in queue] == [
        (Verdict.REJECTED, True),
        (Verdict.ACCEPTED, False),
    ]


def test_of_equal_fits_the_later_decision_holds() -> None:
    one = flag("Spine", 10, 20)
    queue = merge([one], [_decided(one), _decided(one, Verdict.ACCEPTED)])
    assert [(i.verdict, i.current) for i in queue] == [
        (Verdict.ACCEPTED, True),
        (Verdict.REJECTED, False),
    ]


def test_a_decision_on_a_flag_that_is_there_speaks_for_no_other() -> None:
    drift, pop = (
        flag("Spine", 10, 40, kind=Kind.DRIFT, peak=25),
        flag("Spine", 24, 26, kind=Kind.POP),
    )
    for decided, other in ((drift, pop), (pop, drift)):
        verdicts = {i.flag.id: i.verdict for i in merge([drift, pop], [_decided(decided)])}
        assert verdicts == {decided.id: Verdict.REJECTED, other.id: Verdict.OPEN}


_flags = st.builds(
    lambda joint, start, length, score: flag(joint, start, start + length, score),
    st.sampled_from(["Hips", "Spine"]),
    st.integers(0, 60),
    st.integers(1, 40),
    st.floats(0, 1),
)


@given(
    st.lists(_flags, max_size=8, unique_by=lambda one: one.id),
    st.lists(st.tuples(_flags, st.sampled_from(list(Verdict)[1:])), max_size=8),
    st.randoms(),
)
def test_nothing_gets_lost_and_order_does_not_matter(flags, decided, random) -> None:
    decisions = [_decided(one, verdict) for one, verdict in decided]
    queue = merge(flags, decisions)
    assert sorted(i.flag.id for i in queue if i.current) == sorted(one.id for one in flags)
    assert len({item.flag.id for item in queue}) == len(queue)
    shown = {id(item.decision) for item in queue if item.decision is not None}
    assert shown == {id(decision) for decision in decisions}
    for item in queue:
        if item.decision is not None:
            assert item.verdict is item.decision.verdict
            assert item.flag.joint == item.decision.flag.joint
            if item.current:
                assert item.flag.overlaps(item.decision.flag.start, item.decision.flag.end)
            else:
                assert replace(item.flag, id="") == replace(item.decision.flag, id="")
    shuffled = list(flags)
    random.shuffle(shuffled)
    assert merge(shuffled, decisions) == queue
