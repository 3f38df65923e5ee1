"""Every wait with an end in our programs takes the time that it should: that of the machine, or that of the world.

In a grading Python's clocks and waits take simulated time. A file that calls one of them stands in the table below,
with what it waits for. What waits for the machine calls `machine_clock`, or waits in the kernel.
"""

import argparse
import ast
import threading
import time
from pathlib import Path

import pytest

from gz_course.sim import machine_clock

SIM = Path(__file__).parents[2] / "sim"
# Gazebo's side is not among them: in a grading its processes have no node of ROS, and the grader has the simulator.
SIDES = ("bridge", "ros", "show", ".")
MACHINE = "the machine: the agent replaces its clock"
WORLD = "the world: rates, messages, services and transforms, as in the nodes of students"
STAMP = "nothing: a moment that is written down"
ENDING = "a thread that is ending; while one of its callbacks runs, no simulated time passes"
PEOPLE = "people, with a terminal or a page"
TESTS = "tests of a launch, which no grading runs"
GRADER = "a bridge that runs by itself or in the grader; the agent replaces it in a submission"
TIMED = {
    "bridge/ros_gz_bridge/bridge.py": GRADER,
    "bridge/ros_gz_bridge/echo_filter.py": GRADER,
    "bridge/ros_gz_bridge/link.py": GRADER,
    "bridge/ros_gz_bridge/ros_listener.py": GRADER,
    "bridge/ros_gz_bridge/watch.py": GRADER,
    "bridge/ros_gz_bridge/worker.py": GRADER,
    "child_end.py": MACHINE,  # on a kernel without pidfd; the agent gives `subprocess` the clock of the run
    "machine_clock.py": MACHINE,
    "ros/launch/actions/execute_local.py": MACHINE,  # which it asks after every wait
    "ros/launch/logging/__init__.py": STAMP,
    "ros/launch_pytest/tools/process.py": TESTS,
    "ros/launch_ros/actions/lifecycle_node.py": WORLD,
    "ros/launch_testing/io_handler.py": TESTS,
    "ros/launch_testing/markers.py": TESTS,
    "ros/launch_testing/proc_info_handler.py": TESTS,
    "ros/launch_testing/test_result.py": TESTS,
    "ros/launch_testing/test_runner.py": TESTS,
    "ros/launch_testing/tools/process.py": TESTS,
    "ros/launch_testing_ros/message_pump.py": TESTS,
    "ros/launch_testing_ros/wait_for_topics.py": TESTS,
    "ros/ros2/command/bag/record.py": WORLD,
    "ros/ros2/command/service/call.py": WORLD,
    "ros/ros2/command/topic/bw.py": WORLD,
    "ros/ros2/command/topic/echo.py": WORLD,
    "ros/ros2/command/topic/hz.py": WORLD,
    "ros/ros2/command/topic/pub.py": WORLD,
    "ros/ros2/graph.py": WORLD,  # `spin_until`
    "ros/ros2/hello.py": PEOPLE,
    "ros/ros2/measurement.py": WORLD,
    "ros/ros_program/last_words.py": STAMP,
    "ros/ros_program/program.py": STAMP,
    "ros/ros_program/spinner.py": ENDING,
    "ros/rosbag2/playing/playback_clock.py": WORLD,
    "ros/rosbag2/playing/player.py": WORLD,
    "ros/rosbag2/playing/service_requests.py": WORLD,
    "ros/rosbag2/recording/recorder.py": STAMP,
    "ros/rosbag2/recording/writing_thread.py": WORLD,
    "ros/tf2_ros/buffer.py": WORLD,
    "show/rqt_graph/page.py": PEOPLE,
    "show/rviz2/canvas.py": PEOPLE,
    "show/rviz2/page.py": PEOPLE,
    "show/teleop_twist_keyboard/teleop_twist_keyboard.py": PEOPLE,
    "show/teleop_twist_keyboard/terminal.py": PEOPLE,
}
CLOCKS = {"sleep", *(f"{clock}{unit}" for clock in ("time", "monotonic", "perf_counter") for unit in ("", "_ns"))}
# Calls that wait, and how many arguments they have without the one for an end.
WAITS = {"communicate": 1, "get": 2, "join": 0, "result": 0, "select": 3, "wait": 0, "wait_for": 1, "shutdown": 9}


