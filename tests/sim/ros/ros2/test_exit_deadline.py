"""A process ends in time although the interpreter's lock is held for ever."""

import subprocess
import sys

import pytest

BLOCKED = """
import ctypes
from gz_course.sim.ros.ros2.exit_deadline import end_within
print("all", end=" ")
end_within({code}, 0.3)
{then}
"""


@pytest.mark.parametrize("code", [0, 3])
def test_it_ends_with_the_code_and_what_was_printed(code):
    program = BLOCKED.format(code=code, then="ctypes.PyDLL(None).pause()  # holds the lock")
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout, done.stderr) == (code, "all ", "")


def test_a_process_that_ends_earlier_ends_as_it_wants():
    program = BLOCKED.replace("0.3", "600").format(code=3, then="raise SystemExit(5)")
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout) == (5, "all ")
