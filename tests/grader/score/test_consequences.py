"""Checks that fail for one cause share its cost; others lose all of their points."""

import itertools

import pytest

from gz_course.grader.exercise import CheckSpec
from gz_course.grader.score.check import Finding
from gz_course.grader.score.consequences import CheckResult, shared


def check(id, points, passed=False, after=(), gate=(), gated=False, nothing=False, why=""):
    """A check that passed or failed, perhaps with an explanation."""
    parameters = {"gate": [{"check": each, "otherwise": "it failed"} for each in gate]} if gate else {}
    spec = CheckSpec(id, id.title(), points, "change", ("A hint.",), parameters, tuple(after))
    return CheckResult(spec, Finding(passed, "so", "not so", gated=gated, explanation=why, nothing=nothing))


def points(*checks):
    return [each.points for each in shared(checks)]


PASSED = check("c", 20, passed=True)


def test_a_cause_costs_forty_of_a_hundred_with_all_that_follows_from_it():
    assert points(check("a", 30), check("b", 50, after=["a"]), PASSED) == [15, 25, 20]
    assert points(check("a", 30), check("b", 50, gate=["a"], gated=True), PASSED) == [15, 25, 20]


def test_what_follows_from_what_follows_shares_the_cost():
    chain = check("b", 30, after=["a"]), check("c", 20, after=["b"])
    assert points(check("a", 30), *chain, check("d", 20, passed=True)) == [15, 15, 10, 20]


@pytest.mark.parametrize("why", [*itertools.product(["", "degrees", "swapped"], repeat=2)])
def test_what_the_feedback_says_changes_no_point(why):
    first, second = why
    assert points(check("a", 30, why=first), check("b", 50, why=second), PASSED) == [0, 0, 20], "two causes"
    assert points(check("a", 30, why=first), check("b", 50, after=["a"], why=second), PASSED) == [15, 25, 20]


def test_what_had_nothing_to_look_at_is_no_cause():
    assert points(check("a", 30, gated=True), check("b", 50, gate=["a"], gated=True), PASSED) == [0, 0, 20]
    assert points(check("a", 30, nothing=True), check("b", 50, gate=["a"], gated=True), PASSED) == [0, 0, 20]
    assert points(check("a", 30, nothing=True), check("b", 50, after=["a"]), PASSED) == [0, 0, 20], "b is alone"


def test_what_follows_from_a_check_that_passed_is_a_cause_itself():
    assert points(check("a", 40, passed=True), check("b", 40, after=["a"]), PASSED) == [40, 0, 20]


def test_nothing_is_kept_where_a_cause_costs_no_more():
    assert points(check("a", 20), check("b", 20, after=["a"]), check("c", 60, passed=True)) == [0, 0, 60]


@pytest.mark.parametrize("rest", [(29, 51), (33, 47), (1, 79), (40, 40)])
def test_the_parts_are_whole_and_make_forty(rest):
    a, b, c = points(check("a", rest[0]), check("b", rest[1], after=["a"]), PASSED)
    assert sum(rest) - a - b == 40 and a == int(a) and b == int(b) and c == 20


def test_checks_that_follow_from_each_other():
    assert points(check("a", 40, after=["b"]), check("b", 40, after=["a"]), PASSED) == [20, 20, 20]


def test_who_passes_nothing_earns_nothing():
    assert points(check("a", 50), check("b", 50, after=["a"])) == [0, 0]
