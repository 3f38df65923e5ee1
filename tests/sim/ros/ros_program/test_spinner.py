"""The executor beside a program: a callback that raises ends it; what goes wrong while it is taken down does not."""

import os
import signal
import subprocess
import sys
import textwrap
import threading
from types import SimpleNamespace

import pytest

from gz_course.sim.ros.ros_program import spinner
from gz_course.sim.ros.ros_program.spinner import Spinner


class Executor:
    """Raises in `spin` when `go` is set."""

    def __init__(self, context):
        self.go = threading.Event()

    def add_node(self, node):
        pass

    def spin(self):
        self.go.wait()
        raise RuntimeError("cannot use Destroyable")

    def shutdown(self, timeout_sec):
        self.go.set()


@pytest.fixture
def spinning(monkeypatch):
    """A spinner, and the signals that it has sent to its process."""
    sent = []
    monkeypatch.setattr("rclpy.executors.SingleThreadedExecutor", Executor)
    monkeypatch.setattr(
        spinner, "os", SimpleNamespace(kill=lambda pid, number: sent.append((pid, number)), getpid=os.getpid)
    )
    return Spinner(SimpleNamespace(context=None)), sent


def test_an_executor_that_raises_while_it_is_shut_down_is_no_failed_callback(spinning):
    made, sent = spinning
    with made:
        pass
    assert (made.error, sent) == ("", [])


def test_a_callback_that_raises_ends_the_program(spinning):
    made, sent = spinning
    with made:
        made._executor.go.set()
        made._thread.join()
    assert (made.error, sent) == ("cannot use Destroyable", [(os.getpid(), signal.SIGTERM)])


def test_a_signal_that_another_thread_gets_ends_the_program_as_any_other():
    """A thread from before the signals were blocked (NumPy's are) gets the signal while the main one sets up."""
    program = """
        import signal, sys, threading
        from gz_course.sim.ros.ros_program import spinner

        class Nothing:
            error = ""
            def __init__(self, node): signal.pthread_kill(older.ident, signal.SIGINT)
            def __enter__(self): return self
            def __exit__(self, *_): pass

        older = threading.Thread(target=threading.Event().wait, daemon=True)
        older.start()
        spinner.block_stop_signals()
        spinner.Spinner = Nothing
        sys.exit(spinner.wait_for_signal(None))
    """
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(program)], capture_output=True, text=True, timeout=600)
    assert (done.returncode, done.stderr) == (0, "")
