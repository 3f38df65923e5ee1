"""The exercise's own node in its sandbox: what it gets and reports, and that the submission beside it sees nothing."""

import sys
import time

import pytest

from gz_course.grader.kinds.given_node import APART
from gz_course.grader.run.domain import Domain
from gz_course.grader.run.processes.exercise_process import NUMBER, ExerciseProcess
from gz_course.grader.run.processes.submission_processes import SubmissionProcesses
from gz_course.grader.run.sandbox import Sandbox
from gz_course.grader.run.sandbox.probe import try_level

DEADLINE = 120.0
SECRET = "hidden-goal"
NODE = """
import rclpy
from course_agent.exercise_node import orders, ready, report

rclpy.init()
node = rclpy.create_node("asks")
word = orders()["word"]
ready()
report(event="got", word=word)
print("printed", flush=True)
rclpy.spin(node)
"""
# Waits until it may start, looks for the secret wherever another process may show it, and knocks at the other door.
SPY = f"""
import os, socket, sys
from pathlib import Path

os.read(int(os.environ["COURSE_GO"]), 1)
secret = {SECRET[::-1]!r}[::-1].encode()
for pid in (p for p in Path("/proc").iterdir() if p.name.isdigit() and int(p.name) != os.getpid()):
    for name in ("cmdline", "environ"):
        try:
            if secret in (pid / name).read_bytes():
                print("ESCAPED", pid / name)
        except OSError:
            pass
try:
    door = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    door.connect(sys.argv[1])
    print("ESCAPED through the door" if door.recv(10) else "refused")
except OSError:
    print("no door")
print("looked", flush=True)
"""


@pytest.fixture
def started(tmp_path, monkeypatch):
    """`started(level, node, spy)`: both, running."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    made = []
    domain = Domain()

    def call(level, node, spy):
        if level != "D" and (lack := try_level(level)):
            pytest.skip(f"no level {level} here: {lack}")
        sandbox = Sandbox(domain.id, level)
        made.append(sandbox)
        other = Sandbox(domain.id, beside=sandbox)
        made.append(other)
        program = f"{APART}/given_node.py"
        beside = ExerciseProcess({program: node.encode()}, program, {"word": SECRET}, other, {})
        made.append(beside)
        door = str(other.socket_folder[0] / "participants")
        processes = SubmissionProcesses([sys.executable, "-c", spy, door], sandbox, {}, beside=beside)
        made.append(processes)
        return processes

    yield call
    for each in reversed(made):
        each.close()
    domain.release()


def until(processes, condition):
    lines = []
    deadline = time.monotonic() + DEADLINE
    while not condition(lines):
        assert time.monotonic() < deadline, (lines, processes.beside.lines, processes.beside.exit_code)
        processes.wait(0.05)
        lines += processes.log.take_lines()
    return lines


@pytest.mark.parametrize("level", ["A", "B", "C", "D"])
def test_its_orders_and_reports_are_seen_by_nobody_else(started, level):
    processes = started(level, NODE, SPY)
    lines = until(processes, lambda lines: "looked" in lines and processes.beside.reports)
    assert not any("ESCAPED" in line for line in lines), lines
    assert processes.beside.ready and processes.beside.reports == [f'{{"event": "got", "word": "{SECRET}"}}']
    until(processes, lambda _: any(p.number == NUMBER and p.progress for p in processes.participants))
    until(processes, lambda _: "printed" in processes.beside.lines)
    assert [p.number for p in processes.participants] == [NUMBER]  # and nobody in its name


def test_the_submission_starts_although_the_node_has_failed(started):
    processes = started("D", "raise SystemExit(3)", SPY)
    until(processes, lambda lines: "looked" in lines)
    assert processes.beside.exit_code == 3 and processes.beside.reports == []
    assert processes.participants == [] or processes.participants[0].number == NUMBER
