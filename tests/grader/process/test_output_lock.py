"""Two graders never write the same recordings at once, and a dead one keeps nobody out."""

import os
import signal
import subprocess
import sys

import pytest

from gz_course.grader.errors import UsageError
from gz_course.grader.exercise import find_exercise
from gz_course.grader.grade import grade
from gz_course.grader.process.output_lock import sole_writer


def test_the_second_is_told_and_leaves_no_trace(root, tmp_path):
    exercise = find_exercise("03_teleop", root)
    with sole_writer(tmp_path, exercise.name):
        before = sorted(tmp_path.iterdir())
        with pytest.raises(UsageError, match="another `course grade 03_teleop` is writing into"):
            grade(exercise, None, tmp_path)
        assert sorted(tmp_path.iterdir()) == before
    assert not list(tmp_path.iterdir())


def test_another_exercise_another_folder_and_a_second_time_are_free(tmp_path):
    with sole_writer(tmp_path, "a"), sole_writer(tmp_path, "b"), sole_writer(tmp_path / "c", "a"):
        pass
    with sole_writer(tmp_path, "a"):
        pass


def test_a_killed_grader_keeps_nobody_out(tmp_path):
    code = (
        "import sys, pathlib; from gz_course.grader.process.output_lock import sole_writer\n"
        "with sole_writer(pathlib.Path(sys.argv[1]), 'a'): print('mine', flush=True); sys.stdin.read()"
    )
    with subprocess.Popen(
        [sys.executable, "-c", code, str(tmp_path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as other:
        try:
            assert other.stdout is not None and other.stdout.readline() == b"mine\n"
            with pytest.raises(UsageError), sole_writer(tmp_path, "a"):
                pass
        finally:
            os.kill(other.pid, signal.SIGKILL)
    with sole_writer(tmp_path, "a"):
        pass


def test_a_folder_that_cannot_be_made(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(UsageError, match="cannot write"), sole_writer(tmp_path / "file", "a"):
        pass
