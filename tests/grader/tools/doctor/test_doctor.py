"""`course doctor` as a whole: on a machine that works it says so, and what does not work it finds."""

import json
import signal
import subprocess
import sys
import threading
import time

import pytest

from gz_course.grader.registry import module_names
from gz_course.grader.tools.doctor import checks
from gz_course.tests.warm_process import WarmPopen

DEADLINE = 120.0


@pytest.fixture
def doctor(course, clean):
    def run(*arguments, **variables):
        outcome = course("doctor", *arguments, **variables)
        clean(outcome)
        return outcome

    return run


def test_this_machine_works(doctor):
    outcome = doctor("--json", "--deadline", "60")
    report = json.loads(outcome.stdout)
    found = {finding["check"]: finding for finding in report["findings"]}
    assert (outcome.code, report["works"]) == (0, True), outcome.output
    assert list(found) == module_names(checks)
    for name in ("dds", "gz_transport", "physics", "recordings", "python_version", "sandbox", "ros_libraries"):
        assert found[name]["status"] == "ok", found[name]
    for finding in found.values():
        assert set(finding) == {"check", "title", "status", "seen", "fix"}
        assert finding["seen"] and bool(finding["fix"]) == (finding["status"] != "ok")
    assert 0 < report["wall_seconds"] < DEADLINE


def test_what_does_not_work_is_told_with_its_remedy(doctor, tmp_path):
    """Two faults of a shell, and no time for anything that needs a process."""
    (tmp_path / "file").write_text("")
    outcome = doctor(
        "--deadline", "0.001", ROS_LOG_DIR=str(tmp_path / "file/log"), RMW_IMPLEMENTATION="rmw_cyclonedds_cpp"
    )
    assert outcome.code == 1
    lines = outcome.stdout.splitlines()
    (log,) = [i for i, line in enumerate(lines) if line.startswith("failed") and "file/log cannot be written" in line]
    assert "->" in lines[log + 1] and "ROS_LOG_DIR" in lines[log + 1]
    assert "unset RMW_IMPLEMENTATION" in outcome.stdout
    assert "no answer within 0.001 s" in outcome.stdout
    assert "\x1b" not in outcome.stdout


@pytest.mark.parametrize("arguments", [("--deadline", "0"), ("--deadline", "nan"), ("--jsn",), ("more",)])
def test_bad_usage(doctor, arguments):
    outcome = doctor(*arguments)
    assert outcome.code == 2 and "Traceback" not in outcome.output


def test_an_interrupt_leaves_nothing(tmp_path, course_environment, running_in):
    process = WarmPopen(
        [sys.executable, "-c", "from gz_course.grader.course import main; main()", "doctor", "--deadline", "60"],
        cwd=tmp_path,
        env=course_environment(tmp_path),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    pause, end = threading.Event(), time.monotonic() + DEADLINE
    while len(running_in(tmp_path)) < 2:  # itself and a probe
        assert time.monotonic() < end and process.poll() is None
        pause.wait(0.01)
    process.send_signal(signal.SIGTERM)
    output = process.communicate(timeout=DEADLINE)[0].decode()
    left = running_in(tmp_path)
    for each in left:
        each.kill()
    assert left == []
    assert process.returncode in (143, -signal.SIGTERM), output
    assert list((tmp_path / "tmp").iterdir()) == [] and "Traceback" not in output
