"""The plan of a class: what is said before anything is measured, and what follows from what was."""

import json

import pytest

from gz_course.grader.whole_class.journal import Results
from gz_course.grader.whole_class.plan import Measured, Plan, make_plan, measured, readable_time


def plan(**more):
    facts = {
        "submissions": 10_000,
        "done": 0,
        "trials": 1,
        "at_once": 2,
        "keep": "all",
        "measured": None,
        "free": 10**11,
    }
    return Plan(**(facts | more))


def test_before_anything_was_measured():
    first, second = plan().lines()
    assert first == "10000 submissions, 1 trial each, 2 at a time"
    assert second == "time and disk are estimated after the first gradings; 100 GB are free"


def test_time_and_disk_follow_from_what_was_measured():
    one = Measured(seconds=2.4, size=190_000.0, kept=1.0)
    told = plan(measured=one, trials=3, done=1000).lines()
    assert told == [
        "10000 submissions, 3 trials each, 2 at a time; 1000 are done",
        "about 3 h 0 min for 9000 gradings",
        "recordings (--keep all): about 1.7 GB, 190 kB each; 100 GB are free",
    ]
    assert "more than there is: give --keep failing" in plan(measured=one, free=10**9).lines()[-1]
    assert "one for each thread of Dask's workers at a time" in plan(measured=one, at_once=None).lines()[0]
    assert plan(done=10_000, measured=one).lines() == ["10000 submissions, 1 trial each, 2 at a time; 10000 are done"]


def test_what_is_measured_are_the_reports_that_are_there(tmp_path):
    journal = Results()
    for number in range(3):
        journal.know(str(number), {"student": f"s{number}", "folder": f"f{number}", "score": number * 50})
    assert measured(tmp_path, journal.all(), "all", 100) is None
    for number in (0, 2):
        (tmp_path / f"f{number}").mkdir()
        (tmp_path / f"f{number}" / "report.json").write_text(json.dumps({"wall_seconds": 2.0 + number}))
        (tmp_path / f"f{number}" / "x.rrd").write_bytes(bytes(1000))
    assert measured(tmp_path, journal.all(), "failing", 100) == Measured(3.0, 1000.0, 0.5)
    made = make_plan(tmp_path / "a/b", journal, 2, 1, trials=1, at_once=1, keep="none", most=100)
    assert (made.submissions, made.done, made.measured) == (2, 1, None) and made.free > 0


@pytest.mark.parametrize(("seconds", "text"), [(0.2, "1 s"), (89, "89 s"), (600, "10 min"), (12_000, "3 h 20 min")])
def test_times(seconds, text):
    assert readable_time(seconds) == text
