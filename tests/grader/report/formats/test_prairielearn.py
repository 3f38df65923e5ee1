"""PrairieLearn's results.json: what its schema wants, and a score that is a part of full marks."""

import base64
import dataclasses
from xml.etree import ElementTree as XML

import pytest
from hypothesis import HealthCheck, given, settings

from gz_course.grader.report.formats import prairielearn
from gz_course.grader.report.formats.prairielearn import as_prairielearn
from gz_course.tests.grader.prairielearn_results import read
from gz_course.tests.grader.report.handmade import nasty, result, score_of


def test_it_holds_every_check(make_report):
    data = read(as_prairielearn(make_report()))
    assert (data["gradable"], data["score"]) == (True, 0.5)
    good, bad = data["tests"]
    assert (good["name"], good["points"], good["max_points"], good["message"]) == ("Title of good", 50, 50, "")
    assert (bad["description"], bad["points"], bad["message"]) == ("is 0.5", 0, "Hint for bad.")
    assert bad["output"] == "measured: was 0.5\nwhen: 1.25 s of simulated time"
    assert data["message"].startswith("The bad one: was 0.5. 50 of 100 points.")


def test_the_picture_is_a_drawing_of_the_run(make_report, monkeypatch):
    report = make_report()
    (picture,) = read(as_prairielearn(report))["images"]
    drawing = XML.fromstring(base64.b64decode(picture["url"].partition(",")[2]))
    assert drawing.tag == "{http://www.w3.org/2000/svg}svg" and picture["label"] == "The run from above"
    monkeypatch.setattr(prairielearn, "LARGEST", 3_000)
    assert read(as_prairielearn(report))["images"] == [], "PrairieLearn takes no more than 1 MB"


def test_what_could_not_start_costs_no_attempt(not_run):
    data = read(as_prairielearn(not_run))
    assert data["gradable"] is False and data["format_errors"] == ["node.py, line 3: SyntaxError: expected ':'"]


@pytest.mark.parametrize("outcome", ["timeout", "memory", "protocol", "tamper", "student_error"])
def test_what_ran_and_failed_is_an_attempt(make_report, outcome):
    report = make_report(score_of(result("good", False), outcome=outcome, diagnosis="No."))
    assert read(as_prairielearn(report)) | {"gradable": True, "score": 0} == read(as_prairielearn(report))


def test_full_marks_are_one_and_a_recording_scored_again_says_the_same(make_report):
    report = make_report(score_of(result("a", True), result("b", True)), lines=[(1.0, "hello")])
    assert read(as_prairielearn(report))["score"] == 1 and "hello" not in as_prairielearn(report)
    assert as_prairielearn(dataclasses.replace(report, host=None)) == as_prairielearn(report)


@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(text=nasty)
def test_whatever_a_student_writes_it_can_be_read(make_report, text):
    score = score_of(result("good", True), result("bad", False, text), diagnosis=text)
    written = as_prairielearn(make_report(score, submission=text, versions={"mujoco": text}))
    assert "\\u0000" not in written
    read(written)
