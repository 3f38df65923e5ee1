"""Explanations of several questions together, and of questions without an answer or with several."""

import itertools
import math

import numpy as np
import pytest

from gz_course.grader.feedback.predictions.answers import Asked, Explanation, Scans, agreed, explain
from gz_course.tests.grader.feedback.predictions.test_answers import explained, said_of, valid


def only_if_changed(scan, kept):
    value = min(valid(scan))
    if abs(value - kept.get("last", -1.0)) < 0.05:
        return None
    kept["last"] = value
    return value


def only_nearer(scan, kept):
    value = min(valid(scan))
    if value >= kept.get("last", math.inf):
        return None
    kept["last"] = value
    return value


def by_a_timer(scan, kept):
    kept["n"] = kept.get("n", -1) + 1
    return min(valid(scan)) if int(kept["n"] * 0.4) != int((kept["n"] - 1) * 0.4) else None


def timer_with_the_scan_before(scan, kept):
    kept["n"] = kept.get("n", -1) + 1
    last, kept["last"] = kept.get("last"), min(valid(scan))
    return last if kept["n"] % 4 == 3 else None


def test_a_timer_that_answers_with_the_scan_it_has_is_named_alone():
    assert said_of(timer_with_the_scan_before, "minimum") == (
        "your node answered one scan in 4 only, once in 0.4 s: publish and log in the callback of each scan"
    )


@pytest.mark.parametrize(
    ("program", "words"),
    [
        (only_if_changed, "only when the value has changed"),
        (only_nearer, "only when the value is smaller than every one before"),
        (by_a_timer, "at even intervals of about 0.25 s"),
        (
            lambda scan, kept: min(valid(scan)) if min(valid(scan)) < 0.8 else None,
            "only while the nearest distance is below",
        ),
        (lambda scan, kept: min(valid(scan)) if min(valid(scan)) > 0.8 else None, "is above about 0.8"),
        (
            lambda scan, kept: list(valid(scan)),
            "each scan once for every valid ray; one answer belongs after the loop",
        ),
        (lambda scan, kept: list(itertools.accumulate(valid(scan), min)), "only the last answer is right"),
    ],
)
def test_scans_without_an_answer(program, words):
    assert words in said_of(program, "minimum")


def test_scans_that_are_skipped_for_one_of_their_rays_are_named():
    rows = [np.array([2.0, math.inf if i % 3 == 0 else 3.0, 1.0 + 0.1 * i]) for i in range(12)]
    ones, truth = np.ones(12), np.array([row.min() for row in rows])
    there = np.array([math.isfinite(row[1]) for row in rows])
    scans = Scans(rows, 0.1 * ones, 10 * ones, -ones, ones)
    asked = Asked("minimum", np.arange(12.0), truth, np.where(there, truth, np.nan), there, 0.001, scans=scans)
    assert "no scan in which a ray is inf" in str(explain(asked))


def test_what_fits_the_answers_to_most_questions_is_named():
    """The smallest of all ranges does not tell which invalid rays were counted; their number does."""

    def rays(scan):
        return [r for r in scan.ranges if r < 5.0]

    programs = {"minimum": min, "valid_count": len, "mean": lambda values: -math.inf}
    told = [explained(lambda scan, kept, of=of: of(rays(scan)), statistic) for statistic, of in programs.items()]
    assert "below 5 m" not in str(told[0]) and ", or " in str(told[0])
    assert all("-inf included: neither range_min nor range_max" in str(each) for each in agreed(told))
    assert "below 5 m" in str(agreed(told)[1])


def test_explanations_that_have_nothing_in_common_stay():
    both = [explained(lambda scan, kept: max(valid(scan)), "minimum"), Explanation("nothing was logged")]
    assert agreed(both) == both and agreed([]) == []
