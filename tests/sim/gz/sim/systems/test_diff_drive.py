"""DiffDrive: the robot follows its commands, the odometry agrees, invalid commands do not reach the physics."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from gz_course.sim.gz.msgs.boolean_pb2 import Boolean
from gz_course.sim.gz.msgs.odometry_pb2 import Odometry
from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.physics.servos import MAX_WHEEL_SPEED
from gz_course.sim.gz.sim.sdf.resources import BUILT_IN_MODELS, BUILT_IN_WORLDS
from gz_course.sim.gz.sim.systems.diff_drive import DiffDrive
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node

BALL = """<model name='ball'><pose>5 5 0.1 0 0 0</pose><link name='l'><collision name='c'>
  <geometry><sphere><radius>0.1</radius></sphere></geometry>
  <surface><bounce><restitution_coefficient>1</restitution_coefficient></bounce></surface></collision></link></model>"""
ROBOT = (BUILT_IN_MODELS / "two_wheel_robot" / "model.sdf").read_text()


def twist(linear: float, angular: float) -> Any:
    message = Twist()
    message.linear.x = linear
    message.angular.z = angular
    return message


def robot_world(change: Callable[[str], str] = lambda text: text) -> World:
    """Return a world with only the built-in robot, whose file is changed by `change`."""
    model = change(ROBOT[ROBOT.index("<model") : ROBOT.index("</sdf>")])
    return World.from_string(
        "<sdf version='1.10'><world name='w'><plugin filename='gz-sim-physics-system' "
        "name='gz::sim::systems::Physics'/>"
        "<plugin filename='gz-sim-sensors-system' name='gz::sim::systems::Sensors'/>"
        f"<include><uri>model://ground_plane</uri></include>{model}</world></sdf>",
        file_name="robot.sdf",
    )


def drive_of(world: World) -> DiffDrive:
    return next(system for system in world.systems if isinstance(system, DiffDrive))


@pytest.mark.parametrize(("linear", "angular"), [(0.5, 0.1), (1.0, 1.0), (-0.3, -0.5), (0.0, 1.0)])
def test_steady_speed_is_what_was_commanded(linear: float, angular: float) -> None:
    world = robot_world()
    world.step(500)
    drive_of(world).command(linear, angular)
    world.step(3000)
    before = world.truth.pose("two_wheel_robot")
    world.step(1000)
    after = world.truth.pose("two_wheel_robot")
    turned = math.remainder(after.yaw() - before.yaw(), 2 * math.pi)
    assert turned == pytest.approx(angular, rel=0.005)
    velocity = world.truth.velocity("two_wheel_robot")
    heading = after.yaw()
    ahead = velocity.linear[0] * math.cos(heading) + velocity.linear[1] * math.sin(heading)
    assert ahead == pytest.approx(linear, rel=0.005, abs=2e-3)
    # The true velocity agrees with the true pose: the chord of the circle over one second.
    chord = np.linalg.norm(after.position - before.position)
    expected = abs(linear) if angular == 0 else abs(2 * linear / angular * math.sin(angular / 2))
    assert chord == pytest.approx(expected, rel=0.005, abs=2e-3)


def test_a_world_in_which_something_bounces_drives_alike() -> None:
    world = robot_world(lambda robot: robot + BALL)
    drive_of(world).command(0.5, 0.1)
    world.step(4000)
    velocity = world.truth.velocity("two_wheel_robot")
    assert np.hypot(*velocity.linear[:2]) == pytest.approx(0.5, rel=0.005)
    assert velocity.angular[2] == pytest.approx(0.1, rel=0.02)


def test_the_robot_rests_still_and_level() -> None:
    world = robot_world()
    world.step(5000)
    pose = world.truth.pose("two_wheel_robot")
    assert np.linalg.norm(pose.position) < 1e-3
    assert abs(pose.yaw()) < 1e-6 and max(map(abs, pose.rpy())) < 2e-3


def test_a_command_acts_one_step_later() -> None:
    world = robot_world()
    world.step(100)
    drive_of(world).command(0.5, 0.0)
    world.step(1)
    assert not world.data.ctrl.any()
    world.step(1)
    assert world.data.ctrl == pytest.approx([10.0, 10.0])


def test_the_last_command_holds_for_ever(node: Node) -> None:
    world = robot_world()
    world.attach(node)
    node.advertise("/model/two_wheel_robot/cmd_vel", Twist).publish(twist(0.2, 0.0))
    world.step(10_000)
    assert world.truth.pose("two_wheel_robot").position[0] == pytest.approx(2.0, rel=0.02)


def test_odometry_on_the_wire(node: Node) -> None:
    world = World.load("lidar_room.sdf", node=node)
    odometry: list[Any] = []
    frames: list[Any] = []
    node.subscribe(Odometry, "/model/robot/odometry", odometry.append)
    node.subscribe(Pose_V, "/model/robot/tf", frames.append)
    node.advertise("/model/robot/cmd_vel", Twist).publish(twist(0.5, 0.1))
    start = world.truth.pose("robot")
    world.step(3000)
    stamps = [message.header.stamp.sec * 1000 + message.header.stamp.nsec // 1_000_000 for message in odometry]
    assert stamps == list(range(20, 3001, 20))
    last = odometry[-1]
    data = {entry.key: list(entry.value) for entry in last.header.data}
    assert data == {"frame_id": ["robot/odom"], "child_frame_id": ["robot/base_link"]}
    assert last.twist.linear.x == pytest.approx(0.5, rel=0.005)
    assert last.twist.angular.z == pytest.approx(0.1, rel=0.01)
    moved = start.inverse() * world.truth.pose("robot")
    # Odometry starts at zero at any start pose, and is ahead by the slip at the start (30 to 35 mm).
    assert math.hypot(last.pose.position.x - moved.position[0], last.pose.position.y - moved.position[1]) < 0.05
    assert last.pose.position.x > moved.position[0]
    assert frames[-1].pose[0].position == last.pose.position
    assert {entry.key: list(entry.value) for entry in frames[-1].pose[0].header.data} == data
    assert len(frames) == len(odometry)


@pytest.mark.parametrize("bad", [(math.nan, 0.0), (0.0, math.nan), (math.inf, 0.0), (0.0, -math.inf)])
def test_commands_that_are_not_finite_are_dropped_counted_and_reported_once(
    node: Node, bad: tuple[float, float]
) -> None:
    world = World.load("lidar_room.sdf", node=node)
    publisher = node.advertise("/model/robot/cmd_vel", Twist)
    publisher.publish(twist(0.3, 0.0))
    for _ in range(3):
        publisher.publish(twist(*bad))
    world.step(2000)
    assert world.dropped_commands == {"/model/robot/cmd_vel": 3}
    assert len([text for text in world.warnings if "/model/robot/cmd_vel" in text]) == 1
    assert np.isfinite(world.data.qpos).all()
    assert world.truth.pose("robot").position[0] == pytest.approx(-1.4, abs=0.05)


@pytest.mark.parametrize("absurd", [(1e308, 1e308), (-1e12, 0.0), (0.0, 1e300), (100.0, -50.0)])
def test_absurd_commands_do_not_break_the_physics(absurd: tuple[float, float]) -> None:
    world = robot_world()
    drive_of(world).command(*absurd)
    world.step(2000)
    assert abs(world.data.ctrl).max() <= MAX_WHEEL_SPEED
    assert np.isfinite(world.data.qpos).all() and not any(world.data.warning.number)
    assert any("wheels faster than" in warning for warning in world.warnings)


def test_enable_topic_switches_the_drive(node: Node) -> None:
    world = World.load("lidar_room.sdf", node=node)
    command = node.advertise("/model/robot/cmd_vel", Twist)
    enable = node.advertise("/model/robot/enable", Boolean)
    command.publish(twist(0.5, 0.0))
    world.step(1000)
    enable.publish(Boolean(data=False))
    command.publish(twist(0.5, 0.0))
    world.step(1000)
    assert abs(world.truth.velocity("robot").linear[0]) < 1e-3
    enable.publish(Boolean(data=True))
    world.step(500)
    assert abs(world.truth.velocity("robot").linear[0]) < 1e-3
    command.publish(twist(0.5, 0.0))
    world.step(1000)
    assert world.truth.velocity("robot").linear[0] == pytest.approx(0.5, rel=0.01)


def test_acceleration_limits_and_own_topics() -> None:
    def change(text: str) -> str:
        return text.replace(
            "<odom_publish_frequency>50</odom_publish_frequency>",
            "<max_linear_acceleration>0.5</max_linear_acceleration><topic>my cmd</topic>"
            "<odom_topic>/o</odom_topic>"
            "<tf_topic>t</tf_topic><frame_id>odom</frame_id><child_frame_id>base</child_frame_id>",
        )

    world = robot_world(change)
    drive = drive_of(world)
    assert (drive.command_topic, drive.reports.odometry_topic, drive.reports.tf_topic) == ("/my_cmd", "/o", "/t")
    assert (drive.reports.frame_id, drive.reports.child_frame_id) == ("odom", "base")
    drive.command(0.5, 0.0)
    world.step(500)
    assert world.truth.velocity("two_wheel_robot").linear[0] == pytest.approx(0.25, abs=0.01)
    world.step(1000)
    assert world.truth.velocity("two_wheel_robot").linear[0] == pytest.approx(0.5, rel=0.005)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("<left_joint>left_wheel_joint<", "<left_joint>left_weel_joint<", "did you mean 'left_wheel_joint'"),
        ("<left_joint>left_wheel_joint</left_joint>", "", "at least one <left_joint>"),
        ("<left_joint>left_wheel_joint<", "<left_joint>rear_caster_joint<", "is a ball joint"),
        ("<wheel_radius>0.05<", "<wheel_radius>0<", "<wheel_radius> must be greater than zero"),
        (
            "<wheel_separation>0.25<",
            "<wheel_separation>wide<",
            "<wheel_separation> needs a number, got 'wide'",
        ),
    ],
)
def test_wrong_parameters_are_refused_at_their_line(old: str, new: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=sentence) as caught:
        robot_world(lambda text: text.replace(old, new))
    assert str(caught.value).startswith("robot.sdf:")


def test_a_joint_on_both_sides_is_named() -> None:
    world = robot_world(
        lambda text: text.replace(
            "<right_joint>right_wheel_joint</right_joint>", "<right_joint>left_wheel_joint</right_joint>"
        )
    )
    (warning,) = [text for text in world.warnings if "DiffDrive" in text]
    assert "has joint 'left_wheel_joint' on the left and on the right; name another joint" in warning


def test_a_misspelt_parameter_is_a_warning_and_the_default_holds() -> None:
    world = robot_world(lambda text: text.replace("odom_publish_frequency", "odom_publisher_frequency"))
    warnings = [text for text in world.warnings if "odom_publisher_frequency" in text]
    assert len(warnings) == 1 and "did you mean 'odom_publish_frequency'" in warnings[0]


@pytest.mark.parametrize(
    "spelling",
    [
        "filename='libgz-sim-diff-drive-system.so' name='gz::sim::systems::DiffDrive'",
        "filename='ignition-gazebo-diff-drive-system' name='ignition::gazebo::systems::DiffDrive'",
        "filename='libignition-gazebo6-diff-drive-system.so' name='whatever'",
        "filename='gz-sim-diff-drive-system'",
    ],
)
def test_all_spellings_of_the_system_are_found(spelling: str) -> None:
    usual = 'filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"'
    assert drive_of(robot_world(lambda text: text.replace(usual, spelling)))


@pytest.mark.parametrize(
    ("spelling", "hint"),
    [
        ("filename='x' name='gz::sim::systems::DifDrive'", "did you mean 'DiffDrive'"),
        ("filename='libgazebo_ros_diff_drive.so' name='d'", "use gz-sim-diff-drive-system"),
        (
            "filename='gz-sim-breadcrumbs-system' name='gz::sim::systems::Breadcrumbs'",
            "exists in Gazebo but not in this",
        ),
    ],
)
def test_other_systems_are_one_warning_with_a_hint(spelling: str, hint: str) -> None:
    usual = 'filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"'
    world = robot_world(lambda text: text.replace(usual, spelling))
    assert [hint in warning for warning in world.warnings].count(True) == 1


def test_a_static_robot_cannot_be_driven_and_says_so() -> None:
    world = robot_world(lambda text: text.replace("<link name=", "<static>1</static><link name=", 1))
    assert all(system.name == "Sensors" for system in world.systems)
    assert any("is static, so its system DiffDrive" in warning for warning in world.warnings)


def test_the_room_leaves_way_for_the_first_drive() -> None:
    """0.5 m/s with 0.1 rad/s for 5 s, then 1.5 m more, touching nothing but the ground."""
    world = World.load(BUILT_IN_WORLDS / "lidar_room.sdf")
    drive_of(world).command(0.5, 0.1)
    ground = {world.model.geom(name).id for name in ("ground_plane::link::collision",)}
    for _ in range(80):
        world.step(100)
        touched = {int(geom) for pair in world.data.contact.geom for geom in pair}
        static = {geom for geom in touched if world.model.geom_bodyid[geom] == 0}
        assert static <= ground
    assert world.truth.pose("robot").position[0] > 1.5
