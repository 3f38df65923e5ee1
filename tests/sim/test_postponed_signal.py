"""A signal that comes amid the machinery of imports raises nothing there, where a lock would stay taken."""

import signal
import subprocess
import sys
import threading

import pytest

from gz_course.sim import postponed_signal

# SIGINT comes in the moment in which an import takes the lock of all imports; it is sent again when that is over.
PROGRAM = """
import functools, importlib, itertools, os, signal, sys, threading, types
{prepare}
from gz_course.sim import postponed_signal
imported = threading.Event()
send = lambda *signal: imported.wait(60) and os.kill(*signal)
postponed_signal.os = types.SimpleNamespace(getpid=os.getpid, kill=send)
imp = importlib._bootstrap._imp
once = itertools.chain(map(signal.raise_signal, [signal.SIGINT]), itertools.repeat(None))
come = functools.partial(next, once)
importlib._bootstrap._imp = types.SimpleNamespace(**(vars(imp) | dict(acquire_lock=come, release_lock=lambda: None)))
try:
    import this_is_imported
    importlib._bootstrap._imp = imp
    print("imported", flush=True)
    imported.set()
    threading.Event().wait(60)
except KeyboardInterrupt:
    print("interrupted", flush=True)
os._exit(0)
"""
# SIGINT comes in the moment in which a condition has taken its lock.
LOCKING = """
import functools, itertools, os, signal, sys, threading, types
{prepare}
from gz_course.sim import postponed_signal
left = threading.Event()
send = lambda *signal: left.wait(60) and os.kill(*signal)
postponed_signal.os = types.SimpleNamespace(getpid=os.getpid, kill=send)
once = itertools.chain(map(signal.raise_signal, [signal.SIGINT]), itertools.repeat(None))
taken = functools.partial(next, once)
nothing = lambda *_: None
try:
    lock = types.SimpleNamespace(acquire=nothing, release=nothing, __enter__=taken, __exit__=nothing)
    with threading.Condition(lock):
        print("entered", flush=True)
    left.set()
    threading.Event().wait(60)
except KeyboardInterrupt:
    print("interrupted", flush=True)
os._exit(0)
"""
HANDLERS = {
    "course": "from gz_course.grader.process.interruption import end_on; end_on(signal.SIGTERM)",
    "ros2": "from gz_course.sim.ros.ros2 import interruption; interruption.listen()",
    "ros program": "from gz_course.sim.ros.ros_program import program as p; signal.signal(signal.SIGINT, p._interrupt)",
    "gz": "from gz_course.sim.gz import command_line; signal.signal(signal.SIGINT, command_line._interrupt)",
}


@pytest.mark.parametrize("program", HANDLERS)
def test_an_import_is_not_torn_by_an_interrupt(program, tmp_path):
    (tmp_path / "this_is_imported.py").write_text("")
    text = PROGRAM.format(prepare=f"sys.path.insert(0, {str(tmp_path)!r})\n{HANDLERS[program]}")
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, timeout=600)
    assert done.stdout == "imported\ninterrupted\n", done.stderr[-2000:]


@pytest.mark.parametrize("program", HANDLERS)
def test_a_lock_is_not_left_taken_by_an_interrupt(program):
    done = subprocess.run(
        [sys.executable, "-c", LOCKING.format(prepare=HANDLERS[program])], capture_output=True, text=True, timeout=600
    )
    assert done.stdout == "entered\ninterrupted\n", done.stderr[-2000:]


def test_where_conditions_lock():
    assert {code.co_name for code in postponed_signal._LOCKING} == {*postponed_signal._OF_A_CONDITION}


class Frame:
    """A place in a program where a signal comes."""

    def __init__(self, file):
        self.f_code = type("Code", (), {"co_filename": file})


def test_elsewhere_it_comes_at_once():
    came = threading.Event()
    before = signal.signal(signal.SIGUSR1, lambda *_: came.set())
    try:
        assert not postponed_signal.postponed(signal.SIGUSR1, None)
        assert not postponed_signal.postponed(signal.SIGUSR1, Frame("node.py"))
        assert not came.is_set()
        assert postponed_signal.postponed(signal.SIGUSR1, Frame("<frozen importlib._bootstrap>"))
        assert came.wait(60)
    finally:
        signal.signal(signal.SIGUSR1, before)
