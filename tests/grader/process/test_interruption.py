"""A signal that ends a process ends it in order, wherever it strikes."""

import signal
import subprocess
import sys

import pytest

PROGRAM = """
import os, signal, sys, threading
from gz_course.grader.process.interruption import end_on

class Deaf:
    def __del__(self):
        os.kill(os.getpid(), {number})
        for _ in range(1000):
            pass

class Broken:
    def __del__(self):
        raise ValueError("a fault of its own")

end_on(signal.SIGTERM, signal.SIGHUP)
try:
    del (broken := [Broken()])[:]
    del (deaf := [Deaf()])[:]
    print("dropped", flush=True)
    threading.Event().wait(20)
except KeyboardInterrupt:
    sys.exit(130)
finally:
    print("closed", flush=True)
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_that_python_drops_comes_once_more(number):
    program = PROGRAM.format(number=int(number))
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=600)
    assert (done.returncode, done.stdout) == (128 + number, "dropped\nclosed\n")
    assert "a fault of its own" in done.stderr
    assert "SystemExit" not in done.stderr and "KeyboardInterrupt" not in done.stderr


@pytest.mark.parametrize(("before", "code"), [("SIG_DFL", 129), ("SIG_IGN", 0)])
def test_nohup_is_respected(before, code):
    program = (
        "import os, signal; from gz_course.grader.process.interruption import end_on\n"
        f"signal.signal(signal.SIGHUP, signal.{before}); end_on(signal.SIGHUP); os.kill(os.getpid(), signal.SIGHUP)"
    )
    assert subprocess.run([sys.executable, "-c", program], timeout=600).returncode == code
