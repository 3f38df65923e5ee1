"""Processes of a submission and a grader that has nothing but a clock: what they say, tick by tick."""

import os
import sys
import textwrap

import pytest

from gz_course.grader.run.agent.course_agent.executor_monitor import HOLD, SIMULATED_CLOCKS
from gz_course.grader.run.domain import Domain
from gz_course.grader.run.processes.submission_processes import SubmissionProcesses
from gz_course.grader.run.sandbox import Sandbox
from gz_course.sim.gz.msgs.clock_pb2 import Clock
from gz_course.sim.gz.msgs.int32_pb2 import Int32 as gz_Int32

CLOCK = "/clock"
KEPT = "/kept"  # with `kept`, the bridge publishes the number of each tick, and keeps it for late subscriptions
GZ_TYPES = {"rosgraph_msgs/msg/Clock": "gz.msgs.Clock", "std_msgs/msg/Int32": "gz.msgs.Int32"}
TICK_NS = 100_000_000
START = """
import subprocess, sys
children = [subprocess.Popen([sys.executable, name, "--ros-args", "-p", "use_sim_time:=true"]) for name in sys.argv[1:]]
for child in children: child.wait()
"""
NODE = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Int32, String
from std_srvs.srv import SetBool, Trigger

rclpy.init()
node = Node({name!r})
"""


class Played:
    """What was heard from the submission, in order, and how time went on."""

    def __init__(self):
        self.heard = []
        self.lines = []
        self.pace = None
        self.too_early = {}


@pytest.fixture
def play(tmp_path, monkeypatch):
    """Run files as processes of one submission for some ticks of simulated time; what they said on `observe`."""
    from gz_course.grader.run.grader_endpoints import GraderEndpoints
    from gz_course.grader.run.pace.lockstep import LockStep
    from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction
    from gz_course.sim.gz.transport import Node, NodeOptions, Scope

    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))

    def call(ticks=10, observe=None, holding=True, simulated=False, kept=False, before_tick=None, **files):
        observe = observe or {"/said": "std_msgs/msg/String"}
        played = Played()
        names = []
        for name, code in files.items():
            path = tmp_path / f"{name}.py"
            path.write_text(NODE.format(name=name) + textwrap.dedent(code).replace("{name}", name))
            names.append(str(path))
        (tmp_path / "start.py").write_text(START)
        offered = {CLOCK: "rosgraph_msgs/msg/Clock"} | ({KEPT: "std_msgs/msg/Int32"} if kept else {})
        with Domain() as domain:
            sandbox = Sandbox(domain.id, "D")
            student = SubmissionProcesses(
                [sys.executable, str(tmp_path / "start.py"), *names],
                sandbox,
                {"publisher": observe, "subscription": offered, "transient_local": offered if kept else {}},
                ({HOLD: "1"} if holding else {}) | ({SIMULATED_CLOCKS: "1.0"} if simulated else {}),
            )
            for key, value in sandbox.grader_environment().items():
                monkeypatch.setenv(key, value)
            options = NodeOptions(scope=Scope.PROCESS, partition=f"test-{os.getpid()}-{domain.id}")
            ours, bridges = Node(options), Node(options)
            clock = ours.advertise(CLOCK, Clock)
            numbers = ours.advertise(KEPT, gz_Int32)
            ros = GraderEndpoints(
                domain.id,
                bridges,
                [
                    BridgeEntry(topic, topic, kind, GZ_TYPES[kind], Direction.GZ_TO_ROS)
                    for topic, kind in offered.items()
                ],
                observe,
                lambda topic, message: played.heard.append(message.data),
                parameters={f"qos_overrides.{KEPT}.publisher.durability": "transient_local"},
            )
            try:
                played.pace = pace = LockStep(student, ros, holding)
                assert pace.await_ready(), student.log.take_lines()
                for tick in range(1, ticks + 1):
                    pace.welcome()
                    if before_tick is not None:
                        before_tick(tick, ros, pace)
                    now = Clock()
                    now.sim.sec, now.sim.nsec = divmod(tick * TICK_NS, 10**9)
                    clock.publish(now)
                    numbers.publish(gz_Int32(data=tick))
                    pace.wake_sleepers(tick * TICK_NS)
                    for topic, publisher, message in ros.take_held():
                        pace.send(topic, publisher, message, tick * TICK_NS)
                        pace.settle()
                    pace.close_tick(0.1)
                    played.lines += student.log.take_lines()
                played.too_early = pace.too_early()
            finally:
                student.close()
                ros.close()
                bridges.close()
                ours.close()
                sandbox.close()
        return played

    return call
