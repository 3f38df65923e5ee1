"""After a reset every topic of every system carries the same bytes again, whatever was changed before."""

from __future__ import annotations

import contextlib
import hashlib
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest

from gz_course.sim.gz.msgs.double_pb2 import Double
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.sim.errors import SimError
from gz_course.sim.gz.sim.plugins.sensor import sensor_types
from gz_course.sim.gz.sim.plugins.system import systems
from gz_course.sim.gz.sim.pose import Pose
from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_MODELS
from gz_course.sim.gz.sim.server import Server
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node

Load = Callable[..., World]

CONTROLLED = {
    "ApplyJointForce": "a",
    "JointController": "b",
    "JointPositionController": "c",
    "JointTrajectoryController": "d",
    "ForceTorque": "e",
}
LINK = "<link name='{0}'><pose>{1} 0 0 0</pose><collision name='c'><geometry><sphere><radius>0.1</radius></sphere>"
LINK += "</geometry></collision>{2}</link>"
JOINT = "<joint name='{0}' type='revolute'><parent>{1}</parent><child>{2}</child><axis><xyz>{3}</xyz></axis>{4}</joint>"
TRUCK = """<left_joint>rl</left_joint><right_joint>rr</right_joint><left_steering_joint>sl</left_steering_joint>
<right_steering_joint>sr</right_steering_joint><wheel_base>0.6</wheel_base><wheel_separation>0.4</wheel_separation>
<kingpin_width>0.3</kingpin_width><wheel_radius>0.1</wheel_radius><steering_limit>0.5</steering_limit>"""
IN_WORLD = {
    "Buoyancy": "<uniform_fluid_density>1.2</uniform_fluid_density>",
    "TriggeredPublisher": "<input type='gz.msgs.Boolean' topic='/flyer/touched'/>"
    "<output type='gz.msgs.Empty' topic='/triggered'/>",
}
SEEN = "<camera><image><width>16</width><height>12</height></image></camera>"
SENSED = {
    "gpu_lidar": "<lidar><scan><horizontal><samples>20</samples><min_angle>-1</min_angle><max_angle>1</max_angle>"
    "</horizontal></scan><range><min>0.1</min><max>9</max></range><noise><stddev>0.1</stddev></noise></lidar>",
    "contact": "<contact><collision>c</collision></contact>",
    "logical_camera": "<logical_camera><near>0.1</near><far>9</far><aspect_ratio>1</aspect_ratio>"
    "<horizontal_fov>1</horizontal_fov></logical_camera>",
}


def plugin(name: str, inside: str = "") -> str:
    return f"<plugin filename='{systems()[name].filename}' name='gz::sim::systems::{name}'>{inside}</plugin>"


def arm() -> str:
    """Return a chain of links on the world, each joint with another controller."""
    parts, plugins, parent = LINK.format("base", "3 0 1", ""), "", "base"
    wrench = "<sensor name='ft' type='force_torque'><update_rate>50</update_rate></sensor>"
    for number, (system, joint) in enumerate(CONTROLLED.items()):
        parts += LINK.format(joint * 2, f"3 0 {1.3 + number * 0.3}", "")
        axis = "1 0 0" if number % 2 else "0 1 0"
        parts += JOINT.format(joint, parent, joint * 2, axis, wrench if system == "ForceTorque" else "")
        parent = joint * 2
        if system != "ForceTorque":
            plugins += plugin(system, f"<joint_name>{joint}</joint_name>")
    fixed = "<joint name='fix' type='fixed'><parent>world</parent><child>base</child></joint>"
    return f"<model name='arm'>{parts}{fixed}{plugins}{plugin('JointStatePublisher')}</model>"


def truck() -> str:
    """Return a body with two driven wheels behind and two steered ones in front."""
    parts = LINK.format("body", "0 0 0.3", "")
    for side, y in (("l", 0.2), ("r", -0.2)):
        parts += LINK.format(f"back_{side}", f"-0.3 {y} 0.1", "") + LINK.format(f"front_{side}", f"0.3 {y} 0.1", "")
        parts += f"<link name='knuckle_{side}'><pose>0.3 {y} 0.1 0 0 0</pose></link>"
        parts += JOINT.format(f"r{side}", "body", f"back_{side}", "0 1 0", "")
        parts += JOINT.format(f"s{side}", "body", f"knuckle_{side}", "0 0 1", "")
        parts += JOINT.format(f"f{side}", f"knuckle_{side}", f"front_{side}", "0 1 0", "")
    return f"<model name='truck'><pose>0 4 0 0 0 0</pose>{parts}{plugin('AckermannSteering', TRUCK)}</model>"


def flyer() -> str:
    """Return a body with all sensors, moved by its velocity, that falls on the ground and is reported completely."""
    sensors, seen = "", set()
    for kind, found in sorted(sensor_types().items()):
        if found not in seen and kind != "force_torque":
            seen.add(found)
            inside = SENSED.get(kind, SEEN if "camera" in kind or kind in ("depth", "rgbd", "segmentation") else "")
            rate = "<update_rate>20</update_rate>"
            sensors += f"<sensor name='s_{kind}' type='{kind}'>{rate}{inside}</sensor>"
    touch = "<target>ground_plane</target><namespace>flyer</namespace><time>0.05</time><enabled>true</enabled>"
    plugins = plugin("TouchPlugin", touch) + plugin("PosePublisher") + plugin("OdometryPublisher")
    plugins += plugin("VelocityControl", "<initial_linear>0.2 0 -0.3</initial_linear>")
    plugins += plugin("Label", "<label>3</label>")
    plugins += plugin(
        "KineticEnergyMonitor", "<link_name>body</link_name><kinetic_energy_threshold>0.001</kinetic_energy_threshold>"
    )
    return f"<model name='flyer'><pose>-1 -1 0.099 0 0 0</pose>{LINK.format('body', '0 0 0', sensors)}{plugins}</model>"


