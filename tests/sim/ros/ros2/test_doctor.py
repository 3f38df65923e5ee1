"""`ros2 doctor` and `ros2 daemon`: commands that are elsewhere or missing here."""

import argparse
import subprocess
import sys

import pytest

from gz_course.sim.ros.ros2.command import doctor
from gz_course.sim.ros.ros2.errors import CommandError


@pytest.fixture
def course(tmp_path, monkeypatch):
    """Install a program `course` beside the Python; its text is the argument of `course(text)`."""
    monkeypatch.setattr(sys, "executable", str(tmp_path / "python"))
    monkeypatch.setenv("PATH", "/usr/bin:/bin")
    # run_child waits for signals, which in a test run other threads may get.
    monkeypatch.setattr(doctor, "run_child", subprocess.call)

    def write(text):
        (tmp_path / "course").write_text(f"#!/bin/sh\n{text}\n")
        (tmp_path / "course").chmod(0o755)

    return write


def run(**options):
    return doctor.main(argparse.Namespace(**{"json": False, "verb": None, **options}))


def test_doctor_is_course_doctor(course, capfd):
    course('[ "$2" = --help ] && exit 0; echo "asked: $*"; exit 3')
    assert run() == 3
    assert run(json=True) == 3
    assert capfd.readouterr().out == "asked: doctor\nasked: doctor --json\n"


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (None, "there is no `course` command in this environment"),
        ("exit 2", "has no such command yet"),
        ("exec sleep 20", "does not answer within 0.2 s"),
    ],
)
def test_what_is_missing_is_said(course, monkeypatch, text, sentence):
    monkeypatch.setattr(doctor, "_DEADLINE", 0.2)
    if text:
        course(text)
    with pytest.raises(CommandError, match=sentence):
        run()


def test_the_daemon_does_not_run(ros2):
    assert ros2("daemon", "stop") == ros2("daemon", "status") == (0, "The daemon is not running\n", "")
    assert ros2("daemon", "start") == (0, "No daemon is needed: every command looks at the graph itself\n", "")
