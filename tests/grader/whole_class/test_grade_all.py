"""`course grade-all` as a process: a class, killed and resumed, with faults that are not the students'."""

import csv
import json
import os
import re
import shutil
import signal
import subprocess
import sys

import psutil
import pytest

from gz_course.tests import warm_process
from gz_course.tests.warm_process import WarmPopen

pytestmark = pytest.mark.proof

FILE = "teleop_node.py"
LINE = 60  # [s] for one line of progress


@pytest.fixture(scope="module")
def submissions(tmp_path_factory, solved, root):
    """Three that can be run and three that cannot."""
    folder = tmp_path_factory.mktemp("class")
    turns_right = (root / "solutions/03_teleop/rejected/turns_right" / FILE).read_bytes()
    for name, data in {
        f"Jane Doe/{FILE}": solved,
        f"=cmd|' calc/{FILE}": turns_right,
        "mallory.py": solved,
        f"eve/{FILE}": b"x = (",
        "bob.zip": b"PK",
        "sue/notes.txt": b"",
    }.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(data)
    return folder


@pytest.fixture
def begin(tmp_path, short_course, submissions, course_environment):
    """Start `course grade-all` in a process group of its own; its progress comes line by line from stderr."""
    started = []

    def start(*options, out="out"):
        command = [sys.executable, "-c", "from gz_course.grader.course import main; main()", "grade-all", "03_teleop"]
        process = WarmPopen(
            [*command, str(submissions), "--out", str(tmp_path / out), *map(str, options)],
            cwd=tmp_path,
            env=course_environment(tmp_path, COURSE_ROOT=str(short_course)),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            start_new_session=True,
            text=True,
        )
        started.append(process)
        return process

    yield start
    for process in started:
        if process.poll() is None:
            process.kill()
        process.communicate(timeout=LINE)


def rows_of(path):
    with path.open(newline="", encoding="utf-8-sig") as stream:
        return list(csv.DictReader(stream))


def finished(process):
    told, errors = process.communicate(timeout=600)
    return process.returncode, told, errors


def gone(folder, running_in):
    """Wait until nothing that worked in a folder runs any more."""
    _, alive = psutil.wait_procs(running_in(folder / "tmp"), timeout=120)
    return not alive


