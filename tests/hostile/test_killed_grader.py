"""A grader that is killed leaves no process behind, however stubborn its submission is, or the next one ends it."""

import contextlib
import os
import signal
import subprocess
import sys

import psutil
import pytest

from gz_course.grader.process.temporary_folder import sweep
from gz_course.grader.run.sandbox.probe import try_level

DEADLINE = 120.0
# Leaves the process group, hears no signal, does not die with its parent.
STUBBORN = """
import ctypes, os, signal, time
for number in set(signal.Signals) - {signal.SIGKILL, signal.SIGSTOP}:
    signal.signal(number, signal.SIG_IGN)
if os.fork() == 0:
    os.setsid()
ctypes.CDLL(None).prctl(1, 0)
os.write(1, b"ready\\n")
time.sleep(600)
"""
GRADER = f"""
import sys
from gz_course.grader.run.sandbox import Sandbox
sandbox = Sandbox(101, sys.argv[1])
file = sandbox.put_files({{"stubborn.py": {STUBBORN.encode()!r}}}) / "stubborn.py"
boxed = sandbox.start([sys.executable, "-I", "-S", str(file)], {{}})
print((boxed.stdout.readline() + boxed.stdout.readline()).decode().split(), flush=True)
sys.stdin.read()
"""


@pytest.fixture
def kill_a_grader(tmp_path):
    """Start a grader with a stubborn submission at a level, kill it; the processes that it had started."""
    started = []

    def start_and_kill(level):
        if level != "D" and (lack := try_level(level)):
            pytest.skip(f"no level {level} here: {lack}")
        grader = subprocess.Popen(
            [sys.executable, "-c", GRADER, level],
            env=os.environ | {"TMPDIR": str(tmp_path)},  # a grader that is killed cannot remove its folder
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        try:
            assert grader.stdout.readline() == "['ready', 'ready']\n"
            started.extend(psutil.Process(grader.pid).children(recursive=True))
        finally:
            grader.send_signal(signal.SIGKILL)
            grader.communicate()
        return started

    yield start_and_kill
    for each in started:
        with contextlib.suppress(psutil.NoSuchProcess):
            each.kill()


@pytest.mark.parametrize("level", ["A", "B"])
def test_nothing_outlives_a_grader_that_is_killed(level, kill_a_grader):
    started = kill_a_grader(level)
    assert len(started) >= 4  # the box, its process 1, the submission and its child
    assert psutil.wait_procs(started, timeout=DEADLINE)[1] == []


@pytest.mark.parametrize("level", ["C", "D"])
def test_without_walls_the_next_grader_ends_what_outlives_it(level, kill_a_grader, tmp_path, monkeypatch):
    started = kill_a_grader(level)
    assert len(started) == 2 and all(each.is_running() for each in started)
    assert len(list(tmp_path.iterdir())) == 1
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    sweep()
    assert list(tmp_path.iterdir()) == []
    assert psutil.wait_procs(started, timeout=DEADLINE)[1] == []
