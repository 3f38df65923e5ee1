"""Several gradings at once: the same reports in the same order, and nothing left running whatever happens."""

import json
import os
import shutil
import signal
import subprocess
import sys
from unittest.mock import Mock

import psutil
import pytest

from gz_course.grader.errors import InfrastructureError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.verify import jobs
from gz_course.grader.verify.jobs import Job
from gz_course.tests import warm_process
from gz_course.tests.warm_process import WarmPopen

pytestmark = pytest.mark.proof

COURSE = [sys.executable, "-c", "from gz_course.grader.course import main; main()"]
FILES = ["solutions/03_teleop/teleop_node.py", "exercises/03_teleop/teleop_node.py"]
GRADINGS = """
import json, sys
from pathlib import Path
from gz_course.grader.exercise import find_exercise
from gz_course.grader.verify.jobs import Job, pool

if __name__ == "__main__":
    root, out, count, trials, *files = sys.argv[1:]
    exercise = find_exercise("03", Path(root))
    rounds = (exercise.trials,) * int(trials)
    jobs = [Job(exercise, Path(file), Path(out) / str(i), rounds) for i, file in enumerate(files)]
    with pool(int(count)) as workers:
        print(json.dumps([(r.score.points, r.score.truth_sha256) for r in workers.reports(jobs)]))
"""


def job(exercise, file, out):
    return Job(exercise, file, out, (exercise.trials,))


@pytest.fixture
def reports(root, tmp_path):
    """Function grading FILES in a fresh process, as DDS reads its settings once in each: their points and hashes."""

    def grade(out, count, trials):
        program = tmp_path / "gradings.py"
        program.write_text(GRADINGS)
        files = [str(root / file) for file in FILES]
        command = [sys.executable, str(program), str(root), str(out), str(count), str(trials), *files]
        done = warm_process.run(command, capture_output=True, text=True, timeout=600)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    return grade


def test_workers_report_as_this_process_does(reports, tmp_path):
    here, workers = (reports(tmp_path / str(count), count, 1) for count in (1, 2))
    assert here == workers
    assert [points for points, _ in here] == [100, 0]


def test_later_trials_are_left_out_when_points_are_lost(reports, tmp_path):
    reports(tmp_path / "out", 1, 2)
    for number, folders in enumerate((2, 1)):
        assert len(list((tmp_path / "out" / str(number)).rglob("*.rrd"))) == folders


@pytest.fixture
def verifying(root, tmp_path, course_environment, running_in):
    """`course verify --jobs 2` of one exercise, under way: its first line has been read."""
    shutil.copytree(root / "exercises/03_teleop", tmp_path / "exercises/03_teleop")
    shutil.copytree(root / "solutions/03_teleop", tmp_path / "solutions/03_teleop")
    process = WarmPopen(
        [*COURSE, "verify", "03", "--jobs", "2", "--no-mutants"],
        cwd=tmp_path,
        env=course_environment(tmp_path, COURSE_ROOT=str(tmp_path), PYTHONUNBUFFERED="1"),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
        text=True,
    )
    try:
        assert "03_teleop" in process.stdout.readline()
        yield process
        assert running_in(tmp_path) == []
        assert [path.name for path in (tmp_path / "tmp").iterdir()] == []
    finally:
        process.kill()
        process.communicate()


@pytest.mark.parametrize(
    ("number", "code", "whole_group"),
    [(signal.SIGINT, 130, True), (signal.SIGTERM, 143, False), (signal.SIGTERM, 143, True)],
    ids=["by a terminal", "by kill", "by timeout"],
)
def test_an_interrupted_verification_leaves_nothing(verifying, number, code, whole_group):
    if number == signal.SIGTERM:
        verifying.send_signal(number)
    if whole_group:
        os.killpg(verifying.pid, number)
    _, errors = verifying.communicate(timeout=120)
    assert verifying.returncode == code
    assert "Traceback" not in errors, errors


def test_a_worker_that_is_killed_is_our_fault(verifying):
    workers = [p for p in psutil.Process(verifying.pid).children() if "spawn_main" in " ".join(p.cmdline())]
    workers[0].kill()
    _, errors = verifying.communicate(timeout=600)
    assert verifying.returncode == 3
    assert "was killed" in errors and "Traceback" not in errors


@pytest.mark.parametrize("faults", [0, 1, 2, 3])
def test_a_fault_of_the_machine_is_no_fault_of_a_variant(root, tmp_path, monkeypatch, faults):
    """What the machine could not do is tried again, and told if it does not get better."""
    calls = []

    def graded(exercise, file, out, *, trials):
        calls.append(out)
        if len(calls) <= faults:
            raise InfrastructureError("no memory")
        return made

    made = Mock()  # only its outcome is looked at
    monkeypatch.setattr(jobs, "grade", graded)
    exercise = find_exercise("03", root)
    one = job(exercise, root / FILES[0], tmp_path)
    if faults == 3:
        with pytest.raises(InfrastructureError, match="no memory"):
            one.run()
    else:
        assert one.run() is made
        assert len(calls) == faults + 1
