"""Fixtures: a DDS domain and a Gazebo partition for the session, ROS, a parameter_bridge, waiting with a deadline."""

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
import uuid
import warnings

import pytest

from gz_course.grader.run.domain import Domain
from gz_course.tests.sim.spinning import spinning
from gz_course.tests.warm_process import WarmPopen

with warnings.catch_warnings():
    # lark, the parser in ROS's message packages, still imports a deprecated module.
    warnings.simplefilter("ignore", DeprecationWarning)
    import rosidl_generator_py  # noqa: F401

DEADLINE = 120.0
COMMAND = [sys.executable, "-m", "gz_course.sim.bridge.ros_gz_bridge.parameter_bridge"]


class Inbox:
    """A callback that stores messages; `wait(n)` returns n messages, or fails at a deadline."""

    def __init__(self):
        self.messages = []
        self._changed = threading.Condition()

    def __call__(self, message):
        with self._changed:
            self.messages.append(message)
            self._changed.notify_all()

    def wait(self, count, timeout=DEADLINE):
        with self._changed:
            done = self._changed.wait_for(lambda: len(self.messages) >= count, timeout)
            assert done, f"{len(self.messages)} of {count} messages arrived in {timeout} s"
            return list(self.messages)


def _eventually(condition, what, timeout=DEADLINE):
    """Wait for a condition that causes no event (DDS discovery, a counter)."""
    pause, end = threading.Event(), time.monotonic() + timeout
    while not condition():
        assert time.monotonic() < end, f"not within {timeout} s: {what}"
        pause.wait(0.005)


@pytest.fixture(scope="session")
def eventually():
    return _eventually


@pytest.fixture
def inbox():
    return Inbox


@pytest.fixture(scope="session")
def ros_domain(tmp_path_factory):
    """Reserve a DDS domain for this session, set it in the environment, and return its number."""
    with Domain() as domain, pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_DOMAIN_ID", str(domain.id))
        patch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
        patch.setenv("ROS_LOG_DIR", str(tmp_path_factory.mktemp("ros_log")))
        patch.setenv(
            "FASTDDS_BUILTIN_TRANSPORTS", "UDPv4"
        )  # a killed process does not remove its files of shared memory
        patch.setenv("GZ_PARTITION", f"test-{uuid.uuid4().hex}")
        patch.setenv("GZ_IP", "127.0.0.1")
        yield domain.id


class Ros:
    """One ROS context whose nodes are spun in a thread."""

    def __init__(self, domain):
        import rclpy
        from rclpy.executors import SingleThreadedExecutor

        self.context = rclpy.Context()
        rclpy.init(context=self.context, domain_id=domain)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.node = self.new_node("tester")
        self._spinning = contextlib.ExitStack()
        self._thread = self._spinning.enter_context(spinning(self.executor))

    def new_node(self, name="bridge", **options):
        import rclpy

        node = rclpy.create_node(name, context=self.context, **options)
        self.executor.add_node(node)
        return node

    def drop_node(self, node):
        self.executor.remove_node(node)
        node.destroy_node()

    def close(self):
        self._spinning.close()
        self.node.destroy_node()
        self.context.try_shutdown()


@pytest.fixture(scope="module")
def ros(ros_domain):
    running = Ros(ros_domain)
    yield running
    running.close()


@pytest.fixture
def stage(ros, eventually):
    from gz_course.tests.sim.bridge.ros_gz_bridge.stage import Stage

    new = Stage(ros, eventually)
    yield new
    new.close()


class Process:
    """A running parameter_bridge with its log lines as they arrive."""

    def __init__(self, *arguments, command=COMMAND):
        self.process = WarmPopen(
            [*command, *arguments],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )
        self.lines = []
        self._changed = threading.Condition()
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self):
        for line in self.process.stderr:
            with self._changed:
                self.lines.append(line.rstrip())
                self._changed.notify_all()
        self.process.stderr.close()

    def wait_for(self, words):
        with self._changed:
            found = self._changed.wait_for(lambda: any(words in line for line in self.lines), DEADLINE)
            assert found, f"no {words!r} in {self.lines}"

    def stop(self, number=signal.SIGINT):
        """Send a signal and return the exit code."""
        os.killpg(self.process.pid, number)
        code = self.process.wait(DEADLINE)
        self._reader.join(DEADLINE)
        return code

    def end(self):
        if self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.process.wait(DEADLINE)
        self._reader.join(DEADLINE)


@pytest.fixture
def start(ros_domain):
    running = []

    def run(*arguments, **options):
        running.append(Process(*arguments, **options))
        return running[-1]

    yield run
    for process in running:
        process.end()
