"""The executor beside a program: a callback that raises ends it; what goes wrong while it is taken down does not."""

import os
import signal
import threading
from types import SimpleNamespace

import pytest

from gz_course.sim.ros_program import spinner
from gz_course.sim.ros_program.spinner import Spinner


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
