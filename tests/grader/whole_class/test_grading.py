"""One grading of a class as a process: it ends when it must, leaves nothing, and bad news about it is our fault."""

import json
import os
import shutil
import signal
import subprocess
import sys

import psutil
import pytest

from gz_course.tests.warm_process import WarmPopen

FILE = "teleop_node.py"
ENDLESS = 600  # [s] of an exercise that nobody waits for

GRADE_ONE = """
import json, sys
from pathlib import Path
from gz_course.grader.exercise import bundle
from gz_course.grader.exercise import load_exercise
from gz_course.grader.whole_class.grading import Job, Setup, grade_one
folder, submission, deadline, options = json.loads(sys.argv[1])
exercise = load_exercise(Path(folder))
files, choice = bundle.bundle(exercise)
setup = Setup(exercise.name, files, tuple(options), (), deadline, None)
graded = grade_one(setup, Job("jane", "key", "jane.py", "x.py", {"x.py": Path(submission).read_bytes()}))
print(json.dumps([graded.report and graded.report["outcome"], sorted(graded.files), graded.fault]))
"""


@pytest.fixture
def endless(short_course, tmp_path):
    """An exercise that takes ten minutes."""
    copy = tmp_path / "course/exercises/03_teleop"
    shutil.copytree(short_course / "exercises/03_teleop", copy)
    manifest = copy / "grading/exercise.toml"
    manifest.write_text(manifest.read_text().replace("duration = 0.5", f"duration = {ENDLESS}"))
    return copy


@pytest.fixture
def grade_one(tmp_path, course_environment, root):
    """Start `grade_one` in a process of its own, as a worker is: it sweeps all children that it has."""
    submission = root / "solutions/03_teleop" / FILE

    def start(folder, *options, deadline=120.0, submission=submission):
        told = json.dumps([str(folder), str(submission), deadline, options])
        return WarmPopen(
            [sys.executable, "-c", GRADE_ONE, told],
            cwd=tmp_path,
            env=course_environment(tmp_path),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )

    return start


def came_out(process):
    told, errors = process.communicate(timeout=600)
    assert process.returncode == 0, errors
    return json.loads(told)


def test_what_comes_back(grade_one, short_course):
    outcome, files, fault = came_out(grade_one(short_course / "exercises/03_teleop"))
    assert (outcome, files, fault) == ("graded", ["03_teleop.rrd", "report.json"], None)


def test_a_grading_that_does_not_end_is_ended(grade_one, endless, tmp_path, running_in):
    outcome, files, fault = came_out(grade_one(endless, "--pace", "realtime", deadline=4.0))
    assert (outcome, files, fault) == (None, [], "the grading was not done after 4 s")
    assert running_in(tmp_path / "tmp") == [] and list((tmp_path / "tmp").iterdir()) == []


def test_what_the_command_refuses_is_our_fault_and_told(grade_one, short_course):
    _, _, fault = came_out(grade_one(short_course / "exercises/03_teleop", "--pace", "sideways"))
    assert fault.startswith("the grading ended with exit code 2: course: there is no pace 'sideways'")


@pytest.mark.proof
def test_when_its_worker_is_killed_a_grading_ends_at_once(grade_one, endless, tmp_path, running_in):
    worker = grade_one(endless, "--pace", "realtime", deadline=ENDLESS)
    while not list((tmp_path / "tmp").rglob("*.rrd.part")):  # until it is at work
        assert worker.poll() is None
        psutil.wait_procs([psutil.Process(worker.pid)], timeout=0.05)
    at_work = running_in(tmp_path / "tmp")
    assert at_work
    os.kill(worker.pid, signal.SIGKILL)
    worker.communicate()
    _, alive = psutil.wait_procs(at_work, timeout=120)
    for each in alive:
        each.kill()
    assert alive == []
    (left,) = (tmp_path / "tmp").iterdir()
    assert came_out(grade_one(endless, "--pace", "sideways"))[0] is None
    assert not left.exists(), "the next worker removes what this one could not"
