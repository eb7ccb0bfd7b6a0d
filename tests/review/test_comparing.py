"""The document of a comparison sitting: performances, play heads, segments, undo."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_comparison import comparison, shortened
from made_takes import walking

from mocapstudio.comparison.model import Segment
from mocapstudio.motion.errors import MocapError
from mocapstudio.review.comparing import MOST_SOURCES, Comparing, Linked
from mocapstudio.review.comparing_matrix import pooled_distances
from mocapstudio.review.comparing_segments import with_segment
from mocapstudio.review.comparing_state import only_heads_differ

REFERENCE, SOURCE = 300, 240


@pytest.fixture(scope="module")
def walk():
    return walking(seconds=3.2, rate=100)


@pytest.fixture
def sitting(walk) -> Comparing:
    """A teacher of 300 frames and a pupil of 240, compared."""
    made = Comparing()
    made.set_reference(shortened(walk, REFERENCE, "teacher"))
    made.add_sources([shortened(walk, SOURCE, "pupil")])
    assert made.finish(made.pending()[0], comparison((REFERENCE, SOURCE)))
    return made


def test_the_first_source_is_chosen_and_shown_whole(walk):
    made = Comparing()
    made.set_reference(shortened(walk, REFERENCE, "teacher"))
    ids = made.add_sources([shortened(walk, 100, "a"), shortened(walk, 120, "b")])
    assert ids == ("a", "b")
    assert made.state.chosen == "a"
    assert made.state.shown == (-0.5, 99.5)
    assert [one.id for one in made.pending()] == ["a", "b"]


def test_sources_of_one_name_are_told_apart(walk):
    made = Comparing()
    made.add_sources([shortened(walk, 50, "kata"), shortened(walk, 60, "kata")])
    assert made.add_sources([shortened(walk, 70, "kata")]) == ("kata 3",)
    assert [one.id for one in made.state.sources] == ["kata", "kata 2", "kata 3"]


def test_at_most_eight_sources(walk):
    made = Comparing()
    made.add_sources([shortened(walk, 50, "kata")] * MOST_SOURCES)
    before = made.state
    with pytest.raises(MocapError, match="9 sources"):
        made.add_sources([shortened(walk, 50, "one more")])
    assert made.state is before


def test_either_play_head_moves_the_other(sitting):
    sitting.go(150)
    assert sitting.state.source_frame == pytest.approx(150 * 239 / 299, abs=1)
    sitting.go_source(0)
    assert sitting.state.frame == 0
    sitting.go_source(10_000)
    assert (sitting.state.frame, sitting.state.source_frame) == (REFERENCE - 1, SOURCE - 1)
    sitting.go_both(10, 200)
    assert (sitting.state.frame, sitting.state.source_frame) == (10, 200)


def test_moving_a_head_changes_nothing_else(sitting):
    heard = []
    sitting.subscribe(lambda old, new: heard.append(only_heads_differ(old, new)))
    sitting.go(20)
    sitting.go(20)
    sitting.go_source(30)
    sitting.select_row("Head")
    assert heard == [True, True, False]


def test_a_new_reference_voids_results_and_segments(sitting, walk):
    sitting.add_segment(10, 50, "step")
    stale = sitting.pending()
    source = sitting.state.source
    sitting.set_reference(shortened(walk, 200, "other"))
    assert stale == ()
    assert sitting.state.linked is None
    assert sitting.state.segments == ()
    assert [one.id for one in sitting.pending()] == ["pupil"]
    assert not sitting.finish(source, comparison()), "a result for the old reference is stale"
    assert sitting.state.linked is None


def test_results_for_other_parameters_are_stale(sitting):
    sitting.set_parameters(replace(sitting.state.parameters, true_speed=True))
    asked = sitting.pending()[0]
    sitting.set_parameters(replace(sitting.state.parameters, true_speed=False))
    assert not sitting.finish(asked, comparison())
    assert sitting.finish(sitting.pending()[0], comparison())


def test_what_cannot_be_compared_is_not_asked_again(sitting, walk):
    sitting.add_sources([shortened(walk, 90, "horse")])
    assert sitting.fail(sitting.pending()[0], "another skeleton")
    assert sitting.pending() == ()
    assert sitting.state.ranking[-1].failure == "another skeleton"


def test_the_most_alike_ranks_first(sitting, walk):
    sitting.add_sources([shortened(walk, SOURCE, "far"), shortened(walk, SOURCE, "near")])
    for one, offset in zip(sitting.pending(), (0.3, 0.0), strict=True):
        sitting.finish(one, comparison((REFERENCE, SOURCE), offset=offset + 0.001))
    assert [one.id for one in sitting.state.ranking] == ["pupil", "near", "far"]


def test_another_source_keeps_the_moment_and_the_stretch(sitting, walk):
    sitting.add_sources([shortened(walk, 150, "quick")])
    sitting.finish(sitting.pending()[0], comparison((REFERENCE, 150)))
    sitting.go(200)
    sitting.show(100.0, 140.0)
    sitting.choose("quick")
    assert sitting.state.frame == 200
    assert sitting.state.source_frame == pytest.approx(100, abs=1)
    start, end = sitting.state.shown
    assert start == pytest.approx(100 * 150 / 240, abs=2)
    assert end == pytest.approx(140 * 150 / 240, abs=2)


def test_removing_the_chosen_source_chooses_the_next(sitting, walk):
    sitting.add_sources([shortened(walk, 150, "quick")])
    sitting.remove("pupil")
    assert sitting.state.chosen == "quick"
    sitting.remove("quick")
    assert (sitting.state.chosen, sitting.state.sources) == ("", ())


def test_swapping_twice_gives_the_same_pair(sitting):
    teacher, pupil = sitting.state.reference, sitting.state.source.take
    sitting.swap()
    assert (sitting.state.reference, sitting.state.source.take) == (pupil, teacher)
    assert sitting.state.linked is None
    sitting.swap()
    assert (sitting.state.reference, sitting.state.source.take) == (teacher, pupil)


def test_segments_are_undone_and_redone(sitting):
    sitting.add_segment(10, 50, "one")
    sitting.add_segment(80, 120, "two")
    sitting.rename_segment(0, "uno")
    sitting.move_segment(1, 90, 130)
    sitting.delete_segment(0)
    assert sitting.state.segments == (Segment("two", 90, 130),)
    states = []
    while sitting.state.can_undo is not None:
        states.append(sitting.state.segments)
        sitting.undo()
    assert sitting.state.segments == ()
    assert len(states) == 5
    for segments in reversed(states):
        sitting.redo()
        assert sitting.state.segments == segments
    assert sitting.state.can_redo is None


def test_clearing_begins_anew(sitting):
    sitting.add_segment(10, 50, "one")
    sitting.select_row("Head")
    sitting.clear()
    state = sitting.state
    assert (state.reference, state.sources, state.segments) == (None, (), ())
    assert (state.can_undo, state.row, state.unsaved) == (None, None, False)


def test_saved_segments_are_not_unsaved(sitting, tmp_path):
    sitting.add_segment(10, 50, "one")
    assert sitting.state.unsaved
    sitting.mark_saved(tmp_path / "labels.json")
    assert not sitting.state.unsaved
    sitting.rename_segment(0, "uno")
    assert sitting.state.unsaved
    sitting.undo()
    assert not sitting.state.unsaved


@pytest.mark.parametrize("span", [(-5, 10), (20, 20), (290, 301)])
def test_a_segment_outside_the_reference_is_refused(sitting, span):
    before = sitting.state
    with pytest.raises(MocapError, match=r"outside|empty"):
        sitting.set_segments([Segment("x", *span)], "Load")
    assert sitting.state.segments == before.segments
    assert sitting.state.can_undo is None


spans = st.tuples(st.integers(0, 99), st.integers(1, 40)).map(lambda s: (s[0], s[0] + s[1]))


@settings(max_examples=60)
@given(st.lists(spans, max_size=8), spans)
def test_a_new_segment_lies_whole_and_no_two_overlap(old, new):
    segments: tuple[Segment, ...] = ()
    for number, (start, end) in enumerate(old):
        segments = with_segment(segments, Segment(str(number), start, end))
    last = Segment("new", *new)
    segments = with_segment(segments, last)
    assert last in segments
    covered = [set(range(one.start, one.end)) for one in segments]
    assert sum(map(len, covered)) == len(set().union(*covered))
    assert all(one.start < one.end for one in segments)
    # Nothing is named that nobody named.
    assert set().union(*covered) <= {f for s, e in [*old, new] for f in range(s, e)}


def test_the_walk_along_the_path_waits_for_whoever_moves():
    def warp(n):
        return np.where(n < 50, n, np.where(n < 100, 50.0, n - 50))

    both = Linked(comparison((151, 201), warp=warp))
    # The pupil stands still for half a second: the teacher waits, and all frames are seen.
    assert both.duration == pytest.approx(2.0, abs=0.02)
    assert both.at(0.0) == (0, 0)
    frame, source = both.at(0.75)
    assert frame == pytest.approx(50, abs=1)
    assert source == pytest.approx(75, abs=1)
    assert both.at(99.0) == (150, 200)
    assert both.seconds_at(*both.at(1.3)) == pytest.approx(1.3, abs=0.011)


def test_matched_frames_agree_from_both_sides():
    both = Linked(comparison((300, 240), warp=lambda n: 299 * (n / 239) ** 1.3))
    for source in range(0, 240, 7):
        there = both.reference_of(source)
        assert both.source_of(there) == pytest.approx(source, abs=2)
        assert int(both.matched[there]) == both.source_of(there)
    assert both.nearest(both.comparison.path[100, 0], both.comparison.path[100, 1]) == tuple(
        both.comparison.path[100]
    )


def test_pooled_distances_are_those_of_mean_poses():
    both = comparison((60, 45))
    whole = pooled_distances(both, (-0.5, 59.5), (-0.5, 44.5), most=500)
    ours, theirs = both.reference_poses.reshape(60, -1), both.source_poses.reshape(45, -1)
    expected = np.linalg.norm(ours[:, None] - theirs[None], axis=2)
    np.testing.assert_allclose(whole.values, expected, atol=2e-3)
    few = pooled_distances(both, (-0.5, 59.5), (-0.5, 44.5), most=20)
    assert few.values.shape == (20, 15)
    mean = np.linalg.norm(ours[3:6].mean(axis=0) - theirs[6:9].mean(axis=0))
    assert few.values[1, 2] == pytest.approx(mean, abs=2e-3)
    near = pooled_distances(both, (20, 30), (10, 20), most=100)
    assert near.reference == (20, 1)
    np.testing.assert_allclose(near.values, expected[20:31, 10:21], atol=2e-3)


def test_parameters_are_undone_and_void_what_they_change(sitting):
    first = sitting.state.parameters
    sitting.add_segment(10, 50, "step")
    sitting.set_parameters(replace(first, features="root"))
    assert sitting.state.linked is None
    assert sitting.state.can_undo == "Change Poses"
    assert sitting.finish(sitting.pending()[0], comparison((REFERENCE, SOURCE)))
    sitting.undo()
    assert sitting.state.parameters == first
    assert sitting.state.linked is None
    assert [one.name for one in sitting.state.segments] == ["step"]
    sitting.redo()
    assert sitting.state.parameters.features == "root"
    sitting.set_parameters(first)
    assert sitting.state.parameters == first


def test_another_tolerance_only_times_anew(sitting):
    path = sitting.state.comparison.path
    for tolerance in (0.2, 0.3, 0.4):
        sitting.set_parameters(replace(sitting.state.parameters, tolerance=tolerance))
        assert sitting.state.comparison.path is path
    sitting.undo()
    assert sitting.state.parameters.tolerance == 0.1, "steps of one field are one step"


def test_what_failed_can_be_tried_again(sitting, walk):
    sitting.add_sources([shortened(walk, 90, "horse")])
    sitting.fail(sitting.pending()[0], "cancelled")
    sitting.compare_again()
    assert [one.id for one in sitting.pending()] == ["horse"]
    assert sitting.state.linked is not None, "what was compared stays"
