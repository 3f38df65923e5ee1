"""`course feedback`: what each platform takes back, without what hidden trials and checks give away."""

import csv
import io
import json
import zipfile
from dataclasses import replace
from datetime import UTC, datetime

import pytest

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.exercise.visibility import AFTER
from gz_course.grader.learning_platforms.feedback import make_feedback
from gz_course.grader.learning_platforms.roster import read_roster
from gz_course.grader.whole_class.gradebook import as_csv, write_gradebook
from gz_course.tests.grader.learning_platforms.classes import (
    WORKSHEET_HEAD,
    comments_taken_by_canvas,
    feedback_taken_by_moodle,
    table,
)

SECRETS = ("quick_clock", "another_start", "0.777", "4242", "picture of")
CHECK = {"expected": "is 0.5", "at_s": 1.25}


@pytest.fixture(scope="session")
def exercise(root):
    return find_exercise("03_teleop", root)


def report(exercise, **more):
    """Return the JSON report of a submission whose first check fails in a hidden trial only."""
    first, *others = exercise.checks
    failed = {"status": "failed", "measured": "0.777"} | CHECK

    def found(*wrong):
        return [{"id": each.id} | (failed if each.id in wrong else CHECK | {"status": "passed", "measured": "0.5"})
                for each in exercise.checks]  # fmt: skip

    trials = [
        {"name": "public", "seed": 0, "score": 100, "diagnosis": "", "checks": found()},
        {"name": "quick_clock", "seed": 4242, "score": 80, "diagnosis": "It was 0.777.", "checks": found(first.id)},
        {"name": "another_start", "seed": 4242, "score": 100, "diagnosis": "", "checks": found()},
    ]
    checks = [
        {"id": first.id, "title": first.title, "points": 0, "max_points": first.points, "hint": first.hint}
        | failed | {"measured": "in the trial quick_clock: 0.777"}
    ] + [
        {"id": each.id, "title": each.title, "points": each.points, "max_points": each.points, "hint": None,
         "status": "passed", "measured": "0.5"} | CHECK
        for each in others
    ]  # fmt: skip
    data = {"exercise": exercise.name, "score": 80, "max_score": 100, "sim_seconds": 15.0, "trials": trials}
    return data | {"outcome": "graded", "diagnosis": "In the trial quick_clock: It was 0.777.", "checks": checks} | more


@pytest.fixture
def grades(tmp_path, exercise):
    """Write the folder of a class of (student, id, submission, platform)."""

    def write(*found, **more):
        results = []
        for student, id, submission, platform in found:
            folder = tmp_path / "grades" / student
            folder.mkdir(parents=True)
            (folder / "report.json").write_text(json.dumps(report(exercise, **more)))
            (folder / "report.html").write_text("picture of quick_clock")
            facts = {"points": {}, "outcome": "graded", "diagnosis": "x", "sha256": "", "truth_sha256": "", "score": 80}
            facts |= {"student": student, "id": id, "submission": submission, "platform": platform, "folder": student}
            results.append(facts | {"changes": ["100 -> 80 (2 days late)"]})
        write_gradebook(tmp_path / "grades", as_csv(exercise, results))
        return tmp_path / "grades"

    return write


def worksheet(tmp_path, *people):
    rows = [[f"Participant {id}", name, "", "", "", "", "", "", "", ""] for id, name in people]
    (tmp_path / "worksheet.csv").write_text(table(WORKSHEET_HEAD, *rows))
    return read_roster(tmp_path / "worksheet.csv")


def files_of(made):
    with zipfile.ZipFile(io.BytesIO(made.data)) as archive:
        return {name: archive.read(name).decode() for name in archive.namelist()}


MOODLE = [
    ("Jane von_Doe", "123", "Jane von_Doe_123_assignsubmission_file_", "Moodle"),
    ("Team 4", "124", "Team 4_124_assignsubmission_file_", "Moodle"),
]
CANVAS = [
    ("doejane", "4711", "doejane_LATE_4711_99120_teleop_node-1.py", "Canvas"),
    ("roe", "4712", "roe_4712_99121_a_7_b.py", "Canvas"),
    ("al", "4713", "al_4713_text.html", "Canvas"),
]


def test_moodle_stores_the_feedback_of_each(grades, tmp_path):
    roster = worksheet(tmp_path, (123, "Jane von Doe"), (124, "Bob"))
    made = make_feedback(grades(*MOODLE), "moodle", "summary", roster)
    files = files_of(made)
    assert feedback_taken_by_moodle(files, {123, 124}) == {123: ["feedback.html"]}
    assert made.count == 1 and list(made.left_out) == ["Team 4"], "a group's number is not Bob's"
    with pytest.raises(UsageError, match="--roster with the grading worksheet"):
        make_feedback(tmp_path / "grades", "moodle", "summary")


