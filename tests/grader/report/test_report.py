"""The report as data: the documented keys, and nothing that another program could not read."""

import dataclasses
import io
import json
from pathlib import Path

import pytest

from grader.exercise import CheckSpec
from grader.report.report import HostFacts, Report, TrialReport
from grader.report.terminal import print_report
from grader.score.check import Finding
from grader.score.score import CheckResult, Score

KEYS = {
    "exercise", "submission", "score", "max_score", "outcome", "checks", "trials", "sandbox", "pace", "recording",
    "truth_sha256", "sim_seconds", "run_wall_seconds", "wall_seconds", "real_time_factor", "versions",
}  # fmt: skip
CHECK_KEYS = {"id", "title", "points", "max_points", "status", "expected", "measured", "at_s", "hint"}


def result(id, passed, measured="was 0.5"):
    spec = CheckSpec(id, f"Title of {id}", 50, "change", f"Hint for {id}.")
    return CheckResult(spec, Finding(passed, "is 0.5", measured, 1.25 if passed else None))


SCORE = Score((result("good", True), result("bad", False)), "graded", "The bad one: was 0.5.", "ab" * 32)
REPORT = Report(
    exercise="03_teleop",
    title="Drive",
    submission="/home/me/teleop_node.py",
    recording=Path("runs/03_teleop.rrd"),
    score=SCORE,
    max_score=100,
    sim_seconds=8.0,
    seed=3,
    versions={"mujoco": "4.0.0"},
    host=HostFacts("D", "lockstep", 0.5, 2.0),
    trials=(TrialReport("public", 3, SCORE, Path("runs/03_teleop.rrd"), "ab" * 32),),
)


def test_the_keys_are_the_documented_ones():
    data = json.loads(REPORT.as_json())
    assert data.keys() >= KEYS
    assert [check.keys() for check in data["checks"]] == [CHECK_KEYS, CHECK_KEYS]


def test_the_values():
    data = json.loads(REPORT.as_json())
    assert (data["score"], data["max_score"], data["outcome"]) == (50, 100, "graded")
    assert (data["real_time_factor"], data["run_wall_seconds"], data["wall_seconds"]) == (16.0, 0.5, 2.0)
    trial = {"name": "public", "seed": 3, "score": 50, "outcome": "graded"}
    assert data["trials"] == [trial | {"recording": "runs/03_teleop.rrd", "truth_sha256": "ab" * 32}]
    good, bad = data["checks"]
    assert (good["status"], good["points"], good["at_s"], good["hint"]) == ("passed", 50, 1.25, None)
    assert (bad["status"], bad["points"], bad["at_s"], bad["hint"]) == ("failed", 0, None, "Hint for bad.")


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
    spec = CheckSpec("a", "A", 0.1, "change", "")
    checks = tuple(CheckResult(dataclasses.replace(spec, points=p), Finding(True, "", "")) for p in (0.1, 0.2, 0.3))
    report = dataclasses.replace(REPORT, score=dataclasses.replace(REPORT.score, checks=checks), max_score=0.6)
    assert report.full_marks


def printed(report, width=100):
    out = io.StringIO()
    print_report(report, out, width)
    return out.getvalue()


def test_without_colour_every_state_is_a_word():
    text = printed(REPORT)
    assert "\x1b" not in text
    lines = text.splitlines()
    assert next(line for line in lines if "Title of good" in line).startswith("pass")
    assert next(line for line in lines if "Title of bad" in line).startswith("FAIL")
    assert "score: 50 of 100  (graded)" in text
    assert "The bad one: was 0.5." in text
    assert "runs/03_teleop.rrd" in text and "16.0 x real time" in text


def test_hints_are_given_for_what_failed_only():
    text = printed(REPORT)
    assert "Hint for bad." in text and "Hint for good." not in text


@pytest.mark.parametrize("width", [40, 80, 200])
def test_nothing_is_lost_at_any_width(width):
    words = set(printed(REPORT, width=200).split())
    narrow = "".join(printed(REPORT, width=width).split())
    assert [word for word in words if word not in narrow] == []


@pytest.mark.parametrize(
    "text", ["[bold]x[/bold]", "[/]", "[red]", "a\\", "[link=file:///etc/passwd]x[/link]", "\\[x]"]
)
def test_what_a_student_wrote_is_never_markup(text):
    score = dataclasses.replace(
        REPORT.score, diagnosis=f"It says {text}", checks=(result("good", True), result("bad", False, f"saw {text}"))
    )
    told = printed(dataclasses.replace(REPORT, score=score, submission=f"/home/{text}/node.py"))
    assert told.count(text) == 3


@pytest.mark.parametrize("code", ["\x1b[2J", "\x1b]0;title\x07", "\x9b31m", "\r", "\x08", "\0"])
def test_control_codes_of_a_student_never_reach_the_terminal(code):
    score = dataclasses.replace(REPORT.score, diagnosis=f"died with {code}passed")
    told = printed(dataclasses.replace(REPORT, score=score))
    assert not [c for c in told if not c.isprintable() and c != "\n"], repr(told)
    assert "passed" in told


def test_scored_again_it_says_nothing_about_a_host():
    assert "real time" not in printed(dataclasses.replace(REPORT, host=None))
