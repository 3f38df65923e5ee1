"""Points that fall with an error, weights of trials, and checks that a trial changes."""

import json
from dataclasses import replace

import pytest

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise import CheckSpec, find_exercise
from gz_course.grader.exercise.toml_table import Table
from gz_course.grader.exercise.trial import read_trials, with_parameters
from gz_course.grader.grade import grade_again
from gz_course.grader.score.check import check_kinds, perform
from gz_course.grader.score.combined import WEIGHTED, combined
from gz_course.grader.score.consequences import CheckResult, shared
from gz_course.grader.score.partial import VALUES, Linear
from gz_course.grader.score.score import Score, score

X = "truth/robot/x"
CHANGE = {"signal": X, "band": [0.9, 1.1]}


def spec(id="it", kind="change", points=10, **parameters):
    return CheckSpec(id, id.title(), points, kind, ("Do it.",), parameters)


@pytest.mark.parametrize(
    ("full", "none", "value", "credit"),
    [(0.1, 0.5, 0.1, 1), (0.1, 0.5, 0.05, 1), (0.1, 0.5, 0.3, 0.5), (0.1, 0.5, 0.6, 0), (8, 2, 5, 0.5), (8, 2, 1, 0)],
)
def test_the_points_fall_from_one_bound_to_the_other(record, full, none, value, credit):
    assert Linear(full, none).credit(record(), value) == pytest.approx(credit)


@pytest.mark.parametrize(("moved", "points"), [(1.0, 10), (0.8, 7.5), (0.6, 2.5), (0.4, 0)])
def test_what_a_check_earns_that_fails(record, moved, points):
    recording = record({X: [(0, 0.0), (8, moved)]})
    asked = spec(**CHANGE, linear={"full": 0.9, "none": 0.5})
    assert CheckResult(asked, perform(asked, recording)).points == pytest.approx(points)


def test_any_kind_takes_the_number_of_a_signal(record):
    recording = record({"truth/robot/y": [(0, 0.0), (4, -0.3), (8, 0.1)]})
    never = {"conditions": [{"signal": "truth/robot/y", "high": -0.2}]}
    for take, credit in (("widest", 0.5), ("last", 1.0), ("largest", 1.0), ("mean", 1.0)):
        linear = {"full": 0.1, "none": 0.5, "signal": "truth/robot/y", "take": take}
        assert perform(spec(kind="never", **never, linear=linear), recording).credit == pytest.approx(credit), take
    nowhere = {"full": 0.1, "none": 0.5, "signal": "truth/robot/z"}
    assert perform(spec(kind="never", **never, linear=nowhere), recording).credit == 0


def test_a_closed_gate_earns_nothing(record):
    recording = record({X: [(0, 0.0), (8, 0.8)]})
    gate = {"signal": "truth/robot/distance", "reaches": 1, "otherwise": "it never drove"}
    assert perform(spec(**CHANGE, linear={"full": 0.9, "none": 0.5}, gate=gate), recording).credit == 0


@pytest.mark.parametrize(
    ("kind", "linear", "words"),
    [
        ("never", {"full": 0, "none": 1}, "measures no number"),
        ("change", {"full": 1, "none": 1}, "another number than full"),
        ("change", {"full": 1}, "none"),
        ("change", {"full": 1, "none": 0, "nnoe": 1}, "nnoe"),
        ("change", {"full": 1, "none": 0, "signal": X, "take": "lsat"}, "did you mean 'last'?"),
    ],
)
def test_a_wrong_table_is_named(record, kind, linear, words):
    given = CHANGE if kind == "change" else {"conditions": [{"signal": X, "high": 1}]}
    with pytest.raises(ManifestError, match=words.replace("?", r"\?")):
        perform(spec(kind=kind, **given, linear=linear), record({X: [(0, 0.0)]}))


def test_the_kinds_that_measure_a_number_exist():
    assert set(VALUES) <= set(check_kinds())