def test_canvas_attaches_the_feedback_to_a_comment(grades):
    made = make_feedback(grades(*CANVAS), "canvas", "summary")
    files = files_of(made)
    assert comments_taken_by_canvas(files, {4711: 99120, 4712: 99121}) == {4711: 99120, 4712: 99121}
    assert list(made.left_out) == ["al"]
    for text in files.values():
        compile(text, "feedback.py", "exec")  # the name of the file says that it is Python
        assert "Your grade: 80 of 100 points." in text and "100 -> 80 (2 days late)" in text


def test_a_folder_for_each(grades):
    folder = grades(*CANVAS)
    made = make_feedback(folder, "zip", "summary")
    assert sorted(files_of(made)) == [
        f"{name}/feedback.{kind}" for name in ("al", "doejane", "roe") for kind in ("html", "txt")
    ]
    assert made.data == make_feedback(folder, "zip", "summary").data


def test_a_line_for_each_person_with_an_address(grades, tmp_path):
    (tmp_path / "list.csv").write_text("First name,Last name,Email address\nJane,Doe,jane@x.edu\n")
    folder = grades(("Jane Doe", "", "jane.py", ""), ("Al & Bo", "1;2", "submission_1", "Gradescope"))
    data = make_feedback(folder, "mail-merge", "summary", read_roster(tmp_path / "list.csv")).data
    assert data.startswith(b"\xef\xbb\xbf"), "Excel reads UTF-8 by this mark"
    rows = list(csv.DictReader(io.StringIO(data.decode("utf-8-sig"), newline="")))
    assert [(row["student"], row["id"], row["email"]) for row in rows] == [
        ("Jane Doe", "", "jane@x.edu"), ("Al", "1", ""), ("Bo", "2", "")
    ]  # fmt: skip
    assert all("Your grade: 80 of 100 points." in row["feedback"].splitlines()[1] for row in rows)


@pytest.mark.parametrize("hidden", ["summary", "none"])
@pytest.mark.parametrize("target", ["moodle", "canvas", "zip", "mail-merge"])
def test_nothing_of_a_hidden_trial_leaves(grades, tmp_path, target, hidden):
    roster = worksheet(tmp_path, (123, "Jane von Doe"))
    made = make_feedback(grades(*MOODLE, *CANVAS), target, hidden, roster)
    told = made.data.decode() if target == "mail-merge" else "".join(map("".join, files_of(made).items()))
    assert [word for word in SECRETS if word in told] == []
    assert ("1 of 2 runs that are not shown lost points." in told) == (hidden == "summary")


def test_with_all_it_is_the_report(grades):
    files = files_of(make_feedback(grades(*CANVAS), "zip", "all"))
    assert files["roe/feedback.html"] == "picture of quick_clock"
    assert "measured: in the trial quick_clock: 0.777" in files["roe/feedback.txt"]


def test_after_the_deadline_of_each_student(grades, monkeypatch, exercise):
    first, *others = exercise.checks
    changed = replace(exercise, checks=(replace(first, visibility=AFTER), *others))
    monkeypatch.setattr("gz_course.grader.learning_platforms.feedback.find_exercise", lambda name: changed)
    folder, title = grades(*CANVAS), first.title
    made = make_feedback(folder, "zip", "summary")
    assert "There is no deadline in class.toml" in made.advice and title not in files_of(made)["roe/feedback.txt"]
    (folder / "class.toml").write_text('deadline = "2026-11-20T12:00+00:00"\n')
    (folder / "overrides.csv").write_text("student,deadline\nroe,2026-11-27T12:00+00:00\n")
    files = files_of(make_feedback(folder, "zip", "summary", now=datetime(2026, 11, 21, tzinfo=UTC)))
    assert title in files["doejane/feedback.txt"] and title not in files["roe/feedback.txt"]


def test_whoever_was_not_graded_is_named(grades):
    folder = grades(*CANVAS)
    (folder / "roe/report.json").unlink()
    made = make_feedback(folder, "zip", "none")
    assert made.left_out == {"roe": "there is no report"} and made.count == 2


def test_the_command(course, grades, tmp_path):
    folder = grades(*CANVAS)
    told = course("feedback", folder, "--for", "canvas", "--out", tmp_path / "back.zip")
    assert told.code == 1 and "back.zip: 2 students. In Canvas" in told.stdout
    assert "not in it: al: Canvas has not named" in told.stdout
    told = course("feedback", folder, "--for", "moodel", "--out", tmp_path / "x.zip")
    assert told.code == 2 and "did you mean 'moodle'" in told.stderr and not (tmp_path / "x.zip").exists()
    told = course("feedback", tmp_path, "--for", "zip", "--out", tmp_path / "x.zip")
    assert told.code == 2 and "gradebook.csv cannot be read" in told.stderr
