"""OdometryPublisher: the true pose as odometry."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from gz_course.sim.gz.msgs.odometry_pb2 import Odometry
from gz_course.sim.gz.msgs.odometry_with_covariance_pb2 import OdometryWithCovariance
from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V
from gz_course.sim.gz.sim.errors import SdfError
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node, NodeOptions, Scope
from gz_course.tests.sim.gz.sim.systems.motion_world import arm, joint, link, plugin, world


def box(inside: str = "", velocity: str = "", pose: str = "3 -1 2 0 0 0.5") -> str:
    drive = plugin("VelocityControl", velocity) if velocity else ""
    return f"""<model name='box'><pose>{pose}</pose>{link("l", "0 0 0 0 0 0")}{drive}
      {plugin("OdometryPublisher", inside)}</model>"""


TURN = "<initial_linear>0.5 0.2 0</initial_linear><initial_angular>0 0 0.8</initial_angular>"


def listen(node: Node, made: World, kind: Any = Odometry, topic: str = "/model/box/odometry") -> list[Any]:
    made.attach(node)
    heard: list[Any] = []
    node.subscribe(kind, topic, heard.append)
    return heard


def keys(header: Any) -> dict[str, str]:
    return {entry.key: entry.value[0] for entry in header.data}


def test_pose_is_that_of_the_world_and_twist_that_of_the_model(node: Node) -> None:
    made = world(box(velocity=TURN), gravity="0 0 0")
    heard = listen(node, made)
    made.step(1000)
    assert [each.header.stamp.sec * 1000 + each.header.stamp.nsec // 10**6 for each in heard] == list(
        range(20, 1001, 20)
    )
    last, truth = heard[-1], made.truth.pose("box")
    assert (last.pose.position.x, last.pose.position.y) == pytest.approx(tuple(truth.position[:2]))
    assert last.pose.position.z == 0.0
    turn = last.pose.orientation
    assert (turn.w, turn.x, turn.y, turn.z) == pytest.approx(tuple(truth.quaternion))
    assert keys(last.header) == {"frame_id": "box/odom", "child_frame_id": "box/base_footprint"}
    assert (last.twist.linear.x, last.twist.linear.y) == pytest.approx((0.5, 0.2), rel=1e-2)
    assert last.twist.angular.z == pytest.approx(0.8, rel=1e-6)
    # From the first message on, although the model does not start at the origin.
    assert heard[0].twist.linear.x == pytest.approx(0.5, rel=1e-2)


def test_speed_is_the_mean_of_ten_steps(node: Node) -> None:
    made = world(box("<odom_publish_frequency>0</odom_publish_frequency><dimensions>3</dimensions>"))
    heard = listen(node, made)
    made.step(100)
    assert len(heard) == 99  # the first step only initializes it
    # Falling: z = -g t^2 / 2, so the mean of the last ten steps is the speed five steps ago.
    assert heard[-1].twist.linear.z == pytest.approx(-9.8 * 0.001 * (100 - 5), rel=1e-6)
    assert heard[0].twist.linear.z == pytest.approx(-9.8 * 0.001 * 1.5, rel=1e-6)


def test_who_comes_late_hears_the_same(node: Node) -> None:
    text = box("<gaussian_noise>0.1</gaussian_noise>", TURN)
    early, late = world(text), world(text)
    first = listen(node, early)
    early.step(200)
    with Node(node.options) as other:
        late.attach(other)
        late.step(155)
        second: list[Any] = []
        other.subscribe(Odometry, "/model/box/odometry", second.append)
        late.step(45)
    assert [each.SerializeToString(deterministic=True) for each in second] == [
        each.SerializeToString(deterministic=True) for each in first[-3:]
    ]


def test_two_dimensions_leave_out_what_is_not_in_the_plane(node: Node) -> None:
    made = world(box(pose="0 0 5 0.3 -0.4 1"))
    heard = listen(node, made)
    made.data.qvel[:] = (1.0, 0.0, 0.5, 0.3, 0.2, 0.6)
    made.step(100)
    twist = heard[-1].twist
    assert (twist.linear.z, twist.angular.x, twist.angular.y) == (0.0, 0.0, 0.0)
    assert abs(twist.linear.x) > 0.1 and abs(twist.angular.z) > 0.1


def test_a_held_model_is_right_also_for_who_comes_back() -> None:
    """Without a subscriber the pose is not stored; an old pose must not be used as that of the previous step."""
    hinge = joint("turn", "revolute", "world", "l", "<xyz>0 0 1</xyz>")
    reports = plugin("OdometryPublisher", "<xyz_offset>1 0 0</xyz_offset>")
    table = f"<model name='box'>{link('l', '0 0 1 0 0 0')}{hinge}{reports}</model>"
    made = world(table, gravity="0 0 0")
    made.data.qvel[:] = 0.5
    options = NodeOptions("turntable", scope=Scope.PROCESS)
    with Node(options) as always:
        made.attach(always)
        for _ in range(2):
            with Node(options) as listener:
                heard: list[Any] = []
                listener.subscribe(Odometry, "/model/box/odometry", heard.append)
                made.step(100)
                assert [each.twist.linear.y for each in heard] == pytest.approx([0.5] * 5, rel=1e-3)
            made.step(514)
            with Node(options) as listener:
                listener.subscribe(Odometry, "/model/box/odometry", heard.append)
                made.step(6)
                assert heard[-1].twist.linear.y == pytest.approx(0.5, rel=1e-3)
                assert heard[-1].twist.angular.z == pytest.approx(0.5, rel=1e-3)


def test_three_dimensions_follow_a_tumbling_body(node: Node) -> None:
    made = world(box("<dimensions>3</dimensions>", pose="0 0 5 0.3 -0.4 1"), gravity="0 0 0")
    heard = listen(node, made)
    made.data.qvel[:] = (1.0, 0.0, 0.5, 0.0, 0.0, 0.6)
    made.step(1000)
    last, pose = heard[-1], made.truth.pose("box")
    assert last.pose.position.z == pytest.approx(5.5, rel=1e-3)
    world_speed = np.array((last.twist.linear.x, last.twist.linear.y, last.twist.linear.z))
    turned = pose.transform(world_speed) - pose.position
    assert turned == pytest.approx((1.0, 0.0, 0.5), abs=5e-3)
    assert last.twist.angular.z == pytest.approx(0.6, rel=1e-2)


def test_offsets_frames_and_topics(node: Node) -> None:
    inside = """<xyz_offset>0.5 0 0</xyz_offset><rpy_offset>0 0 1</rpy_offset><odom_frame>odom</odom_frame>
      <robot_base_frame>base</robot_base_frame><odom_topic>o</odom_topic><tf_topic>frames</tf_topic>"""
    made = world(box(inside), gravity="0 0 0")
    heard = listen(node, made, topic="/o")
    frames: list[Any] = []
    node.subscribe(Pose_V, "/frames", frames.append)
    made.step(40)
    position = heard[-1].pose.position
    expected = (3 + 0.5 * math.cos(0.5), -1 + 0.5 * math.sin(0.5))
    assert (position.x, position.y) == pytest.approx(expected)
    assert heard[-1].pose.orientation.z == pytest.approx(math.sin(0.75))
    assert keys(heard[-1].header) == {"frame_id": "odom", "child_frame_id": "base"}
    assert frames[-1].pose[0].position == position
    assert frames[-1].pose[0].header == heard[-1].header


def test_noise_is_in_the_twist_with_its_covariance(node: Node) -> None:
    made = world(box("<gaussian_noise>0.2</gaussian_noise><odom_publish_frequency>0</odom_publish_frequency>"))
    heard = listen(node, made, OdometryWithCovariance, "/model/box/odometry_with_covariance")
    made.step(2001)
    values = np.array(
        [(each.twist_with_covariance.twist.linear.x, each.twist_with_covariance.twist.angular.y) for each in heard]
    )
    assert values.std(axis=0) == pytest.approx((0.2, 0.2), rel=0.1)
    assert values.mean(axis=0) == pytest.approx((0.0, 0.0), abs=0.03)
    assert heard[0].pose_with_covariance.pose.position.x == pytest.approx(3.0)
    for both in (heard[0].pose_with_covariance, heard[0].twist_with_covariance):
        matrix = np.array(both.covariance.data).reshape(6, 6)
        assert matrix == pytest.approx(np.eye(6) * 0.04)


def test_a_model_held_by_a_joint_and_a_static_one(node: Node) -> None:
    static = box().replace("name='box'>", "name='box'><static>true</static>")
    made = world(arm(plugin("OdometryPublisher")) + static)
    heard = listen(node, made)
    of_arm: list[Any] = []
    node.subscribe(Odometry, "/model/arm/odometry", of_arm.append)
    made.step(100)
    assert heard[-1].pose.position.x == pytest.approx(3.0) and heard[-1].twist.linear.x == 0.0
    assert of_arm[-1].pose.position.x == pytest.approx(0.0)


@pytest.mark.parametrize(
    ("inside", "sentence"),
    [
        ("<dimensions>4</dimensions>", "must be 2 or 3, got 4"),
        ("<gaussian_noise>-1</gaussian_noise>", "not negative"),
        ("<xyz_offset>1 2</xyz_offset>", "needs 3 numbers"),
    ],
)
def test_wrong_parameters_are_refused(inside: str, sentence: str) -> None:
    with pytest.raises(SdfError, match=sentence):
        world(box(inside))