def scored(*findings):
    """A score of checks given as (passed, credit)."""
    from gz_course.grader.score.check import Finding

    checks = [
        CheckResult(spec(f"c{i}"), Finding(passed, "so", "so", credit=credit))
        for i, (passed, credit) in enumerate(findings)
    ]
    return Score(shared(checks), "graded", "", "h")


def test_the_least_credit_of_all_trials_counts_without_weights():
    whole = combined([("a", scored((True, 0), (False, 0.5))), ("b", scored((False, 0.8), (False, 0.2)))])
    assert [check.points for check in whole.checks] == [8, 2]


def test_weights_make_a_mean():
    scores = [("a", scored((True, 0), (True, 0))), ("b", scored((False, 0), (True, 0)))]
    whole = combined(scores, [3.0, None])
    assert [check.points for check in whole.checks] == [7.5, 10]
    assert whole.checks[0].why == WEIGHTED and not whole.checks[0].finding.passed
    assert combined(scores).checks[0].points == 0, "without weights the worst counts"


TRIAL = """
[[trial]]
name = "long"
duration = 30.0
weight = 2.0
private = { exit = 3 }

[trial.check.arrives]
band = [4.5, 5.5]
"""


def trial(tmp_path, text=TRIAL):
    import tomllib

    (table,) = tomllib.loads(text)["trial"]
    (found,) = read_trials([Table(table, "trials.toml")], tmp_path / "trials.toml", tmp_path)
    return found


def test_a_trial_changes_parameters_of_a_check(tmp_path, root):
    long = trial(tmp_path)
    assert (long.weight, long.private, long.checks) == (2.0, {"exit": 3}, {"arrives": {"band": [4.5, 5.5]}})
    checks = (spec("arrives", **CHANGE), spec("other", **CHANGE))
    exercise = replace(find_exercise("03", root), checks=checks)
    there = long.applied_to(exercise)
    assert there.checks[0].parameters == {"signal": X, "band": [4.5, 5.5]}
    assert there.checks[1] is checks[1] and there.max_score == exercise.max_score
    assert with_parameters(checks, {}) is checks


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("[trial.check.arrives]", "[trial.check.arives]", ["'long'", "arives", "did you mean 'arrives'?"]),
        ("band =", "points = 50\nband =", ["arrives", "points"]),
    ],
)
def test_a_change_of_what_is_not_a_parameter_is_refused(tmp_path, old, new, words):
    from gz_course.grader.exercise.trial import refuse_unknown_checks

    wrong = trial(tmp_path, TRIAL.replace(old, new))
    with pytest.raises(ManifestError) as caught:
        refuse_unknown_checks((wrong,), (spec("arrives", **CHANGE),))
    assert [word for word in words if word not in str(caught.value)] == []


@pytest.mark.parametrize("weight", ["0", "-1", '"much"'])
def test_a_weight_is_a_number_above_0(tmp_path, weight):
    with pytest.raises(ManifestError, match="weight"):
        trial(tmp_path, TRIAL.replace("2.0", weight))


def test_a_recording_scored_again_has_the_checks_of_its_trial(record, root):
    """The exercise knows no such trial, so that which the recording keeps counts."""
    exercise = find_exercise("03", root)
    first = exercise.checks[0]
    changed = {first.id: {"gate": {"signal": X, "reaches": 99, "otherwise": "too near for this trial"}}}
    kept = {"trial_checks": json.dumps(changed), "trial": "long", "trial_weight": 2.0, "seed": 0}
    plain = record({X: [(0, 0.0), (8, 1.0)]}, exercise=exercise.name, submission="x", trial="long", seed=0)
    made = record({X: [(0, 0.0), (8, 1.0)]}, exercise=exercise.name, submission="x", **kept)
    assert grade_again(made.path, root).score.checks[0].finding.measured == "too near for this trial"
    assert grade_again(plain.path, root).score.checks[0].finding.measured != "too near for this trial"
    assert score(plain, exercise).checks[0].finding.measured != "too near for this trial"
