"""Fixtures that run `ros2` as a process in a DDS domain that no other program uses."""

import io
import os
import shlex
import signal
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import psutil
import pytest

from gz_course.grader.run.domain import Domain
from gz_course.tests.sim.spinning import spinning
from gz_course.tests.warm_process import WarmPopen

DEADLINE = 120.0


@pytest.fixture(scope="session")
def ros_domain(tmp_path_factory):
    """Reserve a DDS domain for this session, set it in the environment, and return its number."""
    with Domain() as domain, pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_DOMAIN_ID", str(domain.id))
        patch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
        patch.setenv("ROS_LOG_DIR", str(tmp_path_factory.mktemp("ros_log")))
        yield domain.id


class Command:
    """A running `ros2 …` in its own session, with its lines as they arrive.

    It begins after its imports, unless `process` is `subprocess.Popen`.
    """

    def __init__(
        self,
        *arguments,
        command=(sys.executable, "-m", "gz_course.sim.ros.ros2"),
        environment=None,
        stdin_text=None,
        process=WarmPopen,
        **options,
    ):
        if stdin_text is not None:
            options["stdin"] = subprocess.PIPE
        options = {"stdin": subprocess.DEVNULL, "start_new_session": True, **options}
        self.process = process(
            [*command, *arguments],
            env={**os.environ, "PYTHONFAULTHANDLER": "1", **(environment or {})},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            **options,
        )
        if stdin_text is not None:
            self.process.stdin.write(stdin_text)
            self.process.stdin.close()
        self._changed = threading.Condition()
        self._lines = {"stdout": [], "stderr": []}
        self._readers = [threading.Thread(target=self._read, args=(name,)) for name in self._lines]
        for reader in self._readers:
            reader.start()

    def _read(self, name):
        with getattr(self.process, name) as stream:
            for line in stream:  # ends after the last process of the tree
                with self._changed:
                    self._lines[name].append(line)
                    self._changed.notify_all()

    def wait_for(self, words, stream="stdout", times=1):
        lines = self._lines[stream]
        with self._changed:
            found = self._changed.wait_for(lambda: sum(words in line for line in lines) >= times, DEADLINE)
            assert found, f"no {words!r} in {self._lines}"

    def wait(self):
        """Return (exit code, stdout, stderr) at its end."""
        try:
            code = self.process.wait(DEADLINE)
        except subprocess.TimeoutExpired:
            self.process.send_signal(signal.SIGABRT)  # prints where it hangs
            code = self.process.wait(DEADLINE)
        for reader in self._readers:
            reader.join(DEADLINE)
        return code, "".join(self._lines["stdout"]), "".join(self._lines["stderr"])

    def end(self):
        if self.process.poll() is None:
            tree = psutil.Process(self.process.pid)
            for process in [*tree.children(recursive=True), tree]:
                process.kill()
        self.wait()
        if self.process.stdin:
            self.process.stdin.close()


@pytest.fixture
def start():
    running = []

    def run(*arguments, **options):
        running.append(Command(*arguments, **options))
        return running[-1]

    yield run
    for command in running:
        command.end()


@pytest.fixture
def ros2(start):
    """Run `ros2` to its end; return (exit code, stdout, stderr)."""
    return lambda *arguments, **options: start(*arguments, **options).wait()


@pytest.fixture
def offered(monkeypatch):
    """Return a function that gives the completions of the last of some words after `ros2`."""
    import argcomplete

    from gz_course.sim.ros.ros2.completion import complete

    def offered(*words):
        line = " ".join(["ros2", *(shlex.quote(word) if word else "" for word in words)])
        monkeypatch.setattr(argcomplete.CompletionFinder, "_init_debug_stream", lambda finder: None)
        for name, value in (("_ARGCOMPLETE", "1"), ("COMP_LINE", line), ("COMP_POINT", str(len(line)))):
            monkeypatch.setenv(name, value)
        written = io.StringIO()
        complete(output_stream=written, exit_method=lambda code: None)
        return sorted(word.rstrip(" ") for word in written.getvalue().split("\v") if word)

    return offered


