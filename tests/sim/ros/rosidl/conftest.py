"""Packages of interfaces that a test writes, and ROS nodes in a domain of their own."""

import importlib
import itertools
import os
import threading
import time
import warnings

import pytest

from gz_course.grader.run.domain import Domain
from gz_course.sim.ros.rosidl.package_index import write_index

with warnings.catch_warnings():
    # lark, the parser in ROS's message packages, still imports a deprecated module.
    warnings.simplefilter("ignore", DeprecationWarning)
    import rosidl_generator_py  # noqa: F401

DEADLINE = 120.0
_numbers = itertools.count(1)


class Packages:
    """An ament prefix with packages that are written from texts; no name is used twice in a test session."""

    def __init__(self, prefix):
        self.prefix = prefix

    def write(self, texts, package=None):
        """Write a package from `{"msg/Name.msg": text}`; return its name. `PACKAGE` in a text is replaced by it."""
        package = package or f"tested{next(_numbers)}_msgs"
        for name, text in texts.items():
            path = self.prefix / "share" / package / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text.replace("PACKAGE", package))
        write_index(self.prefix)
        importlib.invalidate_caches()
        return package

    def load(self, texts):
        """Write a package and return its module for each kind of interface it has."""
        package = self.write(texts)
        return [
            importlib.import_module(f"{package}.{kind}") for kind in dict.fromkeys(name.split("/")[0] for name in texts)
        ]


@pytest.fixture(scope="session")
def packages_in():
    """Return what makes a prefix of packages in a folder."""
    return Packages


@pytest.fixture
def packages(tmp_path, monkeypatch):
    prefix = tmp_path / "prefix"
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"{prefix}{os.pathsep}{os.environ['AMENT_PREFIX_PATH']}")
    yield Packages(prefix)
    importlib.invalidate_caches()


class Ros:
    """Two nodes, each with a context of its own, so that all messages go over DDS; spun in turn."""

    def __init__(self, domain):
        import rclpy
        from rclpy.executors import SingleThreadedExecutor

        self._contexts = [rclpy.Context(), rclpy.Context()]
        for context in self._contexts:
            rclpy.init(context=context, domain_id=domain)
        self.nodes = [rclpy.create_node(f"n{i}", context=each) for i, each in enumerate(self._contexts)]
        self._executors = [SingleThreadedExecutor(context=each) for each in self._contexts]
        for executor, node in zip(self._executors, self.nodes, strict=True):
            executor.add_node(node)

    def until(self, condition, what):
        end = time.monotonic() + DEADLINE
        while not condition():
            assert time.monotonic() < end, f"not in time: {what}"
            for executor in self._executors:
                executor.spin_once(timeout_sec=0.002)

    def result(self, future):
        self.until(future.done, "an answer")
        return future.result()

    def close(self):
        for node, executor, context in zip(self.nodes, self._executors, self._contexts, strict=True):
            executor.shutdown()
            node.destroy_node()
            context.try_shutdown()


@pytest.fixture(scope="module")
def ros(tmp_path_factory):
    with Domain() as domain, pytest.MonkeyPatch.context() as patch:
        patch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
        patch.setenv("ROS_LOG_DIR", str(tmp_path_factory.mktemp("ros_log")))
        patch.setenv("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4")
        made = Ros(domain.id)
        yield made
        made.close()


@pytest.fixture
def in_thread():
    """Run a function in a thread; every one has ended when the test ends."""
    threads = []

    def run(function):
        threads.append(threading.Thread(target=function))
        threads[-1].start()
        return threads[-1]

    yield run
    for thread in threads:
        thread.join(DEADLINE)
        assert not thread.is_alive()
