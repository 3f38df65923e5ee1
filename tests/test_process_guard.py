"""However a test run is ended, nothing it has started stays behind."""

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
import uuid
from pathlib import Path

import psutil
import pytest

from gz_course.tests.process_guard import MARK, is_zombie, marked

ROOT = Path(__file__).parents[1]
DEADLINE = 150.0
# A test that has started: a program with a child, each in a session of its own, deaf to everything but SIGKILL.
# The child has lost its parent and has an environment of its own, as a graded submission has.
HANGING = """
import subprocess, sys, threading

PROGRAM = '''
import os, signal, subprocess, sys, threading
for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
    signal.signal(number, signal.SIG_IGN)
if len(sys.argv) < 3:
    home = {"HOME": os.path.join(os.environ["HOME"], "below")}
    if os.fork() == 0:
        subprocess.Popen([sys.executable, "-c", sys.argv[1], sys.argv[1], "below"], start_new_session=True, env=home)
        os._exit(0)
open(f"hangs_{os.getpid()}", "x").close()
threading.Event().wait()
'''

def test_that_hangs(tmp_path, monkeypatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    subprocess.Popen([sys.executable, "-c", PROGRAM, PROGRAM], start_new_session=True).wait()
"""


def wait_until(condition, what):
    end = time.monotonic() + DEADLINE
    while not condition():
        assert time.monotonic() < end, what
        threading.Event().wait(0.05)


def lives(pid):
    """Whether a process runs. Who dies below a test process that adopts orphans stays a zombie."""
    with contextlib.suppress(psutil.NoSuchProcess):
        return not is_zombie(psutil.Process(pid))
    return False


@pytest.mark.timeout(500)
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
@pytest.mark.parametrize("workers", [0, 2])
def test_a_run_that_is_ended_leaves_nothing(tmp_path, number, workers):
    (tmp_path / "test_hanging.py").write_text(HANGING)
    mark = f"{os.environ[MARK]}/{uuid.uuid4().hex}"
    options = ["-q", "-p", "no:cacheprovider", "-p", "gz_course.tests.conftest", "--rootdir", tmp_path]
    options += ["-n", str(workers), "--dist", "each"] if workers else ["-n", "0"]
    run = subprocess.Popen(
        [sys.executable, "-m", "pytest", *options, tmp_path],
        env=os.environ | {MARK: mark, "PYTHONPATH": str(ROOT)},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        cwd=tmp_path,
    )
    try:
        wait_until(lambda: len(list(tmp_path.glob("hangs_*"))) == 2 * max(1, workers), "nothing hangs")
        hanging = [int(path.name.removeprefix("hangs_")) for path in tmp_path.glob("hangs_*")]
        run.send_signal(number)
        assert run.wait(DEADLINE) == -number
        wait_until(lambda: not marked(mark), "something is left")
        wait_until(lambda: not any(lives(each) for each in hanging), "the child is left")
    finally:
        run.kill()  # its guard ends the rest
        run.wait(DEADLINE)


def test_make_passes_a_signal_on_to_the_test_run():
    """A shell between make and pytest would end alone."""
    lines = [line.strip() for line in (ROOT / "Makefile").read_text().splitlines() if "/pytest " in line]
    assert lines and all(line.startswith("exec ") for line in lines), lines
