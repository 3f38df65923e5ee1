"""Several attempts of a student: kept, each graded once, and counted as `class.toml` says."""

import csv
import json
from concurrent.futures import Future
from datetime import datetime

import pytest

from gz_course.grader.errors import UsageError
from gz_course.grader.submission.intake import Selection
from gz_course.grader.whole_class.class_run import ClassRun
from gz_course.grader.whole_class.found import Found
from gz_course.grader.whole_class.gradebook import GRADEBOOK
from gz_course.grader.whole_class.grading import Graded


class Machine:
    """Gives a submission the score that it holds, all of it for the last check; `broken` is never graded."""

    def __init__(self, exercise):
        self.exercise, self.asked = exercise, []

    def submit(self, _, setup, job):
        text = job.files[job.main].decode()
        self.asked.append((job.student, text))
        future: Future[Graded] = Future()
        if text == "broken":
            future.set_result(Graded(None, fault="it broke"))
            return future
        checks = [{"id": check.id, "points": 0} for check in self.exercise.checks]
        checks[-1]["points"] = float(text)
        report = {"score": float(text), "outcome": "graded", "diagnosis": "", "truth_sha256": "", "checks": checks}
        future.set_result(
            Graded(report | {"trials": []}, {"report.json": json.dumps(report | {"trials": []}).encode()})
        )
        return future


@pytest.fixture
def grade(exercise, tmp_path, monkeypatch):
    """Grade the attempts of students; returns student -> its line of the gradebook, and what was graded."""

    def run(rules, **students):
        machine = Machine(exercise)
        monkeypatch.setattr(ClassRun, "_here", lambda self, jobs, stack: (machine, lambda: 1, lambda: False))
        (tmp_path / "out").mkdir(exist_ok=True)
        (tmp_path / "out/class.toml").write_text(rules)
        found = []
        for name, attempts in students.items():
            made = [_found(name, n, str(text)) for n, text in enumerate(attempts)]
            found.append(Found(**(made[-1].__dict__ | {"earlier": tuple(made[:-1])})))
        run = ClassRun(exercise, tmp_path / "out", submitted=lambda each: each.submitted.isoformat())
        run.grade(found, lambda *_: None)
        with (tmp_path / "out" / GRADEBOOK).open(newline="", encoding="utf-8-sig") as stream:
            return {row["student"]: row for row in csv.DictReader(stream)}, machine.asked

    return run


def _found(name, n, text):
    when = datetime(2026, 11, 20 + n, 12)
    return Found(name, "", f"{name}-{text}", lambda: Selection(".", "x.py", {"x.py": text.encode()}), when)


@pytest.mark.parametrize(
    ("how", "score", "told"),
    [
        ("last", "60", ""),
        ("best", "90", "attempt 2 of 3 counts, the best of 30, 90, 60"),
        ("mean", "60", "the mean of 3 attempts counts: 30, 90, 60"),
    ],
)
def test_attempts_are_counted_as_the_class_says(grade, tmp_path, how, score, told):
    rows, asked = grade(f'attempts = "{how}"', jane=(30, 90, 60), bob=(40,))
    assert (rows["jane"]["score"], rows["jane"]["changes"], rows["bob"]["score"]) == (score, told, "40")
    assert len(asked) == 4
    assert len(list((tmp_path / "out/attempts").iterdir())) == 2
    assert (tmp_path / "out" / rows["jane"]["folder"] / "report.json").is_file()
    again, asked = grade(f'attempts = "{how}"', jane=(30, 90, 60), bob=(40,))
    assert again == rows and asked == []


def test_without_a_word_the_last_attempt_alone_is_graded(grade, tmp_path):
    rows, asked = grade('deadline = "2026-11-20T00:00+00:00"', jane=(30, 90, 60))
    assert rows["jane"]["score"] == "60" and asked == [("jane", "60")] and not (tmp_path / "out/attempts").exists()


def test_lateness_is_that_of_each_attempt(grade):
    rules = 'deadline = "2026-11-20T12:00+00:00"\nlate = "20 % a day"\nattempts = "best"'
    rows, _ = grade(rules, jane=(70, 80, 95))  # 70, 80 - 20, 95 - 40
    assert rows["jane"]["score"] == "70" and rows["jane"]["changes"] == "attempt 1 of 3 counts, the best of 70, 60, 55"
    rows, _ = grade(rules.replace("best", "mean"), jane=(70, 80, 95))
    assert rows["jane"]["score"] == "61.666667" and rows["jane"]["machine_score"] == "81.666667"


def test_what_is_handed_in_again_leaves_the_earlier_attempt(grade):
    """As on Moodle and Canvas, which give the last attempt only."""
    rows, _ = grade('attempts = "best"', jane=(90,))
    rows, asked = grade('attempts = "best"', jane=(50,))
    assert asked == [("jane", "50")] and rows["jane"]["score"] == "90"
    rows, asked = grade('attempts = "best"', jane=(50,))
    assert asked == [] and rows["jane"]["score"] == "90"
    rows, asked = grade('attempts = "last"', jane=(90,))  # the first one once more
    assert rows["jane"]["score"] == "90"


def test_the_plan_counts_attempts(grade, exercise, tmp_path):
    grade('attempts = "mean"', jane=(30, 60))
    made = [_found("jane", n, str(text)) for n, text in enumerate((30, 60, 90))]
    last = Found(**(made[-1].__dict__ | {"earlier": tuple(made[:-1])}))
    plan = ClassRun(exercise, tmp_path / "out").plan([last], 1)
    assert (plan.submissions, plan.done) == (3, 2)


def test_an_export_with_one_more_attempt(grade):
    grade('attempts = "mean"', jane=(30, 60))
    rows, asked = grade('attempts = "mean"', jane=(30, 60, 90))
    assert asked == [("jane", "90")] and rows["jane"]["score"] == "60"


def test_an_earlier_attempt_that_cannot_be_graded_is_told(grade):
    rows, _ = grade('attempts = "best"', jane=("broken", 60))
    assert rows["jane"]["score"] == "60" and rows["jane"]["changes"] == "an earlier attempt could not be graded yet"


def test_a_change_by_hand_is_made_to_what_counts(grade, exercise, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out/overrides.csv").write_text("student,points,comment\njane,77,seen\n")
    rows, _ = grade('attempts = "best"', jane=(90, 60))
    assert rows["jane"]["score"] == "77" and "total 90 -> 77 (seen)" in rows["jane"]["changes"]


def test_a_word_that_is_not_known(grade):
    with pytest.raises(UsageError, match=r"class\.toml: attempts is 'bets'; did you mean 'best'"):
        grade('attempts = "bets"', jane=(1,))
