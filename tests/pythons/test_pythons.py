"""Which Pythons are tried, with what, and what becomes of a command that fails or leaves something running."""

import os
import select
import sys
from contextlib import suppress

import pytest

from gz_course.tests.pythons import trial
from gz_course.tests.pythons.interpreters import PROMISED, Interpreter, found

HERE = (*sys.version_info[:3],)


def has_ended(pid: int) -> bool:
    """Wait for the end of a process that was sent SIGKILL; it is nobody's child here."""
    with suppress(ProcessLookupError):
        watched = os.pidfd_open(pid)
        try:
            return bool(select.select([watched], [], [], 60)[0])
        finally:
            os.close(watched)
    return True


def test_this_python_is_found():
    assert found([sys.executable]) == [Interpreter(sys.executable, HERE)]


@pytest.mark.parametrize("path", ["/bin/false", "/bin/echo", "/nowhere/python3"])
def test_what_is_no_python_is_left_out(path):
    assert found([path]) == []


def test_the_newest_of_a_version_is_tried(tmp_path):
    """Scripts stand for Pythons here: a machine rarely has two of one version."""
    paths = []
    for version in ("3 12 1", "3 12 9", "3 10 2", "3 13 0", "3 99 0"):
        path = tmp_path / version.replace(" ", "_")
        path.write_text(f"#!/bin/sh\necho {version} cpython\n")
        path.chmod(0o755)
        paths.append(str(path))
    assert [each.name for each in found(paths)] == ["3.12.9", "3.13.0"]


def test_a_free_threaded_python_is_left_out(tmp_path):
    path = tmp_path / "python3.13t"
    path.write_text("#!/bin/sh\necho 3 13 0 cpython t\n")
    path.chmod(0o755)
    assert found([str(path)]) == []


def test_every_promised_version_is_tried_in_full_or_with_all_solutions():
    for major, minor in PROMISED:
        commands = trial.commands(Interpreter("python", (major, minor, 0)), ["03_teleop", "13_capstone"])
        words = [" ".join(command) for command in commands]
        if (major, minor) in trial.SUITE:
            assert words == ["make PYTHON=python test"]
        else:
            assert words[0] == "make PYTHON=python demo"
            assert [word.split()[2] for word in words[1:]] == ["03_teleop", "13_capstone"]


def test_the_suite_can_be_left_out():
    (first, *_) = trial.commands(Interpreter("python", (3, 12, 0)), [], suite=False)
    assert first == ["make", "PYTHON=python", "demo"]


def test_outcomes(tmp_path):
    checkout, log = tmp_path / "checkout", tmp_path / "log"
    checkout.mkdir()
    assert trial._run(["sh", "-c", "echo 3 passed; exit 3"], checkout, log) == 3
    assert log.read_text() == "3 passed\n"


def test_a_command_past_its_deadline_is_ended_with_its_children(tmp_path, monkeypatch):
    monkeypatch.setattr(trial, "DEADLINE", 0.2)
    log = tmp_path / "log"
    assert trial._run(["sh", "-c", "sleep 600 & echo $!; wait"], tmp_path, log) == 124
    assert has_ended(int(log.read_text()))


def test_what_a_command_leaves_running_is_ended(tmp_path):
    log = tmp_path / "log"
    assert trial._run(["sh", "-c", "sleep 600 & echo $!"], tmp_path, log) == 0
    assert has_ended(int(log.read_text()))


def test_variables_of_another_environment_are_not_passed_on(tmp_path, monkeypatch):
    monkeypatch.setenv("VIRTUAL_ENV", "/somewhere")
    monkeypatch.setenv("PYTHONPATH", "/somewhere")
    log = tmp_path / "log"
    assert trial._run(["env"], tmp_path, log) == 0
    assert "/somewhere" not in log.read_text()
    assert f"PATH={os.environ['PATH']}" in log.read_text()
