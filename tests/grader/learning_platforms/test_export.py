"""`course export` from a gradebook on disk, with the times that submissions claim."""

import subprocess
import zipfile
from datetime import UTC, datetime

import pytest

from gz_course.grader.exercise import find_exercise
from gz_course.grader.learning_platforms.submission_times import commit_time, submission_times
from gz_course.grader.whole_class.gradebook import as_csv, read_gradebook, write_gradebook
from gz_course.tests.grader.learning_platforms.classes import CANVAS_HEAD, MOODLE_HEAD, parsed, table

FILE = "teleop_node.py"


@pytest.fixture(scope="session")
def exercise(root):
    return find_exercise("03_teleop", root)


@pytest.fixture
def grades(tmp_path, exercise):
    """Write a gradebook of (student, id, submission, score, platform)."""

    def write(*found):
        facts = {"points": {}, "outcome": "graded", "diagnosis": "=x", "sha256": "", "truth_sha256": "", "folder": ""}
        names = ("student", "id", "submission", "score", "platform")
        folder = tmp_path / "grades"
        folder.mkdir()
        write_gradebook(folder, as_csv(exercise, [dict(zip(names, each, strict=True)) | facts for each in found]))
        return folder

    return write


def test_a_gradebook_is_read_as_it_was_written(grades):
    folder = grades(("=cmd|' x", "+1", "'a", 65.5, "Canvas"), ("Jane", "", "Jane", None, ""))
    first, second = read_gradebook(folder)
    assert (first.student, first.id, first.submission, first.score) == ("=cmd|' x", "+1", "'a", 65.5)
    assert (first.platform, second.platform) == ("Canvas", "")
    assert (second.score, second.max_score, second.diagnosis) == (None, 100.0, "=x")


def test_the_command(course, grades, tmp_path):
    folder = grades(
        ("jane", "", "jane.py", 65.5, ""),
        ("doejohn", "9", "doejohn_LATE_9_11_t.py", 80, "Canvas"),
        ("eve", "", "eve", 1, ""),
    )
    submissions = tmp_path / "class.zip"
    with zipfile.ZipFile(submissions, "w") as archive:
        for name, day in (("jane.py", 21), ("eve.py", 1), ("doejohn_LATE_9_11_t.py", 1)):
            archive.writestr(zipfile.ZipInfo(name, (2026, 11, day, 0, 0, 0)), b"")
    roster = tmp_path / "roster.csv"
    roster.write_text(table(MOODLE_HEAD, ["Jane", "D", "1", "jane@x.org", ""], ["John", "Doe", "2", "jd@x.org", ""]))
    more = ("--deadline", "2026-11-20 23:59 Europe/Berlin", "--submissions", submissions)
    outcome = course("export", "03", folder, "--roster", roster, "--out", tmp_path / "m.csv", *more)
    assert outcome.code == 1, outcome.output
    assert "2 of 3 students, for Moodle. In Moodle: Grades, Import" in outcome.words
    assert "not in it: eve (eve): nobody in the roster" in outcome.words and "late: 2" in outcome.words
    rows = parsed((tmp_path / "m.csv").read_text())
    assert [[*each[3:5], *each[5:]] for each in rows[1:]] == [
        ["jane@x.org", "65.5", "'=x", "LATE by 1 min"],
        ["jd@x.org", "80", "'=x", "LATE, says Canvas"],
    ]
    told = parsed((tmp_path / "m.overview.csv").read_text())
    assert [each[0] for each in told[1:]] == ["jane", "doejohn", "eve"] and told[3][-2] == "no"
    assert told[1][-5:-2] == ["LATE by 1 min", "2026-11-21 00:00:00+01:00", "file"]
    again = course("export", "03", folder, "--roster", roster, "--out", roster)
    assert again.code == 2 and "would overwrite what is read" in again.words
    assert course("export", "03", tmp_path, "--roster", roster, "--out", tmp_path / "x.csv").code == 2


