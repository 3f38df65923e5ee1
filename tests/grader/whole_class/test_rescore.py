"""A class is scored again after a check was changed: points, reports and gradebook follow, and nothing is run."""

import csv
import json
import shutil
import subprocess
import sys

import pytest

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.exercise.conditions import conditions_sha256
from gz_course.grader.whole_class.rescore import rescore

FILE = "teleop_node.py"


@pytest.fixture(scope="module")
def course(root, tmp_path_factory):
    """A course of one exercise whose manifest a test may change."""
    folder = tmp_path_factory.mktemp("course")
    shutil.copytree(root / "exercises/03_teleop", folder / "exercises/03_teleop")
    return folder


@pytest.fixture
def manifest(course):
    """Replace texts of the manifest, and put them back after the test."""
    path = course / "exercises/03_teleop/grading/exercise.toml"
    before = path.read_text()

    def change(*pairs):
        text = path.read_text()
        for old, new in pairs:
            assert old in text
            text = text.replace(old, new)
        path.write_text(text)
        return find_exercise("03_teleop", course)

    yield change
    path.write_text(before)


def run(course, *words):
    command = [sys.executable, "-m", "gz_course.grader", *map(str, words)]
    environment = {"PATH": "/usr/bin:/bin", "HOME": str(course), "COURSE_ROOT": str(course)}
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=600, check=False)


@pytest.fixture(scope="module")
def graded(course, root, tmp_path_factory):
    """The folder of a class of four: one right, one wrong, one that cannot run, one without a file."""
    folder = tmp_path_factory.mktemp("class")
    wrong = root / "solutions/03_teleop/rejected/turns_right" / FILE
    for name, source in {"ok": (root / "solutions/03_teleop" / FILE).read_text(), "right": wrong.read_text()}.items():
        (folder / "in" / name).mkdir(parents=True)
        (folder / "in" / name / FILE).write_text(source)
    (folder / "in/broken").mkdir()
    (folder / "in/broken" / FILE).write_text("x = (")
    (folder / "in/none").mkdir()
    (folder / "in/none/notes.txt").write_text("")
    done = run(course, "grade-all", "03", folder / "in", "--out", folder / "out", "--html", "--demand", "A")
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture
def out(graded, tmp_path):
    return shutil.copytree(graded / "out", tmp_path / "out")


def points(out):
    with (out / "gradebook.csv").open(newline="", encoding="utf-8-sig") as stream:
        return {row["student"]: float(row["score"]) for row in csv.DictReader(stream)}


@pytest.mark.proof
def test_points_follow_a_changed_check(course, manifest, out, graded):
    assert points(out) == {"broken": 0, "none": 0, "ok": 100, "right": 70}
    before = (out / "ok/report.html").read_bytes()
    old = json.loads((out / "right/report.json").read_text())
    exercise = manifest(("points = 20", "points = 25"))
    done = rescore(exercise, out)
    assert set(done.changed) == {"ok", "right"} and done.same == 2 and not done.left
    assert done.changed["right"] == "70 -> 80 (stops 20 -> 25, commands_forward 20 -> 25)"
    assert points(out) == {"broken": 0, "none": 0, "ok": 110, "right": 80}
    report = json.loads((out / "right/report.json").read_text())
    assert report["score"] == 80
    for fact in ("sandbox", "wall_seconds", "recording", "submission", "truth_sha256"):
        assert report[fact] == old[fact], fact
    assert (out / "ok/report.html").read_bytes() != before
    again = run(course, "grade-all", "03", graded / "in", "--out", out, "--html", "--demand", "A")
    assert again.stderr.count("(done before)") == 4, again.stderr


@pytest.mark.proof
def test_one_student_and_one_check(manifest, out):
    exercise = manifest(("points = 20", "points = 25"))
    assert set(rescore(exercise, out, student="ok").changed) == {"ok"}
    left = rescore(exercise, out, student="right", check="stops").left
    assert left == {"right": "other checks change, too: commands_forward"}
    assert points(out) == {"broken": 0, "none": 0, "ok": 110, "right": 70}


@pytest.mark.proof
def test_what_cannot_be_scored_again_is_told_and_left(manifest, out):
    for recording in (out / "right").glob("*.rrd"):
        recording.unlink()
    assert rescore(manifest(("points = 20", "points = 25")), out).left == {"right": "its recordings were not kept"}
    left = rescore(manifest(("duration = 8", "duration = 9")), out).left
    assert set(left) == {"ok", "right"}
    assert left["ok"].startswith("the trial public has changed")
    assert points(out)["ok"] == 110


@pytest.mark.proof
def test_nothing_is_written_for_who_or_what_is_not_there(manifest, out, tmp_path):
    exercise = manifest(("points = 20", "points = 25"))
    before = (out / "gradebook.csv").read_bytes()
    for wanted, words in (({"student": "okk"}, "did you mean 'ok'"), ({"check": "stop"}, "did you mean 'stops'")):
        with pytest.raises(UsageError, match=words):
            rescore(exercise, out, **wanted)
    with pytest.raises(UsageError, match=r"has no journal\.jsonl"):
        rescore(exercise, tmp_path)
    assert (out / "gradebook.csv").read_bytes() == before


def test_what_a_run_depends_on(manifest):
    def conditions(*pairs):
        exercise = manifest(*pairs)
        return conditions_sha256(exercise.trials[0].applied_to(exercise), exercise.trials[0])

    first = conditions()
    assert conditions(("points = 20", "points = 25")) == first
    assert conditions(("duration = 8", "duration = 9")) != first