def runs_alone(name: str) -> bool:
    """Return whether a system can be loaded with the content of `IN_WORLD`.

    Those that write files, or send at the rate of pictures of wall time, have their own tests.
    """
    text = f"<sdf version='1.10'><world name='w'>{plugin(name, IN_WORLD.get(name, ''))}</world></sdf>"
    with contextlib.suppress(SimError):
        return name not in ("LogRecord", "ViewBroadcaster") and bool(World.from_string(text).systems)
    return False


@pytest.fixture
def world(node: Node) -> Iterator[World]:
    """Return a world in which every system and every sensor is active."""
    coordinates = "<spherical_coordinates><latitude_deg>47</latitude_deg></spherical_coordinates>"
    rest = "".join(f"<include><uri>model://{uri}</uri></include>" for uri in ("two_wheel_robot", "ground_plane", "sun"))
    models = rest + arm() + truck() + flyer()
    in_world = [name for name in systems() if f"systems::{name}'" not in models and runs_alone(name)]
    text = "".join(plugin(name, IN_WORLD.get(name, "")) for name in in_world) + coordinates + models
    made = World.from_string(f"<sdf version='1.10'><world name='w'>{text}</world></sdf>", seed=5, node=node)
    assert len(made.systems) >= 25
    yield made
    made.close()


class Tape:
    """A digest of the bytes of every topic of the world, in order."""

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
    """Run half a second with commands to everything that accepts them."""
    publishers: list[tuple[Any, Any]] = []
    for topic in node.topic_list():
        kinds = {each.msg_type_name for each in node.topic_info(topic)[1]}
        for kind in (Twist, Double):
            if kind.DESCRIPTOR.full_name in kinds:
                publishers.append((node.advertise(topic, kind), kind()))
    assert len(publishers) >= 4
    for tick in range(50):
        for publisher, command in publishers:
            if isinstance(command, Twist):
                command.linear.x, command.angular.z = 0.4, (tick % 5) * 0.3
            else:
                command.data = (tick % 7) * 0.1
            publisher.publish(command)
        world.step(10)
    for publisher, _ in publishers:
        publisher.close()


def test_every_topic_carries_the_same_bytes_again(world: World, node: Node) -> None:
    tape = Tape(world, node)
    drive(world, node)
    assert world.truth.velocity("two_wheel_robot").linear[0] > 0.1, "it drives"
    first, state = tape.take(), world.data.qpos.tobytes() + world.data.qvel.tobytes()
    assert len(first) >= 30, f"too little is heard to prove anything: {sorted(first)}"
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
    name = "two_wheel_robot"
    drive(world, node)
    first, names = tape.take(), world.truth.model_names(static=True)
    numbers = {(each.kind, each.path): each.number for each in world.entities}
    text = (BUILT_IN_MODELS / "two_wheel_robot" / "model.sdf").read_text()
    world.editor.spawn(text, name="other", pose=Pose((3.0, 0.0, 0.0)))
    world.editor.set_pose(name, Pose((1.0, 1.0, 0.0)))
    world.editor.set_pose("ground_plane", Pose((0.0, 0.0, -0.5)))
    world.editor.set_physics(step_size=0.002)
    world.step(50)
    world.editor.remove(name)
    world.step(50)
    world.reset()
    assert world.truth.model_names(static=True) == names
    assert {(each.kind, each.path): each.number for each in world.entities} == numbers
    tape.listen()
    tape.take()
    drive(world, node)
    again = tape.take()
    assert {topic: again.get(topic) for topic in first} == first


def test_what_comes_later_begins_its_schedules_then(world: World, node: Node) -> None:
    """New systems and sensors do not catch up on the time before their creation."""
    world.step(2000)
    world.editor.spawn(f"<sdf version='1.10'>{flyer()}</sdf>", name="later", pose=Pose((-2.0, -2.0, 0.099)))
    tape = Tape(world, node)
    world.step(500)
    counts = {topic: count for topic, (count, _) in tape.take().items()}
    late = {topic: count for topic, count in counts.items() if "/later/" in topic}
    assert len(late) >= 15
    assert all(abs(count - counts[topic.replace("/later/", "/flyer/")]) <= 1 for topic, count in late.items()), late


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
    arm = "<model name='m'><link name='a'/><link name='b'/><joint name='j' type='revolute'><parent>a</parent>"
    world = load_text(arm + "<child>b</child><axis><xyz>1 0 0</xyz></axis></joint></model>")
    world.data.qvel[6] = np.nan
    with pytest.raises(SimError, match="velocity of body 'm::b' on joint 'm::j'"):
        world.step()
    world.reset()
    world.step(100)
    assert np.isfinite(world.data.qpos).all()


def test_the_statistics_of_a_server_begin_anew(node: Node) -> None:
    from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
    from gz_course.sim.gz.msgs.world_control_pb2 import WorldControl
    from gz_course.sim.gz.msgs.world_stats_pb2 import WorldStatistics

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
