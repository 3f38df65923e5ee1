"""The ladder of points: over all rejected variants, one misconception costs at most 40 of 100 points.

What a variant really loses is measured by `course verify`. Here it is what its declared checks cost if all of them had
something to look at.
"""

import pytest

from gz_course.grader.exercise import exercise_names, find_exercise
from gz_course.grader.score.check import Finding
from gz_course.grader.score.consequences import MOST_FOR_ONE, CheckResult, links, shared
from gz_course.grader.verify import variants
from gz_course.grader.verify.proof import NEARLY_ALL
from gz_course.tests.import_arrows import ROOT

EXERCISES = exercise_names(ROOT)
each_exercise = pytest.mark.parametrize("name", EXERCISES)


def rejected(exercise):
    return [each for each in variants(exercise) if each.name.startswith("rejected/")]


def cost(exercise, fails):
    """The points that a set of failed checks costs."""
    results = [CheckResult(spec, Finding(spec.id not in fails, "so", "not so")) for spec in exercise.checks]
    return exercise.max_score - sum(each.points for each in shared(results))


@each_exercise
def test_the_points_make_a_hundred(name):
    assert find_exercise(name, ROOT).max_score == 100


@each_exercise
def test_one_misconception_costs_at_most_forty(name):
    exercise = find_exercise(name, ROOT)
    costs = {each.name: cost(exercise, each.fails) for each in rejected(exercise) if not each.nothing_runs}
    assert {variant: points for variant, points in costs.items() if points > MOST_FOR_ONE * 100} == {}


@each_exercise
def test_nothing_runs_is_said_only_of_what_loses_nearly_all(name):
    exercise = find_exercise(name, ROOT)
    worth = {check.id: check.points for check in exercise.checks}
    for each in rejected(exercise):
        if each.nothing_runs:
            assert sum(worth[id] for id in each.fails) >= NEARLY_ALL * 100, each.name
    assert sum(not each.nothing_runs for each in rejected(exercise)) >= 3


@each_exercise
def test_what_follows_from_a_check_comes_from_one_that_there_is(name):
    checks = {check.id: check for check in find_exercise(name, ROOT).checks}
    assert {id for check in checks.values() for id in links(check)} <= checks.keys()