def test_times_of_platforms_and_files(exercise, tmp_path):
    names = ("submission_1", "Lab_jdoe_attempt_2026-09-12-14-33-21_x.py", "jane")
    for name in names:
        (tmp_path / name / name).mkdir(parents=True)
        (tmp_path / name / name / FILE).write_bytes(b"")
    (tmp_path / "submission_1/submission_metadata.yml").write_text(
        "submission_1:\n  :submitters:\n  - :name: A\n    :email: a@x\n  :created_at: 2026-09-12 10:00:00.5 Z\n"
    )
    times = {
        student: time for name in names for (student, _), time in submission_times(tmp_path / name, exercise).items()
    }
    assert times["A"] == (datetime(2026, 9, 12, 10, 0, 0, 500_000, UTC), "platform")
    assert times["jdoe"] == (datetime(2026, 9, 12, 14, 33, 21), "platform")
    assert times["jane"].said_by == "file"


def test_every_attempt_has_its_time(exercise, tmp_path):
    attempts = {f"1-7 - Jane - Nov {day}, 2026 905 AM": day for day in (19, 20)}
    with zipfile.ZipFile(tmp_path / "class.zip", "w") as archive:
        for name in (*attempts, "2-7 - Al - Nov 20, 2026 905 PM"):
            archive.writestr(f"{name}/{FILE}", "x = 1\n")
    times = submission_times(tmp_path / "class.zip", exercise)
    found = {source: submitted.time.day for (student, source), submitted in times.items() if student == "Jane"}
    assert found == attempts and len(times) == 3


def test_the_time_of_a_commit_and_none_of_its_configuration(exercise, tmp_path):
    clone = tmp_path / "class/jane"
    clone.mkdir(parents=True)
    (clone / FILE).write_bytes(b"")
    (tmp_path / "class/eve.py").write_bytes(b"")
    date = {"GIT_COMMITTER_DATE": "2026-11-12T10:00:00+0100", "GIT_AUTHOR_DATE": "2020-01-01T00:00:00Z"}
    who = ["-c", "user.name=J", "-c", "user.email=j@x"]
    for command in (["init", "-q"], ["add", "."], [*who, "commit", "-q", "-m", "committer x <y> 5 +0000"]):
        subprocess.run(["git", *command], cwd=clone, check=True, env={"PATH": "/usr/bin:/bin", **date})
    mark = tmp_path / "ran"
    with (clone / ".git/config").open("a") as config:
        config.write(f'[core]\n\tfsmonitor = "touch {mark}"\n\tpager = "touch {mark}"\n[log]\n\tshowSignature = true\n')
    time = datetime(2026, 11, 12, 9, tzinfo=UTC)
    assert submission_times(tmp_path / "class", exercise)["jane", "jane"] == (time, "commit")
    subprocess.run(["git", "gc", "-q"], cwd=clone, check=True, env={"PATH": "/usr/bin:/bin"})
    mark.unlink(missing_ok=True)
    (tmp_path / "ours").mkdir()
    assert commit_time(clone / ".git", tmp_path / "ours") == time, "packed, too"
    (clone / ".git/HEAD").write_text("ref: ../../../etc/passwd")
    assert commit_time(clone / ".git", tmp_path / "ours") is None
    assert not mark.exists() and ("jane", "jane") not in submission_times(tmp_path / "class", exercise)


def test_canvas_marks_what_is_late(course, grades, tmp_path):
    folder = grades(
        ("doejane", "7", "doejane_LATE_7_11_t.py", 80, "Canvas"),
        ("roejohn", "8", "roejohn_8_12_x_LATE_9_13_t.py", 70, "Canvas"),
    )
    roster = tmp_path / "roster.csv"
    roster.write_text(
        table(
            [*CANVAS_HEAD[:5], "LATE", "03_teleop (1)"],
            ["Doe, Jane", "7", "", "", "A", "", ""],
            ["Roe, John", "8", "", "", "A", "", ""],
        )
    )
    outcome = course(
        "export", "03", folder, "--roster", roster, "--out", tmp_path / "c.csv", "--deadline", "2026-11-20T23:59Z"
    )
    assert outcome.code == 0, outcome.output
    rows = parsed((tmp_path / "c.csv").read_text())
    assert [row[5:] for row in rows[2:]] == [["LATE, says Canvas", "80"], ["", "70"]]
