"""JUnit XML: the shape that continuous integration reads, and nothing in it that XML cannot hold."""

import dataclasses
from xml.etree import ElementTree as XML

import pytest
from hypothesis import HealthCheck, given, settings

from gz_course.grader.report.formats.junit import as_junit
from gz_course.tests.grader.report.handmade import NASTY, nasty, result, score_of

COUNTS = {"name", "tests", "failures", "errors", "skipped", "time"}
# Element -> attributes it must have, and the children it may have.
SHAPE = {
    "testsuites": (COUNTS, {"testsuite"}),
    "testsuite": (COUNTS, {"properties", "testcase", "system-out", "system-err"}),
    "properties": (set(), {"property"}),
    "property": ({"name", "value"}, set()),
    "testcase": ({"classname", "name", "time"}, {"failure", "error"}),
    "failure": ({"message", "type"}, set()),
    "error": ({"message", "type"}, set()),
    "system-out": (set(), set()),
}


def read(text):
    """Parse it as a strict reader would, and compare shape and counts."""
    root = XML.fromstring(text.encode())
    assert text.startswith('<?xml version="1.0" encoding="utf-8"?>\n<testsuites ')
    for element in root.iter():
        attributes, children = SHAPE[element.tag]
        assert set(element.attrib) == attributes, element.tag
        assert {child.tag for child in element} <= children, element.tag
    (suite,) = root
    cases = suite.findall("testcase")
    for top in (root, suite):
        assert int(top.get("tests")) == len(cases)
        assert int(top.get("failures")) == len(suite.findall("testcase/failure"))
        assert int(top.get("errors")) == len(suite.findall("testcase/error"))
        assert float(top.get("time")) >= 0
    return suite


def properties(suite):
    return {p.get("name"): p.get("value") for p in suite.findall("properties/property")}


def test_a_case_for_each_check(make_report):
    suite = read(as_junit(make_report(lines=[(1.0, "[INFO] [teleop]: hello")])))
    assert (suite.get("name"), suite.get("tests"), suite.get("failures"), suite.get("time")) == (
        "03_teleop",
        "2",
        "1",
        "2.000",
    )
    good, bad = suite.findall("testcase")
    assert (good.get("classname"), good.get("name"), len(good)) == ("03_teleop", "Title of good", 0)
    (failure,) = bad
    assert (failure.tag, failure.get("message"), failure.get("type")) == ("failure", "was 0.5", "time_in_band")
    assert failure.text.splitlines()[-1] == "hint: Hint for bad."
    told = properties(suite)
    assert (told["score"], told["outcome"], told["trial.public"]) == ("50", "graded", "seed 3, 50 points")
    assert suite.findtext("system-out") == "    1.00 s  [INFO] [teleop]: hello"


def test_what_could_not_run_is_an_error(not_run):
    suite = read(as_junit(not_run))
    assert (suite.get("failures"), suite.get("errors")) == ("0", "2")
    error = suite.find("testcase/error")
    assert (error.get("type"), error.get("message")) == ("student_error", "node.py, line 3: SyntaxError: expected ':'")


def test_it_differs_from_the_first_in_host_facts_only(make_report):
    report = make_report(notes=("Changed.",))
    first, again = (read(as_junit(r)) for r in (report, dataclasses.replace(report, host=None, submission="x")))
    assert properties(first) == properties(again) | {"sandbox": "D", "pace": "lockstep"}
    assert properties(again)["note.1"] == "Changed."
    assert [XML.tostring(case) for case in first.iter("testcase")] == [
        XML.tostring(case) for case in again.iter("testcase")
    ]


@pytest.mark.parametrize("text", NASTY)
def test_hard_cases_one_by_one(make_report, text):
    suite = read(as_junit(make_report(lines=[(1.0, text)], versions={"mujoco": f"a{text}b"})))
    assert len(properties(suite)["version.mujoco"]) == len(text) + 2


@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(text=nasty)
def test_whatever_a_student_writes_it_is_xml(make_report, text):
    score = score_of(result("good", True), result("bad", False, text), diagnosis=text)
    suite = read(as_junit(make_report(score, notes=(text,), versions={"mujoco": text})))
    failure = suite.find("testcase/failure")
    assert failure.text.startswith("expected: is 0.5\nmeasured: ")
