"""Launches as fixtures: tests run beside them and after them, as functions, coroutines and with a `yield`."""

import os
import subprocess
import sys
import textwrap
from importlib.metadata import entry_points

TESTS = """
import asyncio
import launch, launch_pytest, pytest
from launch.actions import ExecuteProcess
from launch_pytest.tools import process as tools

ORDER = []

def sleeper():
    return ExecuteProcess(cmd=["sh", "-c", "echo awake; echo oops >&2; exec sleep 600"], cached_output=True)

@pytest.fixture
def hello():
    return ExecuteProcess(cmd=["echo", "hello"], shell=True, cached_output=True)

@launch_pytest.fixture
def short(hello):
    return launch.LaunchDescription([hello, launch_pytest.actions.ReadyToTest()])

@pytest.mark.launch(fixture=short)
def test_yields(hello, launch_context):
    def awaited(output):
        assert output.splitlines() == ["hello"], "never said hello"
        return True
    assert tools.wait_for_output_sync(launch_context, hello, awaited, timeout=60)
    assert not tools.wait_for_output_sync(launch_context, hello, lambda output: output == "never", timeout=0.0)
    assert tools.wait_for_exit_sync(launch_context, hello, timeout=60)  # what has spoken may still be about to end
    yield
    assert hello.return_code == 0

@pytest.mark.launch(fixture=short)
def test_that_yields_twice(hello):
    yield
    yield

@launch_pytest.fixture(scope="module")
def long():
    action = sleeper()
    return launch.LaunchDescription([action]), action

@pytest.mark.launch(fixture=long, shutdown=True)
def test_after(long):
    ORDER.append("after")
    assert long[1].return_code == -2

@pytest.mark.launch(fixture=long)
async def test_coroutine(long, launch_context, event_loop):
    ORDER.append("coroutine")
    assert asyncio.get_running_loop() is event_loop
    assert await tools.wait_for_start(launch_context, long[1], timeout=60)
    assert await tools.wait_for_stderr(launch_context, long[1], lambda text: "oops" in text, timeout=60)
    assert not await tools.wait_for_exit(launch_context, long[1], timeout=0.0)

@pytest.mark.launch(fixture=long)
async def test_async_generator(long):
    ORDER.append("first")
    yield
    ORDER.append("second")
    assert long[1].return_code == -2

class TestInAClass:
    @pytest.mark.launch(fixture=long)
    @pytest.mark.parametrize("number", [1, 2])
    def test_method(self, launch_service, number):
        ORDER.append(number)

@pytest.mark.launch(fixture=short)
def test_wrong():
    assert 1 == 2, "is told"

def test_order():
    assert ORDER == ["coroutine", "first", 1, 2, "after", "second"], ORDER
"""


def test_all_kinds_of_tests(tmp_path):
    (tmp_path / "test_all.py").write_text(textwrap.dedent(TESTS))
    plug_in = (
        () if entry_points(group="pytest11", name="launch_pytest") else ("-p", "gz_course.sim.ros.launch_pytest.plugin")
    )
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-rpf", "-p", "no:cacheprovider", *plug_in],
        cwd=tmp_path,
        env={**os.environ, "ROS_LOG_DIR": str(tmp_path / "ros_log")},
        capture_output=True,
        text=True,
        timeout=600,
    )
    out = done.stdout
    passed = ["test_yields", "test_coroutine", "test_async_generator", "test_after", "test_order"]
    passed += ["test_async_generator[shutdown_test]", "TestInAClass::test_method[1]", "TestInAClass::test_method[2]"]
    for name in passed:
        assert f"PASSED test_all.py::{name}\n" in out, out + done.stderr
    assert "FAILED test_all.py::test_that_yields_twice" in out and "must stop iteration after yielding once" in out
    assert "AssertionError: is told" in out and "2 failed, 8 passed" in out