@pytest.fixture
def workspace(tmp_path):
    """Return a prefix with the package my_robot; `workspace(name, text)` adds an executable to it."""
    index = tmp_path / "install/share/ament_index/resource_index/packages"
    index.mkdir(parents=True)
    (index / "my_robot").touch()
    library = tmp_path / "install/lib/my_robot"
    library.mkdir(parents=True)

    def add(name, text):
        path = library / name
        path.parent.mkdir(exist_ok=True)
        if " " in sys.executable:  # the kernel ends the name of an interpreter there; pip writes its scripts like this
            first = f"#!/bin/sh\n'''exec' \"{sys.executable}\" \"$0\" \"$@\"\n' '''"
            text = text.replace(f"#!{sys.executable}", first)
        path.write_text(text)
        path.chmod(0o755)
        return {"AMENT_PREFIX_PATH": str(tmp_path / "install")}

    return add


@pytest.fixture(scope="module")
def robot(ros_domain):
    """Return the spinning node /robot/driver: parameters of every kind, a service, a publisher, a subscription.

    The node /robot/idle does not spin, so its service /robot/silent does not answer.
    """
    import rclpy
    from geometry_msgs.msg import PointStamped, Twist
    from rcl_interfaces.msg import FloatingPointRange, IntegerRange, ParameterDescriptor
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.parameter import Parameter
    from std_srvs.srv import SetBool, Trigger

    context = rclpy.Context()
    rclpy.init(context=context, domain_id=ros_domain)
    node = rclpy.create_node("driver", namespace="/robot", context=context)
    speed = FloatingPointRange(from_value=0.0, to_value=3.0, step=0.5)
    declare = node.declare_parameter
    declare("speed", 1.5, ParameterDescriptor(description="how fast", floating_point_range=[speed]))
    declare("count", 3, ParameterDescriptor(integer_range=[IntegerRange(from_value=0, to_value=9)]))
    declare("frame.id", "base", ParameterDescriptor(additional_constraints="a frame of the robot"))
    declare("frame.parent", "odom")
    declare("armed", True)
    declare("bytes", [b"a", b"\x01"])
    declare("flags", [True, False])
    declare("ports", [1, 2])
    declare("gains", [1.0, 0.5])
    declare("joints", ["left", "right"])
    declare("serial", 7, ParameterDescriptor(read_only=True))
    declare("free", 5, ParameterDescriptor(dynamic_typing=True))
    declare("gone", 5, ParameterDescriptor(dynamic_typing=True))
    declare("unset", Parameter.Type.INTEGER)
    node.create_subscription(Twist, "cmd_vel", lambda message: None, 10)
    stamped = node.create_publisher(PointStamped, "/stamped", 10)

    def enable(request, response):
        response.success, response.message = request.data, "as you wish"
        return response

    node.create_service(SetBool, "enable", enable)
    idle = rclpy.create_node("idle", namespace="/robot", context=context, start_parameter_services=False)
    idle.create_service(Trigger, "silent", lambda request, response: response)  # it is not spun

    def publish():
        point = PointStamped()
        point.header.stamp = node.get_clock().now().to_msg()
        stamped.publish(point)

    node.create_timer(0.1, publish)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    with spinning(executor):
        yield node
    node.destroy_node()
    idle.destroy_node()
    context.try_shutdown()


@pytest.fixture(scope="session")
def run_together():
    """Run several `ros2` commands, a few at a time; return their results in order.

    Many new participants at the same time lose each other's announcements.
    """

    def run(arguments):
        command = Command(*arguments)
        try:
            return command.wait()
        finally:
            command.end()

    with ThreadPoolExecutor(5) as pool:
        yield lambda *commands: list(pool.map(run, commands))
