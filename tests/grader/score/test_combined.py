"""Several trials make one score: the weakest of each check."""

import hashlib

from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.exercise import CheckSpec
from gz_course.grader.score.check import Finding
from gz_course.grader.score.combined import combined
from gz_course.grader.score.consequences import CheckResult, shared
from gz_course.grader.score.score import Score


def scored(*passes, name="t", outcome="graded"):
    checks = tuple(
        CheckResult(
            CheckSpec(f"c{i}", "A title", 10 * (i + 1), "change", "A hint."), Finding(passed, "so", f"in {name}")
        )
        for i, passed in enumerate(passes)
    )
    return Score(checks, outcome, "" if all(passes) else f"fault of {name}", f"hash of {name}")


def test_one_trial_is_its_own_score():
    only = scored(True, False)
    assert combined([("public", only)]) is only


def test_a_check_passes_only_if_it_passes_everywhere():
    verdict = combined([("one", scored(True, True, name="one")), ("two", scored(True, False, name="two"))])
    assert [check.points for check in verdict.checks] == [10, 0]
    assert verdict.checks[1].finding.measured == "in the trial two: in two"
    assert verdict.diagnosis == "In the trial two: fault of two"


def test_what_passes_everywhere_is_told_as_the_first_trial_found_it():
    verdict = combined([("one", scored(True, name="one")), ("two", scored(True, name="two"))])
    assert (verdict.checks[0].finding.measured, verdict.diagnosis) == ("in one", "")


def test_what_fails_everywhere_is_told_as_the_first_trial_found_it():
    verdict = combined([("one", scored(False, name="one")), ("two", scored(False, name="two"))])
    assert (verdict.checks[0].finding.measured, verdict.diagnosis) == ("in one", "fault of one")


def test_the_first_outcome_that_is_not_graded_is_that_of_all():
    trials = [scored(True), scored(False, outcome="timeout"), scored(False, outcome="memory")]
    assert combined([(str(i), each) for i, each in enumerate(trials)]).outcome == "timeout"


def test_the_hash_is_over_the_hashes_in_their_order():
    one, two = scored(True, name="one"), scored(True, name="two")
    digest = hashlib.sha256(b"hash of onehash of two").hexdigest()
    assert combined([("one", one), ("two", two)]).truth_sha256 == digest
    assert combined([("two", two), ("one", one)]).truth_sha256 != digest


PASSES = st.integers(1, 5).flatmap(
    lambda n: st.lists(st.lists(st.booleans(), min_size=n, max_size=n), min_size=1, max_size=5)
)


@given(PASSES)
def test_no_trial_can_raise_a_score(rows):
    trials = [(str(i), scored(*row)) for i, row in enumerate(rows)]
    verdict = combined(trials)
    assert [check.finding.passed for check in verdict.checks] == [all(column) for column in zip(*rows, strict=True)]
    assert verdict.points <= min(score.points for _, score in trials)
    assert bool(verdict.diagnosis) == (verdict.points < sum(check.spec.points for check in verdict.checks))


def failing(name, *after):
    """A score of two checks that fail, the second as a consequence of `after`, and one that passes."""
    failed = [("a", 30, ()), ("b", 50, after)]
    checks = [
        CheckResult(
            CheckSpec(id, "A title", points, "change", ("A hint.",), {}, after), Finding(False, "so", f"in {name}")
        )
        for id, points, after in failed
    ]
    passed = CheckResult(CheckSpec("c", "A title", 20, "change", ("A hint.",)), Finding(True, "so", "so"))
    return Score(shared([*checks, passed]), "graded", f"fault of {name}", f"hash of {name}")


def test_what_failed_checks_keep_is_no_more_than_in_the_worst_trial():
    linked, apart = failing("one", "a"), failing("two")
    assert (linked.points, apart.points) == (60, 20)
    assert combined([("one", linked), ("two", linked)]).points == 60
    for order in ([("one", linked), ("two", apart)], [("two", apart), ("one", linked)]):
        assert combined(order).points == 20
