"""The report as data: the documented keys, and nothing that another program could not read."""

import dataclasses
import json
import math
import pickle

import pytest
from hypothesis import given

from gz_course.grader.exercise import CheckSpec
from gz_course.grader.report.report import points
from gz_course.grader.score.check import Finding
from gz_course.grader.score.consequences import CheckResult
from gz_course.tests.grader.report.handmade import REPORT, nasty, result, score_of

KEYS = {
    "exercise", "submission", "score", "max_score", "outcome", "checks", "trials", "sandbox", "pace", "recording",
    "truth_sha256", "sim_seconds", "run_wall_seconds", "wall_seconds", "real_time_factor", "versions",
}  # fmt: skip
CHECK_KEYS = {"id", "title", "points", "max_points", "status", "expected", "measured", "at_s", "hint"}


def test_the_keys_are_the_documented_ones():
    data = json.loads(REPORT.as_json())
    assert data.keys() >= KEYS
    assert [check.keys() for check in data["checks"]] == [CHECK_KEYS, CHECK_KEYS]


def test_the_values():
    data = json.loads(REPORT.as_json())
    assert (data["score"], data["max_score"], data["outcome"]) == (50, 100, "graded")
    assert (data["real_time_factor"], data["run_wall_seconds"], data["wall_seconds"]) == (16.0, 0.5, 2.0)
    trial = {"name": "public", "seed": 3, "score": 50, "outcome": "graded"}
    (found,) = data["trials"]
    assert found.items() >= (trial | {"recording": "runs/03_teleop.rrd", "truth_sha256": "ab" * 32}).items()
    assert [(check["id"], check["status"]) for check in found["checks"]] == [("good", "passed"), ("bad", "failed")]
    good, bad = data["checks"]
    assert (good["status"], good["points"], good["at_s"], good["hint"]) == ("passed", 50, 1.25, None)
    assert (bad["status"], bad["points"], bad["at_s"], bad["hint"]) == ("failed", 0, 1.25, "Hint for bad.")


def test_without_host_facts_they_are_null():
    data = json.loads(dataclasses.replace(REPORT, host=None).as_json())
    assert data.keys() >= KEYS
    assert [data[key] for key in ("sandbox", "pace", "run_wall_seconds", "wall_seconds", "real_time_factor")] == [
        None
    ] * 5


def test_a_run_that_took_no_time_has_no_real_time_factor():
    host = dataclasses.replace(REPORT.host, run_wall_seconds=0.0)
    assert json.loads(dataclasses.replace(REPORT, host=host).as_json())["real_time_factor"] is None


def test_full_marks():
    assert not REPORT.full_marks
    perfect = dataclasses.replace(REPORT.score, checks=(result("a", True), result("b", True)))
    assert dataclasses.replace(REPORT, score=perfect).full_marks


def test_full_marks_do_not_hang_on_rounding():
    spec = CheckSpec("a", "A", 0.1, "change", ("",))
    checks = tuple(CheckResult(dataclasses.replace(spec, points=p), Finding(True, "", "")) for p in (0.1, 0.2, 0.3))
    report = dataclasses.replace(REPORT, score=dataclasses.replace(REPORT.score, checks=checks), max_score=0.6)
    assert report.full_marks


def test_the_trial_to_look_at_is_the_first_that_lost_points():
    fine = dataclasses.replace(REPORT.trials[0], score=score_of(result("a", True), result("b", True)))
    assert dataclasses.replace(REPORT, trials=(fine, *REPORT.trials)).shown_trial is REPORT.trials[0]
    assert dataclasses.replace(REPORT, trials=(fine, fine)).shown_trial is fine


def test_what_there_is_to_say_about_a_check():
    bad, good = result("bad", False), result("good", True, at_s=None)
    brief = [("expected", "is 0.5"), ("measured", "was 0.5")]
    when = ("when", "1.25 s of simulated time")
    assert REPORT.told(bad) == [*brief, when, ("hint", "Hint for bad.")]
    assert REPORT.told(good) == brief
    tampered = dataclasses.replace(REPORT, score=dataclasses.replace(REPORT.score, outcome="tamper"))
    for report in (tampered, dataclasses.replace(REPORT, sim_seconds=0.0)):
        assert report.told(bad) == [*brief, when], "something else is to be mended first"


@pytest.mark.parametrize(("value", "text"), [(60.0, "60"), (0.1 + 0.2, "0.3"), (12.5, "12.5"), (100, "100")])
def test_points_as_they_are_written(value, text):
    assert points(value) == text


def test_notes_are_in_it():
    assert json.loads(dataclasses.replace(REPORT, notes=("changed",)).as_json())["notes"] == ["changed"]


def no_such_number(text):
    raise AssertionError(f"{text} is no JSON")


@given(nasty)
def test_whatever_is_in_it_every_program_can_read_it(text):
    score = score_of(result("good", True), result("bad", False, text, at_s=math.inf), diagnosis=text)
    report = dataclasses.replace(REPORT, score=score, submission=text, versions={"mujoco": text})
    data = json.loads(report.as_json(), parse_constant=no_such_number)
    assert data["checks"][1]["at_s"] is None
    for said in (data["checks"][1]["measured"], data["submission"], data["diagnosis"], data["versions"]["mujoco"]):
        said.encode()
        assert len(said) == len(text) and not [c for c in said if c < " " and c not in "\t\n\r"]


def test_a_recording_is_read_once_and_stays_behind_when_a_report_travels(make_report):
    trial = make_report().trials[0]
    read = trial.content()
    kept = dataclasses.replace(trial, read=read)
    assert kept.content() is read and kept == trial
    travelled = pickle.loads(pickle.dumps(kept))
    assert travelled == trial and travelled.read is None


def test_the_report_says_what_a_failed_check_keeps():
    spec = CheckSpec("a", "A", 30, "change", ("A hint.",))
    for kept, said in (
        (15.0, ["15 of 30 points: all checks together lose at most 40 % for one misconception"]),
        (0.0, []),
    ):
        check = CheckResult(spec, Finding(False, "so", "not so"), kept)
        assert [text for name, text in REPORT.told(check) if name == "kept"] == said
