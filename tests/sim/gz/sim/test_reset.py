"""Rewinding: after a reset every topic of every system carries the same bytes again, whatever happened before."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator

import numpy as np
import pytest
from gz.msgs.twist_pb2 import Twist

from gz.sim.pose import Pose
from gz.sim.sdf.resources import BUILT_IN_MODELS
from gz.sim.server import Server
from gz.sim.systems.registry import systems
from gz.sim.world import World
from gz.transport import Node

Load = Callable[..., World]

# Systems that need joints of their own, parameters, or another kind of model: name -> what stands in the plugin.
INSIDE = {
    "DiffDrive": "<left_joint>left_wheel_joint</left_joint><right_joint>right_wheel_joint</right_joint>"
    "<wheel_separation>0.3</wheel_separation><wheel_radius>0.05</wheel_radius>",
}
IN_WORLD = ("Physics", "UserCommands", "SceneBroadcaster", "Sensors", "Imu", "Contact", "Altimeter", "AirPressure")
IN_WORLD += ("Magnetometer", "NavSat", "ForceTorque", "LogicalCamera", "AirSpeed")
IN_MODEL = ("DiffDrive", "JointStatePublisher", "OdometryPublisher", "PosePublisher")


def plugin(name: str) -> str:
    found = systems().get(name)
    if found is None:
        return ""
    return f"<plugin filename='{found.filename}' name='gz::sim::systems::{name}'>{INSIDE.get(name, '')}</plugin>"


@pytest.fixture
def world(node: Node) -> Iterator[World]:
    """The built-in robot with every system that suits it, and every light sensor."""
    robot = (
        (BUILT_IN_MODELS / "two_wheel_robot" / "model.sdf").read_text().split("<model", 1)[1].rsplit("</model>", 1)[0]
    )
    robot = "<model" + robot
    kinds = ("imu", "altimeter", "air_pressure", "magnetometer", "navsat")
    sensors = "".join(f"<sensor name='{kind}_' type='{kind}'><update_rate>50</update_rate></sensor>" for kind in kinds)
    robot = robot.replace("</link>", f"{sensors}</link>", 1)
    robot += "".join(plugin(name) for name in IN_MODEL if f"systems::{name}'" not in robot.replace('"', "'"))
    coordinates = "<spherical_coordinates><latitude_deg>47</latitude_deg></spherical_coordinates>"
    ground = "<include><uri>model://ground_plane</uri></include><include><uri>model://sun</uri></include>"
    text = "".join(plugin(name) for name in IN_WORLD) + coordinates + ground + robot + "</model>"
    made = World.from_string(f"<sdf version='1.10'><world name='w'>{text}</world></sdf>", seed=5, node=node)
    yield made
    made.close()


class Tape:
    """A digest of the bytes of every topic of the world, in their order."""

    def __init__(self, world: World, node: Node) -> None:
        self._digests: dict[str, object] = {}
        self._counts: dict[str, int] = {}
        self._known: set[str] = set()
        self._node = node
        self.listen()

    def listen(self) -> None:
        for topic in self._node.topic_list():
            if topic not in self._known and not topic.endswith(("/cmd_vel", "clock", "stats")):
                self._known.add(topic)
                self._node.subscribe_raw(topic, lambda data, info: self._take(data, info.topic))

    def _take(self, data: bytes, topic: str) -> None:
        self._digests.setdefault(topic, hashlib.sha256()).update(data)  # type: ignore[attr-defined]
        self._counts[topic] = self._counts.get(topic, 0) + 1

    def take(self) -> dict[str, tuple[int, str]]:
        found = {
            topic: (self._counts[topic], digest.hexdigest())  # type: ignore[attr-defined]
            for topic, digest in self._digests.items()
        }
        self._digests.clear()
        self._counts.clear()
        return found


def drive(world: World, node: Node) -> None:
    """Half a second of driving about."""
    publisher = node.advertise(f"/model/{world.model_names()[0]}/cmd_vel", Twist)
    for tick in range(50):
        command = Twist()
        command.linear.x, command.angular.z = 0.4, (tick % 5) * 0.3
        publisher.publish(command)
        world.step(10)
    publisher.close()


def test_every_topic_carries_the_same_bytes_again(world: World, node: Node) -> None:
    tape = Tape(world, node)
    drive(world, node)
    assert world.velocity(world.model_names()[0]).linear[0] > 0.1, "it drives"
    first, state = tape.take(), world.data.qpos.tobytes() + world.data.qvel.tobytes()
    assert len(first) >= 4, f"too little is heard to prove anything: {sorted(first)}"
    world.step(123)
    world.reset()
    assert world.sim_time_ns == 0 and world.iterations == 0
    tape.take()
    drive(world, node)
    again = tape.take()
    assert {topic: again.get(topic) for topic in first} == first
    assert world.data.qpos.tobytes() + world.data.qvel.tobytes() == state


def test_the_same_after_things_came_went_and_moved(world: World, node: Node) -> None:
    tape = Tape(world, node)
    name = world.model_names()[0]
    drive(world, node)
    first, names = tape.take(), world.model_names(static=True)
    numbers = {(each.kind, each.path): each.number for each in world.entities}
    text = (BUILT_IN_MODELS / "two_wheel_robot" / "model.sdf").read_text()
    world.spawn(text, name="other", pose=Pose((3.0, 0.0, 0.0)))
    world.set_pose(name, Pose((1.0, 1.0, 0.0)))
    world.set_pose("ground_plane", Pose((0.0, 0.0, -0.5)))
    world.set_physics(step_size=0.002)
    world.step(50)
    world.remove(name)
    world.step(50)
    world.reset()
    assert world.model_names(static=True) == names
    assert {(each.kind, each.path): each.number for each in world.entities} == numbers
    tape.listen()
    tape.take()
    drive(world, node)
    again = tape.take()
    assert {topic: again.get(topic) for topic in first} == first


def test_time_only_leaves_everything_where_it_is(load_text: Load) -> None:
    world = load_text("<model name='m'><pose>0 0 100 0 0 0</pose><link name='l'/></model>")
    world.step(500)
    before = world.data.qpos.copy(), world.data.qvel.copy()
    world.reset(time_only=True)
    assert world.sim_time_ns == 0 and world.data.time == 0.0
    assert (world.data.qpos == before[0]).all() and (world.data.qvel == before[1]).all()
    world.step(500)
    assert world.data.qpos[2] < before[0][2] - 1.0, "it goes on falling"


def test_a_reset_mends_a_broken_world(load_text: Load) -> None:
    from gz.sim.errors import SimError

    arm = "<model name='m'><link name='a'/><link name='b'/><joint name='j' type='revolute'><parent>a</parent>"
    world = load_text(arm + "<child>b</child><axis><xyz>1 0 0</xyz></axis></joint></model>")
    world.data.qvel[6] = np.nan
    with pytest.raises(SimError, match="velocity of body 'm::b' on joint 'm::j'"):
        world.step()
    world.reset()
    world.step(100)
    assert np.isfinite(world.data.qpos).all()


def test_the_statistics_of_a_server_begin_anew(node: Node) -> None:
    from gz.msgs.boolean_pb2 import Boolean
    from gz.msgs.world_control_pb2 import WorldControl
    from gz.msgs.world_stats_pb2 import WorldStatistics

    world = World.load("lidar_room.sdf")
    server = Server(world, node)
    heard: list[int] = []
    node.subscribe(WorldStatistics, "/stats", lambda m: heard.append(m.iterations))
    server.step(250)
    request = WorldControl()
    request.reset.all = True
    assert node.request("/world/lidar_room/control", request, WorldControl, Boolean)[1].data
    for _ in range(3):
        server.step(100)
    assert heard == [250, 100, 200, 300]
    world.close()
