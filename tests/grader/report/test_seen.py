"""What students see of a report: nothing that a hidden trial or a hidden check gives away."""

import json
import shutil
from dataclasses import replace

import pytest

from gz_course.grader.errors import ManifestError
from gz_course.grader.exercise import find_exercise, load_exercise
from gz_course.grader.exercise.trial import load_trials
from gz_course.grader.exercise.visibility import AFTER, ALWAYS, NEVER
from gz_course.grader.report.formats.gradescope import as_gradescope
from gz_course.grader.report.formats.prairielearn import as_prairielearn
from gz_course.grader.report.seen import Rules, rules_of, seen
from gz_course.grader.score.combined import combined
from gz_course.tests.grader.report.handmade import result, score_of

SECRET = "secret_north"
WORDS = (SECRET, "0.777")


@pytest.fixture
def two_trials(make_report):
    """Make a report on a public trial and a hidden one, in which the check `bad` fails."""

    def make(public_passes, **more):
        public = score_of(result("good", True), result("bad", public_passes, measured="0.5"), diagnosis="Public fault.")
        hidden = score_of(result("good", True), result("bad", False, measured="0.777"), diagnosis="Hidden: 0.777.")
        if public_passes:
            public = score_of(result("good", True), result("bad", True, measured="0.5"))
        both = combined([("public", public), (SECRET, hidden)])
        report = make_report(both, trials=("public", SECRET), scores=(public, hidden), lines=[(1.0, "hello")], **more)
        object.__setattr__(report.trials[1], "visibility", NEVER)
        return report

    return make


@pytest.mark.parametrize("hidden", ["summary", "none"])
@pytest.mark.parametrize("public_passes", [True, False])
def test_nothing_of_a_hidden_trial_is_told(two_trials, hidden, public_passes):
    data = two_trials(public_passes).as_dict()
    told = seen(data, Rules({}, {"public": ALWAYS}, hidden))
    assert not [word for word in WORDS if word in repr(told)]
    bad = told.checks[1]
    assert (bad["status"], bad["points"]) == ("failed", 0) and told.trials == ("public",)
    if not public_passes:
        assert bad["measured"] == "0.5" and told.diagnosis == "In the trial public: Public fault."
    if hidden == "summary":
        assert told.summary == "1 of 1 runs that are not shown lost points."
        assert not public_passes or bad["measured"] == "it failed in a run that is not shown"
    else:
        assert "not shown" not in repr(told)


def test_all_is_what_the_report_says(two_trials):
    data = two_trials(True).as_dict()
    told = seen(data, Rules({"bad": NEVER}, {}, "all"))
    assert told.whole and told.diagnosis == data["diagnosis"] and SECRET in told.diagnosis


def test_a_check_that_is_not_shown_and_one_that_is_after_the_deadline(two_trials):
    data = two_trials(False).as_dict()
    trials = {"public": ALWAYS, SECRET: AFTER}
    before, after = (seen(data, Rules({"bad": AFTER}, trials, due=due)) for due in (False, True))
    assert [check["id"] for check in before.checks] == ["good"] and before.diagnosis == ""
    assert after.whole and after.diagnosis == data["diagnosis"]


def test_an_older_report_without_what_each_trial_found_tells_nothing(two_trials):
    data = json.loads(json.dumps(two_trials(True).as_dict()))
    for trial in data["trials"]:
        del trial["checks"], trial["diagnosis"]
    assert not [word for word in WORDS if word in repr(seen(data, Rules({}, {"public": ALWAYS})))]


@pytest.mark.parametrize("write", [as_gradescope, as_prairielearn])
@pytest.mark.parametrize("public_passes", [True, False])
def test_platforms_show_students_nothing_of_a_hidden_trial(two_trials, write, public_passes):
    data = json.loads(write(two_trials(public_passes)))
    data.pop("extra_data", None)  # which only instructors see
    assert not [word for word in WORDS if word in json.dumps(data)]
    assert "1 of 1 runs that are not shown lost points." in json.dumps(data)
    assert "hello" in data["output"], "the log of the public trial"


def test_gradescope_gets_the_visibility_of_each_check(make_report):
    made = [(result(name, False), value) for name, value in (("a", ALWAYS), ("b", AFTER), ("c", NEVER))]
    checks = [replace(each, spec=replace(each.spec, visibility=value)) for each, value in made]
    data = json.loads(as_gradescope(make_report(score_of(*checks, diagnosis="About c."))))
    assert [test["visibility"] for test in data["tests"]] == ["visible", "after_due_date", "hidden"]
    assert "About c." not in data["output"]


def test_manifest_and_trials_say_it(root, tmp_path, short_course_copy):
    exercise = find_exercise("03_teleop", root)
    rules = rules_of(exercise)
    assert set(rules.trials.values()) == {ALWAYS, NEVER} and rules.trials["quick_clock"] == NEVER
    file = tmp_path / "trials.toml"
    file.write_text('[[trial]]\nname = "a"\nvisibility = "after the deadline"\n[[trial]]\nname = "b"\n')
    assert [trial.visibility for trial in load_trials(file)] == [AFTER, NEVER]
    manifest = short_course_copy / "grading/exercise.toml"
    manifest.write_text(manifest.read_text().replace('id = "stops"', 'id = "stops"\nvisibility = "nevr"'))
    with pytest.raises(ManifestError, match=r"did you mean 'never'"):
        load_exercise(short_course_copy)


@pytest.fixture
def short_course_copy(root, tmp_path):
    shutil.copytree(root / "exercises/03_teleop", tmp_path / "exercises/03_teleop")
    return tmp_path / "exercises/03_teleop"
