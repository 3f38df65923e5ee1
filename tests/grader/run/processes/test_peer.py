"""Who is connected: only processes of the box, each once, as what the kernel says they are."""

import os
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from gz_course.grader.run.domain import Domain
from gz_course.grader.run.processes.peer import Peer
from gz_course.grader.run.processes.process_tree import START_UP, ProcessTree
from gz_course.grader.run.processes.submission_processes import SubmissionProcesses
from gz_course.grader.run.sandbox import Sandbox
from gz_course.grader.run.sandbox.probe import try_level

DEADLINE = 120.0  # [s]
HELLO = '{"hello": {"pid": 1, "group": 1, "command": ["python", "gz", "sim"]}}'
STRANGER = f"""
import os, socket, sys
folder, name = os.path.split(sys.stdin.readline().strip())
os.chdir(folder)  # the path may be longer than the address of a socket
channel = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
channel.connect(name)
try:
    channel.send({HELLO!r}.encode())
    heard = channel.recv(100)
except OSError:
    heard = b""
print("heard" if heard else "refused", flush=True)
"""
# A child that clears its environment, a second connection, and a name that is not its own.
MEMBER = f"""
import os, socket, subprocess, sys
CODE = '''
import os, socket, sys, time
folder, name = os.path.split(sys.argv[1])
os.chdir(folder)
channels = [socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) for _ in range(2)]
for each in channels:
    each.connect(name)
channels[0].send(sys.argv[2].encode())
print("second", channels[1].recv(100), flush=True)
time.sleep(1000)
'''
path = os.environ["COURSE_SOCKET"]
subprocess.run([sys.executable, "-I", "-c", CODE, path, {HELLO!r}], env={{}}, close_fds=True)
"""


@pytest.fixture
def boxed(tmp_path, monkeypatch):
    """`boxed(level, code)`: a program that runs in a box of that level, and its socket."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    made = []
    domain = Domain()

    def call(level, code):
        sandbox = Sandbox(domain.id, level)
        made.insert(0, sandbox)
        processes = SubmissionProcesses([sys.executable, "-c", code], sandbox, {})
        made.insert(0, processes)
        return processes, sandbox.socket_folder[0] / "participants"

    yield call
    for each in made:
        each.close()
    domain.release()


def until(processes, condition):
    deadline = time.monotonic() + DEADLINE
    while not condition():
        assert time.monotonic() < deadline, processes.log.take_lines()
        processes.wait(0.05)


@pytest.mark.parametrize("level", ["A", "C"])
def test_each_process_of_the_box_connects_once_and_is_what_it_is(boxed, level):
    if lack := try_level(level):
        pytest.skip(f"no level {level} here: {lack}")
    processes, _ = boxed(level, MEMBER)
    lines = []

    def refused():
        lines.extend(processes.log.take_lines())
        return any(line.startswith("second b''") for line in lines)

    until(processes, refused)
    (member,) = (each for each in processes.participants if "-I" in each.command)
    assert member.command[0] == sys.executable and "gz" not in member.command[:4]
    assert member.alive and member.pid != 1 and member.peer.program == ("", ())


def test_a_process_of_another_grading_is_not_heard(boxed):
    stranger = subprocess.Popen(
        [sys.executable, "-I", "-c", STRANGER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    with stranger:
        processes, path = boxed("C" if not try_level("C") else "D", "import time; time.sleep(1000)")
        stranger.stdin.write(f"{path}\n")
        stranger.stdin.flush()
        os.set_blocking(stranger.stdout.fileno(), False)
        until(processes, lambda: stranger.poll() is not None)
        assert stranger.stdout.read() == "refused\n"
    assert processes.participants == []


@pytest.mark.parametrize(
    ("words", "program"),
    [
        (
            ["-P", "-m", "gz_course.sim.bridge.ros_gz_bridge.parameter_bridge", "-h"],
            "gz_course.sim.bridge.ros_gz_bridge.parameter_bridge",
        ),
        (["-m", "gz_course.sim.gz.command", "sim"], ""),  # may be a file of the current folder
        ([str(Path(sys.executable).with_name("gz")), "sim"], "gz"),
        (["-c", "pass", str(Path(sys.executable).with_name("gz")), "sim"], ""),
        (["/tmp/gz", "sim"], ""),
    ],
)
def test_programs_of_the_course_are_known_by_their_command_lines(words, program):
    from gz_course.grader.run.processes.peer import _program

    assert _program((sys.executable, *words))[0] == program


def test_a_process_that_is_over_is_nothing():
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    with ours, theirs:
        assert Peer.of(ours).alive and Peer.of(ours).pid == os.getpid()
    ended = subprocess.Popen([sys.executable, "-I", "-S", "-c", ""])
    ended.wait()
    assert not Peer.look(ended.pid).alive


@pytest.mark.parametrize(("age", "waits"), [(0.1, True), (None, False), (START_UP + 1, False)])
def test_only_a_young_process_that_exists_is_waited_for(age, waits):
    tree = ProcessTree(lambda pid: age)
    tree.hear({"started": {"pid": 7, "program": "python3"}})
    assert tree.changing is waits


def test_who_has_waited_for_a_processor_since_it_started_is_young():
    tree = ProcessTree(lambda pid: START_UP + 1, delayed=lambda: 2.0)
    tree.hear({"started": {"pid": 7, "program": "python3"}})
    assert tree.changing


def test_who_is_said_to_start_again_and_again_is_waited_for_once():
    ages = iter([0.0, START_UP + 1, START_UP + 1, START_UP + 1])
    tree = ProcessTree(lambda pid: next(ages))
    tree.hear({"started": {"pid": 7, "program": "python3"}})
    tree._processes[7].since = tree._processes[7].started = time.monotonic() - START_UP - 1
    tree.hear({"started": {"pid": 7, "program": "python3"}})
    assert not tree.changing


def test_a_process_that_runs_has_not_ended_whatever_is_said():
    start = time.monotonic()
    tree = ProcessTree(lambda pid: time.monotonic() - start)
    tree.hear({"started": {"pid": 7, "program": "python3"}})
    tree.hear({"ended": {"pid": 7, "code": 0}})
    assert tree.changing and tree.codes() == {}
