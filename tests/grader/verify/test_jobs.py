"""Several gradings at once: the same reports in the same order, and nothing left running whatever happens."""

import os
import shutil
import signal
import subprocess
import sys
from unittest.mock import Mock

import psutil
import pytest

from grader.errors import InfrastructureError
from grader.exercise import find_exercise
from grader.verify import jobs
from grader.verify.jobs import Job, pool

COURSE = [sys.executable, "-c", "from grader.course import main; main()"]
FILES = ["solutions/03_teleop/teleop_node.py", "exercises/03_teleop/teleop_node.py"]


def job(exercise, file, out):
    return Job(exercise, file, out, (exercise.trials,))


def test_workers_report_as_this_process_does(root, tmp_path):
    exercise = find_exercise("03", root)
    results = []
    for count in (1, 2):
        jobs = [job(exercise, root / file, tmp_path / f"{count}" / str(i)) for i, file in enumerate(FILES)]
        with pool(count) as workers:
            results.append([(r.score.points, r.score.truth_sha256) for r in workers.reports(jobs)])
    assert results[0] == results[1]
    assert [points for points, _ in results[0]] == [100, 0]


def test_later_trials_are_left_out_when_points_are_lost(root, tmp_path):
    exercise = find_exercise("03", root)
    for file, folders in zip(FILES, (2, 1), strict=True):
        out = tmp_path / str(folders)
        trials = (exercise.trials, exercise.trials)
        Job(exercise, root / file, out, trials).run()
        assert len(list(out.rglob("*.rrd"))) == folders


@pytest.fixture
def verifying(root, tmp_path, course_environment, running_in):
    """`course verify --jobs 2` of one exercise, under way: its first line has been read."""
    shutil.copytree(root / "exercises/03_teleop", tmp_path / "exercises/03_teleop")
    shutil.copytree(root / "solutions/03_teleop", tmp_path / "solutions/03_teleop")
    process = subprocess.Popen(
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


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_interrupted_verification_leaves_nothing(verifying, number, code):
    if number == signal.SIGINT:
        os.killpg(verifying.pid, number)  # as a terminal does
    else:
        verifying.send_signal(number)
    _, errors = verifying.communicate(timeout=30)
    assert verifying.returncode == code
    assert "Traceback" not in errors, errors


def test_a_worker_that_is_killed_is_our_fault(verifying):
    workers = [p for p in psutil.Process(verifying.pid).children() if "spawn_main" in " ".join(p.cmdline())]
    workers[0].kill()
    _, errors = verifying.communicate(timeout=60)
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
