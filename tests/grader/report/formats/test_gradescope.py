"""Gradescope's results.json: its keys and types, and that students' texts are declared to be text."""

import dataclasses
import json

import pytest
from hypothesis import HealthCheck, given, settings

from gz_course.grader.report.formats.gradescope import as_gradescope
from gz_course.tests.grader.report.handmade import nasty, result, score_of

FORMATS = {"text", "html", "simple_format", "md", "ansi"}
VISIBILITIES = {"visible", "hidden", "after_due_date", "after_published"}
# Key -> what its value must be; the top level, then a test.
TOP = {
    "score": (int, float), "execution_time": (int, float), "output": str, "output_format": FORMATS,
    "test_output_format": FORMATS, "test_name_format": FORMATS, "visibility": VISIBILITIES,
    "stdout_visibility": VISIBILITIES, "extra_data": dict, "tests": list, "leaderboard": list,
}  # fmt: skip
TEST = {
    "score": (int, float), "max_score": (int, float), "status": {"passed", "failed"}, "name": str,
    "name_format": FORMATS, "number": str, "output": str, "output_format": FORMATS, "tags": list,
    "visibility": VISIBILITIES, "extra_data": dict,
}  # fmt: skip


def fits(data, shape):
    assert data.keys() <= shape.keys()
    for key, value in data.items():
        wanted = shape[key]
        assert value in wanted if isinstance(wanted, set) else isinstance(value, wanted), (key, value)
        assert not isinstance(value, bool)


def read(text):
    data = json.loads(text)
    fits(data, TOP)
    assert data["tests"]
    for test in data["tests"]:
        fits(test, TEST)
    assert data["output_format"] == data["test_output_format"] == data["test_name_format"] == "text"
    assert data["score"] == pytest.approx(sum(test["score"] for test in data["tests"]))
    return data


def test_it_holds_every_check(make_report):
    data = read(as_gradescope(make_report()))
    good, bad = data["tests"]
    assert (good["number"], good["name"], good["score"], good["max_score"]) == ("1", "Title of good", 50, 50)
    assert (good["status"], bad["status"], bad["score"]) == ("passed", "failed", 0)
    assert bad["output"] == "expected: is 0.5\nmeasured: was 0.5\nwhen: 1.25 s of simulated time\nhint: Hint for bad."
    assert "hint" not in good["output"]
    assert data["execution_time"] == 2.0
    assert data["extra_data"]["outcome"] == "graded" and data["extra_data"]["sandbox"] == "D"


def test_the_first_line_is_the_diagnosis_and_the_last_ones_what_the_node_said(make_report):
    data = read(as_gradescope(make_report(lines=[(i / 100, f"line {i}") for i in range(100)])))
    lines = data["output"].splitlines()
    assert lines[:2] == ["The bad one: was 0.5.", "50 of 100 points. The submission ran to the end and was graded."]
    assert lines[-1].endswith("line 99") and "line 79" not in data["output"]


def test_full_marks_need_no_words(make_report):
    report = make_report(score_of(result("a", True), result("b", True)), lines=[(1.0, "hello")])
    assert read(as_gradescope(report))["output"] == "100 of 100 points. The submission ran to the end and was graded."


def test_it_differs_from_the_first_in_host_facts_only(make_report):
    report = make_report(notes=("Changed.",))
    first, again = (
        json.loads(as_gradescope(r)) for r in (report, dataclasses.replace(report, host=None, submission="x"))
    )
    del first["execution_time"], first["extra_data"]["sandbox"], first["extra_data"]["pace"]
    assert again == first
    assert "Changed." in again["output"]


def test_nothing_was_run(not_run):
    data = read(as_gradescope(not_run))
    assert data["output"].startswith("node.py, line 3: SyntaxError")
    assert [test["score"] for test in data["tests"]] == [0, 0]


@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(text=nasty)
def test_whatever_a_student_writes_it_can_be_read(make_report, text):
    score = score_of(result("good", True), result("bad", False, text), diagnosis=text)
    written = as_gradescope(make_report(score, submission=text, versions={"mujoco": text}))
    written.encode()
    assert "\\u0000" not in written, "databases refuse it"
    read(written)
