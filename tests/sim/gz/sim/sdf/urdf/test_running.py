"""A URDF robot in a running world: it drives, and topics and frames have the names of the bodies after lumping."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from gz_course.sim.gz.msgs.laserscan_pb2 import LaserScan
from gz_course.sim.gz.msgs.odometry_pb2 import Odometry
from gz_course.sim.gz.msgs.twist_pb2 import Twist
from gz_course.sim.gz.sim.world import World
from gz_course.sim.gz.transport import Node

INERTIA = "<mass value='{}'/><inertia ixx='{}' iyy='{}' izz='{}' ixy='0' ixz='0' iyz='0'/>"


def wheel(side: str, y: float) -> str:
    inertia = INERTIA.format(0.2, 1.5e-4, 1.5e-4, 2.5e-4)
    return (
        f"<link name='{side}_wheel'><inertial>{inertia}</inertial>"
        "<collision><geometry><cylinder radius='0.05' length='0.001'/></geometry></collision></link>"
        f"<joint name='{side}_joint' type='continuous'><parent link='base_link'/><child link='{side}_wheel'/>"
        f"<origin xyz='0 {y} 0' rpy='-1.5707963267948966 0 0'/><axis xyz='0 0 1'/></joint>"
    )


ROBOT = f"""<robot name="cart">
<link name="base_footprint"/>
<joint name="base_joint" type="fixed"><parent link="base_footprint"/><child link="base_link"/>
  <origin xyz="0 0 0.05"/></joint>
<link name="base_link"><inertial>{INERTIA.format(2, 0.02, 0.02, 0.03)}</inertial>
  <collision><origin xyz="0 0 0.05"/><geometry><box size="0.3 0.16 0.06"/></geometry></collision></link>
{wheel("left", 0.1)}{wheel("right", -0.1)}
<link name="caster"><collision><geometry><sphere radius="0.03"/></geometry></collision></link>
<joint name="caster_joint" type="fixed"><parent link="base_link"/><child link="caster"/>
  <origin xyz="-0.12 0 -0.02"/></joint>
<link name="front"><collision><geometry><sphere radius="0.03"/></geometry></collision></link>
<joint name="front_joint" type="fixed"><parent link="base_link"/><child link="front"/>
  <origin xyz="0.12 0 -0.02"/></joint>
<link name="lidar"/>
<joint name="lidar_joint" type="fixed"><parent link="base_link"/><child link="lidar"/>
  <origin xyz="0.1 0 0.15" rpy="0 0 3.141592653589793"/></joint>
<gazebo reference="caster"><mu1>0</mu1></gazebo><gazebo reference="front"><mu1>0</mu1></gazebo>
<gazebo reference="lidar"><sensor name="scan" type="gpu_lidar"><update_rate>10</update_rate><lidar>
  <scan><horizontal><samples>1</samples><min_angle>0</min_angle><max_angle>0</max_angle></horizontal></scan>
  <range><min>0.05</min><max>10</max></range></lidar></sensor></gazebo>
<gazebo><plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
  <left_joint>left_joint</left_joint><right_joint>right_joint</right_joint>
  <wheel_separation>0.2</wheel_separation><wheel_radius>0.05</wheel_radius></plugin></gazebo>
</robot>"""

ROOM = """<include><uri>model://ground_plane</uri></include>
<model name="wall"><static>true</static><pose>-3 0 1 0 0 0</pose><link name="l"><visual name="v"><geometry>
<box><size>0.2 4 2</size></box></geometry></visual></link></model>"""


@pytest.mark.parametrize("spawned", [False, True])
def test_a_urdf_robot_drives_and_scans(
    load_text: Callable[..., World], node: Node, tmp_path: Path, spawned: bool
) -> None:
    include = "" if spawned else f"<include><uri>{tmp_path}/cart.urdf</uri></include>"
    (tmp_path / "cart.urdf").write_text(ROBOT)
    world = load_text(ROOM + include, node=node)
    assert not spawned or world.editor.spawn(ROBOT, file_name="cart.urdf") == "cart"
    scans, odometry = [], []
    node.subscribe(LaserScan, "/world/w/model/cart/link/base_footprint/sensor/scan/scan", scans.append)
    node.subscribe(Odometry, "/model/cart/odometry", odometry.append)
    world.step(500)
    message = Twist()
    message.linear.x = 0.3
    node.advertise("/model/cart/cmd_vel", Twist).publish(message)
    world.step(1000)
    before = world.truth.pose("cart").position[0]
    world.step(1000)
    pose = world.truth.pose("cart")
    assert pose.position[0] - before == pytest.approx(0.3, rel=0.005)
    assert abs(pose.yaw()) < 0.002 and abs(pose.position[2]) < 0.002
    # The lidar, 0.1 m ahead of the middle, looks backwards at a wall whose near side is at x = -2.9.
    assert scans[-1].ranges[0] == pytest.approx(pose.position[0] + 0.1 + 2.9, abs=0.05)
    header = {entry.key: list(entry.value) for entry in odometry[-1].header.data}
    assert (header["frame_id"], header["child_frame_id"]) == (["cart/odom"], ["cart/base_footprint"])
    assert world.warnings == []
