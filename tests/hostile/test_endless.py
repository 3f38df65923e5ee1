"""Submissions that would hold a grading up for ever: each comes to an end, also by Ctrl-C, and leaves nothing behind.

A file of `endless/` is imported by an otherwise honest node, or is a node itself. The limits are processor time and
progress, so nothing here depends on how busy the machine is.
"""

import os
import signal
import subprocess
from pathlib import Path

import psutil
import pytest

from gz_course.grader.run.fair_clock import FairClock, Patience
from gz_course.grader.run.sandbox.resource_monitor import descendants
from gz_course.tests.grader.conftest import COURSE, assert_nothing_left, environment, processes_of, run_grade

ENDLESS = Path(__file__).parent / "endless"
SOLUTION = (Path(__file__).parents[2] / "solutions/03_teleop/teleop_node.py").read_text()
NODES = {"answers_itself"}  # the others are imported
# Outcomes, points and words of the diagnosis that are right.
EXPECTED = {
    "always_holds": ({"graded", "timeout", "student_error"}, None, ""),  # it is believed 10,000 times
    "answers_itself": ({"timeout"}, 0, "more than 10000 messages"),
    "reports_megabytes": ({"graded", "timeout", "protocol"}, None, ""),
    "runs_commands": ({"graded"}, 100, ""),
    "starts_processes": ({"graded", "timeout"}, None, ""),
    "stops_itself": ({"timeout"}, 0, "was stopped by a signal"),
    "tells_of_processes": ({"graded", "timeout"}, None, ""),
}
END = 3.0  # [s] that a grading may take to end after a signal
STATE = 5.0  # [s] after which a grading is in the state that would not end
SOON = "from gz_course.grader.run.pace import lockstep\nlockstep.MOST_AT_ONCE = 100\n"


def submission(folder, name):
    """Write a submission into a folder; return the folder."""
    attack = (ENDLESS / f"{name}.py").read_text()
    files = {"teleop_node.py": attack} if name in NODES else {"teleop_node.py": f"import attack\n{SOLUTION}"}
    if name not in NODES:
        files["attack.py"] = attack
    (folder / "submission").mkdir()
    for file, text in files.items():
        (folder / "submission" / file).write_text(text)
    return folder / "submission"


def test_every_file_is_tried():
    assert EXPECTED.keys() == {path.stem for path in ENDLESS.glob("*.py")}


def test_nodes_that_answer_each_other_at_once_are_told_so(tmp_path):
    outcome = run_grade(tmp_path, "03_teleop", submission(tmp_path, "answers_itself"), prelude=SOON)
    assert_nothing_left(outcome)
    assert (outcome.code, outcome.report["outcome"], outcome.report["sim_seconds"]) == (1, "timeout", 1.0)
    assert "Do two callbacks answer each other at once?" in outcome.report["diagnosis"]


@pytest.mark.proof
@pytest.mark.parametrize("name", EXPECTED)
def test_it_ends_by_itself(name, tmp_path):
    outcomes, points, words = EXPECTED[name]
    outcome = run_grade(tmp_path, "03_teleop", submission(tmp_path, name))
    assert_nothing_left(outcome)
    assert outcome.code in (0, 1), outcome.output
    assert outcome.report["outcome"] in outcomes, outcome.report["diagnosis"]
    assert points in (None, outcome.report["score"]), outcome.report["diagnosis"]
    assert words in outcome.report["diagnosis"]


@pytest.mark.proof
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("name", EXPECTED)
def test_a_signal_ends_it_at_once(name, number, tmp_path):
    folder = submission(tmp_path, name)
    command = [*COURSE, "grade", "03_teleop", "--submission", str(folder), "--out", str(tmp_path / "out")]
    course = subprocess.Popen(
        command, cwd=tmp_path, env=environment(tmp_path), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
    )
    try:
        clock = FairClock(lambda: [os.getpid(), course.pid, *descendants(course.pid)])
        while not list(tmp_path.rglob("*.rrd.part")):
            assert course.poll() is None
            psutil.Process(course.pid).children()
        state = Patience(clock, STATE)
        while not state.over() and course.poll() is None:
            wait(course, 0.1)
        by_itself = course.poll() is not None
        patience = Patience(clock, END)
        course.send_signal(number)
        while not wait(course, 0.1):
            assert not patience.over(), f"it lives on after {END:g} s"
        if by_itself:
            assert course.returncode in (0, 1)
        elif name not in ("runs_commands",):  # that one may be done already
            assert course.returncode == (130 if number == signal.SIGINT else 143)
        assert processes_of(tmp_path) == []
        assert [path.name for path in (tmp_path / "tmp").iterdir()] == []
        assert list(tmp_path.rglob("*.part")) == []
    finally:
        course.kill()
        course.communicate()


def wait(course, seconds):
    """Wait for the end of a process; return whether it has come."""
    try:
        course.wait(seconds)
    except subprocess.TimeoutExpired:
        return False
    return True
