"""The submission's process as the grader sees it: what it reports, how much it may say, and that it always ends."""

import ast
import os
import signal
import threading
import time

import psutil
import pytest

from gz_course.grader.kinds.programs import node_command
from gz_course.grader.run.domain import Domain
from gz_course.grader.run.processes.submission_log import LAST_BYTES, LONGEST_LINE, MOST_LINES
from gz_course.grader.run.processes.submission_processes import SubmissionProcesses
from gz_course.grader.run.sandbox import Sandbox
from gz_course.tests.descriptors import left_open, own_descriptors

DEADLINE = 120.0
TOPICS = {"/clock": "rosgraph_msgs/msg/Clock", "/cmd_vel": "geometry_msgs/msg/Twist"}

NODE = """
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_msgs.msg import String

rclpy.init()
node = Node("made")
commands = node.create_publisher(Twist, "/cmd_vel", 10)
words = node.create_subscription(String, "words", print, 10)
"""


@pytest.fixture
def start(tmp_path, monkeypatch):
    """Start a file as a student's process; afterwards neither it nor anything it started runs."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    before = set(psutil.Process().children(recursive=True))
    made = []
    domain = Domain()
    sandbox = Sandbox(domain.id, "D")

    def call(code, name="node.py"):
        file = tmp_path / name
        file.write_text(code)
        made.append(SubmissionProcesses(node_command(file), sandbox, TOPICS))
        return made[-1]

    yield call
    for student in made:
        student.close()
    sandbox.close()
    domain.release()
    left = set(psutil.Process().children(recursive=True)) - before
    assert not left


def until(student, condition):
    end = time.monotonic() + DEADLINE
    while not condition():
        assert time.monotonic() < end, f"exit {student.exit_code}, {[p.progress for p in student.participants]}"
        student.wait(0.05)


def ended(student):
    """Wait for the end as the grader does: who asks whether all has arrived is told so."""

    def over():
        for each in student.participants:
            if each.wants_answer:
                each.answer()
        return not student.running

    until(student, over)
    return student.exit_code


def test_lines_of_both_pipes_and_the_exit_code(start):
    student = start("import sys\nprint('out')\nprint('err', file=sys.stderr)\nsys.exit(3)")
    assert ended(student) == 3
    assert sorted(student.log.take_lines()) == ["err", "out"]
    assert student.log.take_lines() == []


def test_it_runs_as_main_with_ros_arguments_and_simulated_time(start):
    student = start("import sys\nprint(__name__, sys.argv[1:], __file__)")
    ended(student)
    (line,) = student.log.take_lines()
    assert line.startswith("__main__ ['--ros-args', '-p', 'use_sim_time:=true']")
    assert line.endswith("/node.py")


def test_a_traceback_starts_in_the_students_file(start):
    student = start("def deep():\n    raise ValueError('no')\n\n\ndeep()\n")
    assert ended(student) == 1
    text = "\n".join(student.log.take_lines())
    assert "participant" not in text and "runpy" not in text
    assert 'node.py", line 5, in <module>' in text and 'node.py", line 2, in deep' in text


def test_a_module_beside_the_file_can_be_imported(start, tmp_path):
    (tmp_path / "speeds.py").write_text("FAST = 2")
    student = start("from speeds import FAST\nprint(FAST)")
    assert ended(student) == 0
    assert student.log.take_lines() == ["2"]


def test_no_secrets_are_in_its_environment(start):
    student = start("import os\nprint(sorted(k for k in os.environ if 'COURSE' in k or 'PYTEST' in k))")
    ended(student)
    # COURSE_PYTHON comes from the ament prefix: every Python of the environment sets it. The others are meant for the
    # processes it starts, so that they are followed, too.
    (line,) = student.log.take_lines()
    assert set(ast.literal_eval(line)) - {"COURSE_PYTHON"} == {"COURSE_SOCKET", "COURSE_TOPICS"}


def test_its_endpoints_are_reported(start):
    student = start(NODE + "rclpy.spin(node)\n")
    until(student, lambda: student.endpoints)
    found = {(e.kind, e.topic, e.type, e.node) for e in student.endpoints}
    assert ("publisher", "/cmd_vel", "geometry_msgs/msg/Twist", "/made") in found
    assert ("subscription", "/words", "std_msgs/msg/String", "/made") in found
    assert ("subscription", "/clock", "rosgraph_msgs/msg/Clock", "/made") in found
    assert {e.reliability for e in student.endpoints} <= {"RELIABLE", "BEST_EFFORT"}


def test_simulated_time_starts_at_zero_for_a_node_that_follows_it(start):
    student = start(NODE + "rclpy.spin(node)\n")
    until(student, lambda: student.endpoints)
    assert student.participants[0].progress.clock == 0


def test_before_a_publisher_goes_it_waits_to_be_answered(start):
    student = start(NODE + "print('before')\nnode.destroy_publisher(commands)\nprint('after')\n")
    until(student, lambda: student.participants and student.participants[0].wants_answer)
    assert student.log.take_lines() == ["before"]
    student.participants[0].answer()
    assert not student.participants[0].wants_answer
    until(student, lambda: "after" in student.log.take_lines())


def test_an_answer_that_never_comes_is_not_waited_for(start):
    student = start(NODE + "node.destroy_publisher(commands)\nprint('after')\n")
    assert ended(student) == 0
    assert "after" in student.log.take_lines()


def test_a_long_line_is_cut_and_the_next_one_is_whole(start):
    student = start("print('x' * 10_000_000)\nprint('next')")
    ended(student)
    lines = student.log.take_lines()
    assert [len(line) for line in lines] == [LONGEST_LINE, 4]


def test_more_lines_than_are_kept_are_counted(start):
    student = start(f"for n in range({3 * MOST_LINES}): print(n)")
    ended(student)
    lines = student.log.take_lines()
    assert lines[:MOST_LINES] == [str(n) for n in range(MOST_LINES)]
    last = lines[MOST_LINES:]
    assert last == [str(n) for n in range(3 * MOST_LINES - len(last), 3 * MOST_LINES)]
    assert LAST_BYTES * 0.99 < sum(len(line) + 1 for line in last) <= LAST_BYTES
    assert student.log.dropped_lines == 3 * MOST_LINES - len(lines)


def test_bytes_that_are_no_text(start):
    student = start("import os\nos.write(1, b'a\\xff\\xfe\\0b\\nlast')")
    ended(student)
    assert student.log.take_lines() == ["a\ufffd\ufffd\0b", "last"]


def test_a_flood_does_not_hold_the_grader(start):
    """One look at a process that writes faster than anybody reads must come back."""
    student = start("import os\nwhile True: os.write(1, b'\\n' * 65536)")
    process = psutil.Process(student._process.pid)
    rescue = threading.Timer(10.0, process.kill)  # else this test would hang, not fail
    rescue.start()
    try:
        until(student, lambda: student.log._line_count > 0)
        for _ in range(20):
            student.wait(0.01)
        assert process.is_running() and process.status() != psutil.STATUS_ZOMBIE, "`wait` came back only at its end"
    finally:
        rescue.cancel()


@pytest.mark.parametrize("ignored", ["SIGINT", "SIGTERM", "SIGINT, signal.SIGTERM, signal.SIGHUP"])
def test_a_process_that_ignores_signals_is_ended(start, ignored):
    student = start(
        "import signal, time\n"
        f"for s in (signal.{ignored},): signal.signal(s, signal.SIG_IGN)\n"
        "print('ready')\nwhile True: time.sleep(1)"
    )
    until(student, lambda: "ready" in student.log.take_lines())
    student.stop()
    assert not student.running
    assert not psutil.pid_exists(student._process.pid)


@pytest.mark.parametrize("inherited", [signal.default_int_handler, signal.SIG_IGN])
def test_a_polite_process_may_clean_up(start, tmp_path, inherited):
    before = signal.signal(signal.SIGINT, inherited)  # ignored: as in a script that runs the grader with `&`
    student = start(
        "import pathlib, time\ntry:\n    print('ready')\n    while True: time.sleep(1)\n"
        f"finally: pathlib.Path({str(tmp_path / 'cleaned')!r}).touch()"
    )
    signal.signal(signal.SIGINT, before)
    until(student, lambda: "ready" in student.log.take_lines())
    student.stop()
    assert (tmp_path / "cleaned").exists()


DAEMON = """
import os, signal, time
if os.fork() == 0:
    os.setsid()
    if os.fork() == 0:
        for s in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP): signal.signal(s, signal.SIG_IGN)
        print("daemon", os.getpid(), flush=True)
        while True: time.sleep(1)
    os._exit(0)
