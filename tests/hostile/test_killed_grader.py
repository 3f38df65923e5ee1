"""A grader that is killed leaves no process behind, however stubborn its submission is."""

import os
import signal
import subprocess
import sys

import psutil
import pytest

from grader.run.sandbox.probe import try_level

DEADLINE = 30.0
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
from grader.run.sandbox import Sandbox
sandbox = Sandbox(101, sys.argv[1])
file = sandbox.stage({{"stubborn.py": {STUBBORN.encode()!r}}}) / "stubborn.py"
boxed = sandbox.start([sys.executable, "-I", "-S", str(file)], {{}})
print((boxed.stdout.readline() + boxed.stdout.readline()).decode().split(), flush=True)
sys.stdin.read()
"""


@pytest.mark.parametrize("level", ["A", "B"])
def test_nothing_outlives_a_grader_that_is_killed(level, tmp_path):
    if lack := try_level(level):
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
        below = psutil.Process(grader.pid).children(recursive=True)
        assert len(below) >= 4  # the box, its process 1, the submission and its child
        grader.send_signal(signal.SIGKILL)
        grader.wait()
        assert psutil.wait_procs(below, timeout=DEADLINE)[1] == []
    finally:
        grader.kill()
        grader.communicate()
