"""All driving and reporting systems in one world: same bytes again, after a reset and with other models present."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import pytest

from gz_course.sim.gz.msgs.double_pb2 import Double
from gz_course.sim.gz.msgs.model_pb2 import Model
from gz_course.sim.gz.msgs.odometry_pb2 import Odometry
from gz_course.sim.gz.msgs.odometry_with_covariance_pb2 import OdometryWithCovariance
from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.sim.systems.diff_drive import DiffDrive
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope
from gz_course.tests.sim.gz.sim.physics.wheeled_robots import ROBOTS
from gz_course.tests.sim.gz.sim.systems.motion_world import arm, link, plugin, world

GAINS = "<position_p_gain>300</position_p_gain><position_d_gain>10</position_d_gain>"
EVERYTHING = (
    "<include><uri>model://ground_plane</uri></include>"
    + arm(
        plugin("JointPositionController", "<joint_name>shoulder</joint_name><p_gain>500</p_gain><d_gain>30</d_gain>")
        + plugin("JointController", "<joint_name>elbow</joint_name><initial_velocity>0.3</initial_velocity>")
        + plugin("ApplyJointForce", "<joint_name>shoulder</joint_name>")
        + plugin("JointStatePublisher")
    )
    + arm(plugin("JointTrajectoryController", f"<joint_name>shoulder</joint_name>{GAINS}"), name="follower")
    + f"""<model name='box'><pose>0 0 5 0 0 0.5</pose>{link("l", "0 0 0 0 0 0")}
      {plugin("VelocityControl", "<initial_linear>0.1 0 0</initial_linear>")}
      {plugin("OdometryPublisher", "<gaussian_noise>0.1</gaussian_noise><dimensions>3</dimensions>")}</model>"""
    + ROBOTS[1]
    .sdf(plugin("JointStatePublisher") + plugin("OdometryPublisher", "<odom_topic>/truth</odom_topic>"))
    .replace("name='robot'>", "name='robot'><pose>0 5 0 0 0 0</pose>", 1)
)
TOPICS: dict[str, Any] = {
    "/world/w/model/arm/joint_state": Model,
    "/world/w/model/robot/joint_state": Model,
    "/model/box/odometry": Odometry,
    "/model/box/odometry_with_covariance": OdometryWithCovariance,
    "/model/box/pose": Pose_V,
    "/model/robot/odometry": Odometry,
    "/model/robot/tf": Pose_V,
    "/truth": Odometry,
}
SPAWNED = "<sdf version='1.10'><model name='{}'><pose>20 {} 5 0 0 0</pose><link name='l'/></model></sdf>"


def apart(partition: str) -> NodeOptions:
    """Return options of nodes that are isolated from the other worlds of this process."""
    return NodeOptions(partition, scope=Scope.PROCESS)


class Session:
    """A world on a node, and all its messages in order."""

    def __init__(self, node: Node, made: World) -> None:
        self.world = made
        self.heard: list[tuple[str, bytes]] = []
        made.attach(node)
        for topic, kind in TOPICS.items():
            node.subscribe(kind, topic, self._listener(topic))
        self._force = node.advertise("/model/arm/joint/shoulder/cmd_force", Double)
        self._shoulder = node.advertise("/model/arm/joint/shoulder/0/cmd_pos", Double)
        self._drive = node.advertise("/model/robot/cmd_vel", Twist)

    def _listener(self, topic: str) -> Callable[[Any], None]:
        return lambda message: self.heard.append((topic, message.SerializeToString(deterministic=True)))

    def run(self) -> list[tuple[str, bytes]]:
        self.heard.clear()
        for tick in range(10):
            self._shoulder.publish(Double(data=-0.1 * tick))
            self._force.publish(Double(data=0.3 * tick))
            command = Twist()
            command.linear.x, command.angular.z = 0.1 * tick, 0.05 * tick
            self._drive.publish(command)
            self.world.step(20)
        return list(self.heard)


def test_the_same_bytes_in_another_world_and_after_a_reset() -> None:
    with Node(apart("one")) as one, Node(apart("two")) as two:
        first = Session(one, world(EVERYTHING, seed=5))
        said = first.run()
        assert {topic for topic, _ in said} == set(TOPICS)
        assert Session(two, world(EVERYTHING, seed=5)).run() == said
        first.world.reset()
        assert first.run() == said


def test_another_seed_changes_the_noise_and_nothing_else(node: Node) -> None:
    with Node(apart("other")) as other:
        said, others = Session(node, world(EVERYTHING, seed=5)).run(), Session(other, world(EVERYTHING, seed=6)).run()
    changed = {topic for (topic, one), (_, two) in zip(said, others, strict=True) if one != two}
    assert changed == {"/model/box/odometry", "/model/box/odometry_with_covariance"}


def test_what_comes_and_goes_in_between_changes_nothing() -> None:
    with Node(apart("one")) as one, Node(apart("two")) as two:
        calm, disturbed = Session(one, world(EVERYTHING)), Session(two, world(EVERYTHING))
        said = calm.run()
        step, visitors = disturbed.world.step, itertools.count(1)

        def step_and_change(steps: int) -> None:
            step(steps)
            number = next(visitors)
            disturbed.world.editor.spawn(SPAWNED.format(f"visitor{number}", number * 2))
            if number > 2:
                disturbed.world.editor.remove(f"visitor{number - 2}")

        disturbed.world.step = step_and_change  # type: ignore[method-assign]
        also_said = disturbed.run()
    assert [topic for topic, _ in also_said] == [topic for topic, _ in said]
    # The solver computes all contacts together, so another model changes the last digits.
    for (topic, calm_bytes), (_, bytes_) in zip(said, also_said, strict=True):
        assert numbers(TOPICS[topic].FromString(bytes_)) == pytest.approx(
            numbers(TOPICS[topic].FromString(calm_bytes)), rel=1e-4, abs=1e-5
        )


def numbers(message: Any) -> list[float]:
    """Return all numbers of a message in order, except forces, which are differences of large numbers."""
    found: list[float] = []
    for field, value in message.ListFields():
        many = value if field.is_repeated else [value]
        if field.message_type is not None:
            found.extend(number for each in many for number in numbers(each))
        elif field.cpp_type == field.CPPTYPE_DOUBLE and field.name != "force":
            found.extend(many)
    return found


def test_commands_to_a_world_at_rest_count_when_it_runs(node: Node) -> None:
    session = Session(node, world(EVERYTHING))
    command = Twist()
    command.linear.x = 0.4
    session._drive.publish(command)
    assert session.heard == []
    session.world.step(1500)
    assert session.world.truth.velocity("robot").linear[0] == pytest.approx(0.4, rel=0.01)


def test_two_robots_drive_each_for_itself(node: Node) -> None:
    pair = "<include><uri>model://ground_plane</uri></include>" + ROBOTS[1].sdf()
    other = ROBOTS[2].sdf().replace("name='robot'>", "name='other'><pose>0 3 0 0 0 1</pose>", 1)
    made = world(pair + other)
    made.attach(node)
    for name, speed in (("robot", 0.3), ("other", -0.2)):
        command = Twist()
        command.linear.x = speed
        node.advertise(f"/model/{name}/cmd_vel", Twist).publish(command)
    made.step(1000)
    assert made.truth.velocity("robot").linear[0] == pytest.approx(0.3, rel=5e-3)
    ahead = made.truth.velocity("other").linear[:2] @ (0.5403023, 0.8414710)
    assert ahead == pytest.approx(-0.2, rel=5e-3)


def test_a_robot_inside_another_model_has_the_topics_of_its_own_name(node: Node) -> None:
    inner = ROBOTS[1].sdf().replace("name='robot'>", "name='inner'>", 1)
    ground = "<include><uri>model://ground_plane</uri></include>"
    made = world(f"{ground}<model name='outer' canonical_link='inner::base'>{inner}</model>")
    drive = next(system for system in made.systems if isinstance(system, DiffDrive))
    assert drive.command_topic == "/model/inner/cmd_vel"
    assert (drive.reports.frame_id, drive.reports.child_frame_id) == ("inner/odom", "inner/base")
    made.attach(node)
    command = Twist()
    command.linear.x, command.angular.z = 0.3, 0.2
    node.advertise("/model/inner/cmd_vel", Twist).publish(command)
    made.step(1000)
    assert made.truth.velocity("outer").angular[2] == pytest.approx(0.2, rel=0.01)