def timed(text):
    """The places in a text that ask a clock of Python, or wait with an end."""
    tree = ast.parse(text)
    imports = [each for node in ast.walk(tree) if isinstance(node, ast.Import) for each in node.names]
    clocks = {each.asname or each.name for each in imports if each.name == "time"}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module in ("gz_course.sim.machine_clock", "time"):
            yield f"{node.lineno}: {ast.unparse(node)}, a name that the agent cannot replace"
        if isinstance(node, ast.Attribute) and node.attr in CLOCKS and ast.unparse(node.value) in clocks:
            yield f"{node.lineno}: {ast.unparse(node)}"
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and is_wait(node):
            yield f"{node.lineno}: {ast.unparse(node)}"


def is_wait(call):
    name, receiver = call.func.attr, ast.unparse(call.func.value)
    ends = any((each.arg or "").startswith("timeout") for each in call.keywords)
    if receiver.endswith(("graph", "machine_clock")):  # these have the clock of the machine
        return False
    if name == "join" and ("Thread" not in receiver and "thread" not in receiver and receiver != "self"):
        return ends  # of texts and paths
    return name in WAITS and (ends or len(call.args) > WAITS[name])


FILES = {
    path.relative_to(SIM).as_posix(): path
    for side in SIDES
    for path in (SIM.glob("*.py") if side == "." else (SIM / side).rglob("*.py"))
}


def test_a_wait_with_an_end_says_whose_time_it_takes():
    found = {name: list(timed(path.read_text())) for name, path in FILES.items()}
    unknown = {name: places for name, places in found.items() if places and name not in TIMED}
    assert not unknown, "wait by machine_clock, or say in the table what is waited for"
    assert [name for name in TIMED if not found.get(name)] == [], "they wait no more"


@pytest.mark.parametrize(
    "line",
    [
        "time.sleep(1)",
        "end = time.monotonic() + 2",
        "process.wait(3)",
        "process.wait(timeout=end)",
        "event.wait(left)",
        "self._thread.join(2.0)",
        "select.select([a], [], [], 0.5)",
        "queue.get(timeout=1)",
        "condition.wait_for(done, 5)",
        "future.result(timeout=1)",
        "from time import sleep",
        "from gz_course.sim.machine_clock import now",
    ],
)
def test_such_waits_are_found(line):
    assert len(list(timed(f"import time\n{line}"))) == 1


@pytest.mark.parametrize("line", ["event.wait()", "', '.join(names)", "machine_clock.pause(1)", "process.wait()"])
def test_others_are_not(line):
    assert list(timed(f"import time\n{line}")) == []


@pytest.fixture
def frozen(monkeypatch):
    """The clock of the world stands still, and nobody can sleep by it; that of the machine goes on by pauses."""
    moment, paused = time.monotonic(), [0.0]

    def fail(*_):
        raise AssertionError("this takes simulated time")

    def pause(seconds):
        paused[0] += seconds

    monkeypatch.setattr(time, "monotonic", lambda: moment)
    monkeypatch.setattr(time, "sleep", fail)
    monkeypatch.setattr(machine_clock, "now", lambda: moment + paused[0])
    monkeypatch.setattr(machine_clock, "pause", pause)
    return paused


def test_discovery_takes_the_time_of_the_machine(frozen, monkeypatch):
    from gz_course.sim.ros.ros2.graph import TARGET_DEADLINE, Graph

    graph = Graph.__new__(Graph)
    monkeypatch.setattr(graph, "_participants", argparse.Namespace(all_known=lambda: False), raising=False)
    assert not graph._wait(lambda: False, TARGET_DEADLINE)
    assert frozen[0] == pytest.approx(TARGET_DEADLINE, abs=0.1)


def test_an_event_is_awaited_as_ever_where_nothing_is_simulated():
    event = threading.Event()
    assert not machine_clock.await_event(event, 0.001)
    event.set()
    assert machine_clock.await_event(event, 1000.0)
