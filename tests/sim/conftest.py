"""Fixtures for tests of ROS programs: a DDS domain and a Gazebo partition for each session, programs, a simulator."""

import contextlib
import importlib
import os
import signal
import subprocess
import sys
import threading
import uuid
import warnings
from pathlib import Path

import psutil
import pytest

from gz_course.grader.run.domain import Domain
from gz_course.tests.warm_process import WarmPopen

DEADLINE = 120.0


class Program:
    """A child process with its output so far and its end."""

    def __init__(self, command, environment, folder):
        self.process = WarmPopen(
            [str(word) for word in command],
            env=environment,
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        self.said = ""
        self._changed = threading.Condition()
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self):
        for line in self.process.stdout:
            with self._changed:
                self.said += line
                self._changed.notify_all()
        self.process.stdout.close()

    def wait_for(self, words):
        with self._changed:
            found = self._changed.wait_for(lambda: words in self.said, DEADLINE)
        assert found, f"no {words!r} in {self.said}"

    def wait(self):
        """Return its exit code after it has ended by itself."""
        code = self.process.wait(DEADLINE)
        self._reader.join(DEADLINE)
        assert "Traceback" not in self.said, self.said
        return code

    def stop(self, number=signal.SIGINT):
        self.process.send_signal(number)
        return self.wait()

    def end(self):
        """Kill it and all its descendants: `ros2 run` gives its child a process group of its own."""
        if self.process.poll() is None:
            family = psutil.Process(self.process.pid).children(recursive=True)
            for each in [*family, self.process]:
                with contextlib.suppress(psutil.NoSuchProcess):
                    each.kill()
            self.process.wait(DEADLINE)
        self._reader.join(DEADLINE)


class Programs:
    """Starts programs in the same DDS domain and Gazebo partition, which no other program uses."""

    def __init__(self, domain, folder):
        self.partition = f"test-{uuid.uuid4().hex}"
        self.domain = domain
        self.folder = folder
        self.ros = {
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
            # A killed process does not remove its files of shared memory.
            "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4",
            "ROS_LOG_DIR": str(folder / "ros_log"),
        }
        self.environment = {
            **os.environ,
            **self.ros,
            "ROS_DOMAIN_ID": str(domain),
            "GZ_PARTITION": self.partition,
            "GZ_IP": "127.0.0.1",
        }
        self._started = []

    def start(self, *command, **variables):
        self._started.append(Program(command, self.environment | variables, self.folder))
        return self._started[-1]

    def ros2(self, *words, **variables):
        return self.start(sys.executable, "-m", "gz_course.sim.ros.ros2", *words, **variables)

    def module(self, name, *words, **variables):
        return self.start(sys.executable, "-P", "-m", name, *words, **variables)

    def finished(self, name, *words, **variables):
        """Run a module to its end; return its exit code and output."""
        program = self.module(name, *words, **variables)
        return program.wait(), program.said

    def gz_sim(self, world):
        """Start a server with a world called `small` with this content of <world>."""
        path = self.folder / f"{uuid.uuid4().hex}.sdf"
        path.write_text(f"<sdf version='1.9'><world name='small'>{world}</world></sdf>")
        return self.start(Path(sys.executable).with_name("gz"), "sim", "-r", "-s", path)

    def gz_node(self, partition=None):
        from gz_course.sim.gz.transport import Node, NodeOptions

        options = NodeOptions()
        options.partition = partition or self.partition
        return Node(options)

    def scene(self):
        """Return the models of the world `small`, as gz.msgs.Model by name."""
        from gz_course.sim.gz.msgs.empty_pb2 import Empty
        from gz_course.sim.gz.msgs.scene_pb2 import Scene

        with self.gz_node() as node:
            done, scene = node.request("/world/small/scene/info", None, Empty, Scene, round(DEADLINE * 1000))
        assert done
        return {model.name: model for model in scene.model}

    def close(self):
        for program in reversed(self._started):
            program.end()


@pytest.fixture(scope="session")
def free_domain():
    """Return the number of a DDS domain reserved for this session."""
    with Domain() as domain:
        yield domain.id


@pytest.fixture(scope="module")
def programs(free_domain, tmp_path_factory):
    made = Programs(free_domain, tmp_path_factory.mktemp("programs"))
    yield made
    made.close()


@pytest.fixture
def ros_node(programs, monkeypatch):
    """Return a ROS node of this process in the domain of the programs; its user spins it."""
    with warnings.catch_warnings():
        # lark, the parser in ROS's message packages, still imports a deprecated module.
        warnings.simplefilter("ignore", DeprecationWarning)
        import rclpy
        import rosidl_generator_py  # noqa: F401
    for name, value in programs.ros.items():
        monkeypatch.setenv(name, value)
    context = rclpy.Context()
    rclpy.init(context=context, domain_id=programs.domain)
    node = rclpy.create_node("tester", context=context)
    yield node
    node.destroy_node()
    context.try_shutdown()


@pytest.fixture
def spin_until(ros_node):
    """Run the callbacks of `ros_node` until a condition holds; fail after a deadline."""
    import time

    from rclpy.executors import SingleThreadedExecutor

    executor = SingleThreadedExecutor(context=ros_node.context)
    executor.add_node(ros_node)

    def spin(condition, what):
        end = time.monotonic() + DEADLINE
        while not condition():
            assert time.monotonic() < end, f"not in time: {what}"
            executor.spin_once(timeout_sec=0.02)

    yield spin
    executor.shutdown()


@pytest.fixture
def call(programs, monkeypatch, capfd):
    """Run a program's `main` in this process, much faster than in a child process; return exit code and output."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        import rosidl_generator_py  # noqa: F401
    for name in ("ROS_DOMAIN_ID", "GZ_PARTITION", "GZ_IP", *programs.ros):
        monkeypatch.setenv(name, programs.environment[name])
    monkeypatch.chdir(programs.folder)
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, ())

    def call(module, *words):
        code = importlib.import_module(module).main(list(words))
        out, err = capfd.readouterr()
        return code, out + err

    yield call
    signal.pthread_sigmask(signal.SIG_SETMASK, mask)
    for number, handler in handlers.items():
        signal.signal(number, handler)