@pytest.fixture(scope="module")
def reference(tmp_path_factory, short_course, submissions, course_environment):
    """The class graded in one go."""
    folder = tmp_path_factory.mktemp("reference")
    command = [sys.executable, "-c", "from gz_course.grader.course import main; main()", "grade-all", "03_teleop"]
    done = warm_process.run(
        [*command, str(submissions), "--out", str(folder / "out"), "--html", "--gradescope"],
        cwd=folder,
        env=course_environment(folder, COURSE_ROOT=str(short_course)),
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert done.returncode == 0, done.stderr
    return folder, done


def test_the_gradebook_of_a_class(reference):
    folder, _ = reference
    rows = rows_of(folder / "out/gradebook.csv")
    assert [row["student"] for row in rows] == ["'=cmd|' calc", "bob", "eve", "Jane Doe", "mallory", "sue"]
    outcomes = [row["outcome"] for row in rows]
    assert outcomes == ["graded", "student_error", "student_error", "graded", "graded", "student_error"]
    by_name = {row["student"]: row for row in rows}
    assert by_name["Jane Doe"]["truth_sha256"] == by_name["mallory"]["truth_sha256"] != ""
    assert by_name["Jane Doe"]["score"] == by_name["mallory"]["score"]
    assert "line 1: SyntaxError" in by_name["eve"]["diagnosis"]
    assert by_name["sue"]["diagnosis"] == f"sue holds no {FILE}, the file 03_teleop asks for"
    assert all(row["score"] == "0" for row in rows if row["outcome"] == "student_error")


def test_every_student_has_a_folder_with_reports(reference):
    folder, done = reference
    rows = rows_of(folder / "out/gradebook.csv")
    for row in rows:
        files = {path.name for path in (folder / "out" / row["folder"].removeprefix("'")).iterdir()}
        read = row["student"] not in ("bob", "sue")
        assert files == {"report.json", "report.html"} | ({"03_teleop.rrd", "results.json"} if read else set())
    report = json.loads((folder / "out/Jane Doe/report.json").read_text())
    assert (report["submission"], report["recording"]) == ("Jane Doe", "03_teleop.rrd")
    assert str(folder) not in json.dumps(report) and "/tmp/" not in json.dumps(report)
    page = (folder / "out/Jane Doe/report.html").read_text()
    assert "course-class-" not in page and "submission/teleop_node.py" in page
    assert "6 submissions: 3 graded, 3 student_error" in done.stdout
    assert list((folder / "tmp").iterdir()) == [], "no temporary folder is left"


def test_a_second_run_grades_nothing_and_writes_the_same(reference, begin, tmp_path, running_in):
    folder, _ = reference
    before = (folder / "out/gradebook.csv").read_bytes()
    (folder / "out/gradebook.csv").unlink()
    code, _, errors = finished(begin("--html", "--gradescope", out=folder / "out"))
    assert code == 0, errors
    assert errors.count("(done before)") == 6
    assert (folder / "out/gradebook.csv").read_bytes() == before


@pytest.mark.parametrize("lines", [0, 4])
def test_killed_and_resumed_it_is_the_same_gradebook(begin, reference, tmp_path, lines, running_in):
    folder, _ = reference
    process = begin()
    for told in range(1, lines + 1):  # after the lines of the plan
        while not (line := process.stderr.readline()).startswith(f"{told}/6 "):
            assert line
    if not lines:  # as soon as a grading runs
        while not (running := psutil.Process(process.pid).children()) and process.poll() is None:
            psutil.wait_procs(running, timeout=0.01)
    os.kill(process.pid, signal.SIGKILL)
    process.communicate(timeout=LINE)
    if (tmp_path / "out/gradebook.csv").exists():  # it appears while the run goes on
        assert len(rows_of(tmp_path / "out/gradebook.csv")) == 6
    assert gone(tmp_path, running_in), "gradings end when the class is killed"
    journal = tmp_path / "out/journal.jsonl"
    done = len(journal.read_bytes().splitlines()) if journal.exists() else 0
    assert done >= lines, "what was told was written down before"
    code, _, errors = finished(begin())
    assert code == 0, errors
    assert errors.count("(done before)") == done
    assert (tmp_path / "out/gradebook.csv").read_bytes() == (folder / "out/gradebook.csv").read_bytes()
    assert list((tmp_path / "tmp").iterdir()) == []


def test_a_grading_that_is_killed_is_tried_again(begin, reference, tmp_path, running_in):
    folder, _ = reference
    process = begin("--jobs", "1")
    killed = False
    while not killed and process.poll() is None:
        for each in running_in(tmp_path / "tmp"):
            if "grade" in (line := each.cmdline()) and "grade-all" not in line:
                each.kill()
                killed = True
                break
    code, _, errors = finished(process)
    assert killed and code == 0, errors
    assert (tmp_path / "out/gradebook.csv").read_bytes() == (folder / "out/gradebook.csv").read_bytes()


def test_interrupted_it_leaves_nothing_running(begin, tmp_path, running_in):
    process = begin()
    while not process.stderr.readline().startswith("3/6 "):
        assert process.poll() is None
    process.send_signal(signal.SIGINT)
    code, _, errors = finished(process)
    assert code == 130
    assert re.search(r"[3-6] of 6 are done; the same command goes on", errors)
    assert "interrupted" not in errors, "that has been said"
    assert gone(tmp_path, running_in)
    assert list((tmp_path / "tmp").iterdir()) == []


def test_a_fault_of_the_exercise_costs_nobody_anything(course, hand_in, solved, short_course, tmp_path):
    broken = tmp_path / "broken/exercises/03_teleop"
    shutil.copytree(short_course / "exercises/03_teleop", broken)
    manifest = broken / "grading/exercise.toml"
    manifest.write_text(manifest.read_text().replace("lidar_room.sdf", "no_such_world.sdf"))
    folder = hand_in({"jane.py": solved, "eve/x.txt": b""})
    outcome = course("grade-all", "03", folder, "--out", tmp_path / "out", COURSE_ROOT=str(tmp_path / "broken"))
    assert outcome.code == 3, outcome.output
    rows = rows_of(tmp_path / "out/gradebook.csv")
    assert [(row["student"], row["score"], row["outcome"]) for row in rows] == [
        ("eve", "0", "student_error"),
        ("jane", "", "infra"),
    ]
    assert "no_such_world.sdf" in rows[1]["diagnosis"]
    assert "not the student's fault: jane" in outcome.words
    assert "jane" not in (tmp_path / "out/journal.jsonl").read_text(), "a fault of ours is no result"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["class", "--out", "class/out"], "lies among the submissions"),
        (["class", "--out", "full"], "not empty"),
        (["nowhere", "--out", "out"], "there is no nowhere"),
        (["class", "--out", "out", "--jobs", "1", "--dask", "local:1"], "give one of them"),
        (["class", "--out", "out", "--dask", "local:x"], "local:2"),
        (["class", "--out", "out", "--dask", "here"], "tcp://HOST:PORT"),
        (["class", "--out", "out", "--trials", "gone.toml"], "gone.toml"),
        (["class", "--out", "out", "--sandbox", "Z"], "no sandbox level"),
        (["class", "--out", "out", "--keep", "fail"], "expected all, failing or none"),
        (["class", "--out", "out", "--sandbox", "D", "--jobs", "2"], "2 gradings at a time need a sandbox of level B"),
        (["class", "--out", "out", "--sandbox", "C", "--demand", "B"], "C is asked for, but at least B"),
        (["class/jane.py", "--out", "out"], "cannot be read as an archive"),
    ],
)
def test_usage(course, hand_in, tmp_path, arguments, words):
    hand_in({"jane.py": b"x = 1"})
    hand_in({"thesis.tex": b"x"}, "full")
    outcome = course("grade-all", "03", *arguments)
    assert outcome.code == 2, outcome.output
    assert words in outcome.words
    assert (tmp_path / "full/thesis.tex").exists()


