"""The box: what a submission finds in its environment, its limits, and that nothing of the box stays."""

import resource
import subprocess
import sys
from pathlib import Path

import pytest

from gz_course.grader.run.sandbox import LIMITS, Sandbox
from gz_course.grader.run.sandbox.sandbox import limit


@pytest.fixture
def sandbox(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    box = Sandbox(42, "D")
    yield box
    box.close()
    assert list(tmp_path.iterdir()) == []


def test_the_environment_is_cleared_but_for_what_is_needed(sandbox, monkeypatch):
    monkeypatch.setenv("SECRET_TOKEN", "swordfish")
    monkeypatch.setenv("PYTHONPATH", "/somewhere")
    monkeypatch.setenv("PATH", "/usr/bin:/bin")
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    monkeypatch.setenv("FASTDDS_DEFAULT_PROFILES_FILE", "/somewhere.xml")
    given = sandbox.student_environment()
    assert given["PATH"].partition(":")[0] == str(Path(sys.executable).parent)  # `python3` is the course's
    assert not {"SECRET_TOKEN", "PYTHONPATH", "FASTDDS_DEFAULT_PROFILES_FILE", "COURSE_ROOT"} & given.keys()
    assert given["ROS_DOMAIN_ID"] == "42"
    assert "127.0.0.1" in Path(given["FASTRTPS_DEFAULT_PROFILES_FILE"]).read_text()


def test_home_and_temporary_files_are_inside(sandbox):
    given = sandbox.student_environment()
    for variable in ("HOME", "TMPDIR", "ROS_LOG_DIR"):
        assert given[variable].startswith(str(sandbox.folder))
    assert sandbox.home.is_dir()


def test_both_sides_speak_on_the_same_domain(sandbox):
    ours, theirs = sandbox.grader_environment(), sandbox.student_environment()
    shared = ("ROS_DOMAIN_ID", "RMW_IMPLEMENTATION", "FASTDDS_BUILTIN_TRANSPORTS", "ROS_AUTOMATIC_DISCOVERY_RANGE")
    assert [ours[key] for key in shared] == [theirs[key] for key in shared]
    assert ours["ROS_LOG_DIR"] != theirs["ROS_LOG_DIR"]


def test_limits_are_put_on_a_running_process(sandbox):
    process = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    try:
        limit(process.pid)
        for kind, most in LIMITS.items():
            soft, hard = resource.prlimit(process.pid, kind)
            assert soft == hard <= most
    finally:
        process.kill()
        process.communicate()


def test_folders_of_two_runs_are_apart(sandbox):
    other = Sandbox(43, "D")
    try:
        assert other.folder != sandbox.folder
    finally:
        other.close()