os.wait()
"""


def daemon_of(student):
    pids = []

    def told():  # beside it Python may warn of the fork, in a line that names the test's folder
        pids.extend(int(x.split()[1]) for x in student.log.take_lines() if x.startswith("daemon "))
        return bool(pids)

    until(student, told)
    assert psutil.pid_exists(pids[0])
    return pids[0]


def test_a_daemon_that_left_the_group_is_killed(start):
    student = start(DAEMON + "while True: time.sleep(1)")
    pid = daemon_of(student)
    student.stop()
    assert not psutil.pid_exists(pid)


def test_the_end_of_the_process_is_seen_though_a_daemon_lives_on(start):
    student = start(DAEMON + "raise SystemExit(3)")
    pid = daemon_of(student)
    assert ended(student) == 3
    student.stop()
    assert not psutil.pid_exists(pid)


def test_a_process_that_forks_while_it_is_stopped_leaves_nothing(start):
    student = start(
        "import os, time\nprint('ready', flush=True)\n"
        "while True:\n    if os.fork() == 0:\n        os.setsid(); time.sleep(60); os._exit(0)\n    time.sleep(0.002)"
    )
    until(student, lambda: "ready" in student.log.take_lines())
    student.stop()  # the fixture looks for what is left


def test_stopping_twice_and_after_the_end_is_harmless(start):
    student = start("print('x')")
    assert ended(student) == 0
    student.stop()
    student.stop()
    assert student.exit_code == 0


def test_it_dies_with_the_grader(start, tmp_path):
    import subprocess
    import sys

    file = tmp_path / "sleeper.py"
    file.write_text("import os, time\nprint(os.getpid(), flush=True)\ntime.sleep(600)")
    code = (
        "from pathlib import Path; from gz_course.grader.run.sandbox import Sandbox\n"
        "from gz_course.grader.kinds.programs import node_command\n"
        "from gz_course.grader.run.processes.submission_processes import *\n"
        f's = SubmissionProcesses(node_command(Path({str(file)!r})), Sandbox(101, "D"), {{}})\n'
        "while not (lines := s.log.take_lines()): s.wait(0.1)\n"
        "print(lines[0], flush=True); input()"
    )
    grader = subprocess.Popen(
        [sys.executable, "-c", code],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"TMPDIR": str(tmp_path)},  # a grader that is killed cannot remove its folder
    )
    try:
        sleeper = psutil.Process(int(grader.stdout.readline()))
        grader.send_signal(signal.SIGKILL)
        grader.wait()
        sleeper.wait(DEADLINE)
    finally:
        grader.kill()
        grader.communicate()


def test_no_descriptor_is_left_open(start):
    before = own_descriptors()
    student = start("print('x')")
    ended(student)
    assert own_descriptors().items() - before.items()
    student.close()
    assert left_open(before) == {}