def test_on_dask_a_machine_runs_one_grading_at_a_time_where_they_are_not_kept_apart(course, hand_in):
    pytest.importorskip("distributed")
    hand_in({"jane.py": b"x = 1"})
    outcome = course("grade-all", "03", "class", "--out", "out", "--sandbox", "C", "--dask", "local:2")
    assert outcome.code == 2 and "2 gradings at a time" in outcome.words and "one worker" in outcome.words


def test_without_level_b_nobody_is_graded_unless_another_level_is_named(course, hand_in, tmp_path):
    hand_in({"jane.py": b"x = ("})
    lacking = {
        "prelude": "from gz_course.grader.run.sandbox import probe; probe.try_level = lambda level: 'not today'",
        "XDG_CACHE_HOME": str(tmp_path / "cache"),
    }
    outcome = course("grade-all", "03", "class", "--out", "out", **lacking)
    assert outcome.code == 3, outcome.output
    for words in ("level B or better is demanded", "best here is D: not today", "A firm sandbox", "--sandbox D"):
        assert words in outcome.words
    outcome = course("grade-all", "03", "class", "--out", "out", "--sandbox", "D", **lacking)
    assert outcome.code == 0, outcome.output
    assert rows_of(tmp_path / "out/gradebook.csv")[0]["outcome"] == "student_error"


def test_on_dask_it_is_the_same_gradebook(begin, reference, tmp_path, running_in):
    pytest.importorskip("distributed")
    folder, _ = reference
    code, _, errors = finished(begin("--dask", "local:2"))
    assert code == 0, errors
    assert (tmp_path / "out/gradebook.csv").read_bytes() == (folder / "out/gradebook.csv").read_bytes()
    assert gone(tmp_path, running_in)
    assert list((tmp_path / "tmp").iterdir()) == []
