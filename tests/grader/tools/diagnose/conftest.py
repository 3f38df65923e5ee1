"""Broken systems for real: nodes, bridges and simulators in a domain and partition nobody else uses."""

import contextlib
import os
import sys
import threading
import uuid
from pathlib import Path

import pytest

from gz_course.grader.tools.playground import Playground
from gz_course.tests import warm_process
from gz_course.tests.eventually import within
from gz_course.tests.sim.spinning import spinning

DEADLINE = 120.0
eventually = within(DEADLINE)
ROOT = Path(__file__).parents[4]
COURSE = [sys.executable, "-c", "from gz_course.grader.course import main; main()"]

WORLD = """
<sdf version='1.10'><world name='{name}'>
  <physics name='p' type='x'><max_step_size>0.004</max_step_size><real_time_factor>{factor}</real_time_factor></physics>
  {plugins}{inside}
</world></sdf>
"""
ROBOT = """
<include><uri>model://ground_plane</uri></include>
<include><uri>model://two_wheel_robot</uri><name>robot</name></include>
"""
PLUGIN = "<plugin filename='gz-sim-{file}-system' name='gz::sim::systems::{name}'/>"
SYSTEMS = {
    "physics": "Physics",
    "user-commands": "UserCommands",
    "scene-broadcaster": "SceneBroadcaster",
    "sensors": "Sensors",
    "imu": "Imu",
}


class Broken:
    """A system made by a test: everything in it ends with `close()`."""

    def __init__(self, domain):
        self.domain = domain
        self._stack = contextlib.ExitStack()

    def close(self):
        self._stack.close()

    def world(self, inside=ROBOT, *, name="room", without=(), factor=1.0, paused=False):
        """A running server; `without` are systems that are left out."""
        from gz_course.sim.gz.sim.server import Server
        from gz_course.sim.gz.sim.world import World
        from gz_course.sim.gz.transport import Node

        plugins = "".join(PLUGIN.format(file=f, name=n) for f, n in SYSTEMS.items() if n not in without)
        world = World.from_string(WORLD.format(name=name, factor=factor, plugins=plugins, inside=inside))
        node, stop = Node(), threading.Event()
        server = Server(world, node)
        server.paused = paused
        thread = threading.Thread(target=server.run, kwargs={"stop": stop})
        thread.start()

        def end():
            stop.set()
            thread.join(DEADLINE)
            world.close()
            node.close()

        self._stack.callback(end)
        return server

    def context(self):
        """A ROS context whose nodes are spun in a thread: (context, executor, its nodes)."""
        import rclpy
        from rclpy.executors import SingleThreadedExecutor

        context = rclpy.Context()
        rclpy.init(context=context, domain_id=self.domain)
        executor = SingleThreadedExecutor(context=context)
        nodes = []

        def end():
            for node in nodes:
                node.destroy_node()
            context.try_shutdown()

        self._stack.callback(end)
        self._stack.enter_context(spinning(executor))  # ends first, so that no callback finds its node gone
        return context, executor, nodes

    def node(self, name, *, spins=True, sim_time=False, context=None):
        """A node, by default with a DDS participant of its own, as in a process of its own."""
        import rclpy
        from rclpy.parameter import Parameter

        context, executor, nodes = context or self.context()
        overrides = [Parameter("use_sim_time", value=sim_time)]
        node = rclpy.create_node(name, context=context, parameter_overrides=overrides)
        if spins:
            executor.add_node(node)
        nodes.append(node)
        return node

    def bridge(self, *rows, name="ros_gz_bridge"):
        """A bridge of (ros topic, gz topic, ros type, gz type, direction), as parameter_bridge makes it."""
        from gz_course.sim.bridge.ros_gz_bridge import bridged_topics
        from gz_course.sim.bridge.ros_gz_bridge.bridge import Bridge
        from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction
        from gz_course.sim.gz.transport import Node

        node = self.node(name)
        entries = [BridgeEntry(*row[:4], direction=Direction[row[4]]) for row in rows]
        gz_node = self._stack.enter_context(Node())
        self._stack.enter_context(Bridge(node, gz_node, entries))
        bridged_topics.offer(node, entries)
        return node

    def gz_node(self):
        from gz_course.sim.gz.transport import Node

        return self._stack.enter_context(Node())

    def every(self, node, period, publish):
        """Call `publish()` on a wall timer of a node."""
        from rclpy.clock import Clock, ClockType

        node.create_timer(period, publish, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def diagnose(self, seconds=1.0):
        from gz_course.grader.tools.diagnose.live import diagnose

        return Told(diagnose(seconds))


class Told:
    """A diagnosis, asked by kind."""

    def __init__(self, diagnosis):
        self.diagnosis = diagnosis
        self.findings = diagnosis.findings

    def of(self, kind):
        return [finding for finding in self.findings if finding.kind == kind]

    def sentence(self, kind):
        """The first sentence of this kind."""
        assert self.of(kind), f"no {kind} in {[(f.kind, f.sentence) for f in self.findings]}"
        return self.of(kind)[0].sentence

    def fix(self, kind):
        assert self.of(kind)
        return self.of(kind)[0].fix


@pytest.fixture(scope="module")
def domain(tmp_path_factory):
    """A DDS domain and a Gazebo partition of this module, also for its children."""
    from gz_course.grader.run.domain import Domain
    from gz_course.grader.run.sandbox import ros_environment

    with Domain() as held, pytest.MonkeyPatch.context() as patch:
        environment = ros_environment(held.id, tmp_path_factory.mktemp("ros_log"))
        for name, value in {**environment, "GZ_IP": "127.0.0.1", "GZ_PARTITION": f"test-{uuid.uuid4().hex}"}.items():
            patch.setenv(name, value)
        yield held.id


@pytest.fixture(scope="module")
def diagnosed(domain):
    """The diagnosis of the system that a function sets up; the system is gone afterwards."""

    def run(set_up):
        with contextlib.closing(Broken(domain)) as system:
            set_up(system)
            return system.diagnose()

    return run


@pytest.fixture
def broken(domain):
    """A system that lasts as long as one test."""
    system = Broken(domain)
    yield system
    system.close()


@pytest.fixture
def room():
    with Playground() as opened:
        yield opened


@pytest.fixture
def course():
    """Run `course` in the present environment: the finished process."""

    def run(*arguments):
        return warm_process.run(
            [*COURSE, *arguments],
            capture_output=True,
            text=True,
            timeout=600,
            cwd=ROOT,
            env={**os.environ},
            check=False,
        )

    return run
