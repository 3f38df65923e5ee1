"""From joint states and from the simulator to `Buffer.lookup_transform`, over real DDS."""

import math
import uuid

import pytest
from rclpy.time import Time

from gz_course.tests.sim.ros.tf2_py.transforms import stamped

ROBOT = "<include><uri>model://two_wheel_robot</uri><name>robot</name></include>"
WORLD = (
    "<sdf version='1.10'><world name='w'><plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'/>"
    f"<include><uri>model://ground_plane</uri></include>{ROBOT}</world></sdf>"
)
PAIR = ("tf2_msgs/msg/TFMessage", "gz.msgs.Pose_V")
URDF = (
    "<robot name='r'><link name='base'/><link name='mast'/><link name='lidar'/>"
    "<joint name='turn' type='continuous'><parent link='base'/><child link='mast'/><axis xyz='0 0 1'/></joint>"
    "<joint name='stiff' type='fixed'><parent link='mast'/><child link='lidar'/><origin xyz='2 0 1'/></joint></robot>"
)


@pytest.fixture
def buffer(ros_node):
    from gz_course.sim.ros.tf2_ros import Buffer, TransformListener

    made = Buffer(node=ros_node)
    listener = TransformListener(made, ros_node)
    yield made
    listener.unregister()


@pytest.fixture
def gz_nodes():
    """Return two nodes of Gazebo that nobody outside reaches: for the world and for the bridge."""
    from gz_course.sim.gz.transport import Node, NodeOptions, Scope

    options = NodeOptions(partition=uuid.uuid4().hex, scope=Scope.PROCESS)
    with Node(options) as for_world, Node(options) as for_bridge:
        yield for_world, for_bridge


def test_the_odometry_of_a_simulated_robot(buffer, gz_nodes, ros_node, spin_until):
    from gz_course.sim.bridge.ros_gz_bridge.bridge import Bridge
    from gz_course.sim.bridge.ros_gz_bridge.entry import BridgeEntry, Direction
    from gz_course.sim.gz.sim.systems.diff_drive import DiffDrive
    from gz_course.sim.gz.sim.world import World
    from gz_course.sim.ros.tf2_ros import StaticTransformBroadcaster

    world = World.from_string(WORLD, node=gz_nodes[0])
    drive = next(system for system in world.systems if isinstance(system, DiffDrive))
    entry = BridgeEntry("/tf", drive.reports.tf_topic, *PAIR, Direction.GZ_TO_ROS)
    bridge = Bridge(ros_node, gz_nodes[1], [entry])
    try:
        frame = drive.reports.child_frame_id
        StaticTransformBroadcaster(ros_node).sendTransform(stamped(frame, "lidar", place=(0, 0, 0.25)))
        drive.command(0.5, 0.6)
        spin_until(
            lambda: world.step(100) and buffer.can_transform(drive.reports.frame_id, "lidar", Time(seconds=1.01)),
            "the transform at 1.01 s",
        )
    finally:
        bridge.close()
        world.close()
    # Between the poses of 1.00 and 1.02 s.
    at = [
        buffer.lookup_transform(drive.reports.frame_id, "lidar", Time(seconds=s)).transform for s in (1.0, 1.01, 1.02)
    ]
    assert at[1].translation.x == pytest.approx((at[0].translation.x + at[2].translation.x) / 2.0)
    assert at[1].translation.z == 0.25
    angles = [2.0 * math.atan2(each.rotation.z, each.rotation.w) for each in at]
    assert angles[1] == pytest.approx((angles[0] + angles[2]) / 2.0)
    assert angles[1] > 0.3 and at[1].translation.x > 0.2


def test_robot_state_publisher_sends_fixed_and_moving_joints(buffer, ros_node, spin_until):
    from rclpy.qos import DurabilityPolicy
    from sensor_msgs.msg import JointState

    from gz_course.sim.ros.robot_state_publisher.publisher import DEFAULTS, StatePublisher

    values = DEFAULTS | {"robot_description": URDF, "frame_prefix": "one/"}
    for name, value in values.items():
        ros_node.declare_parameter(name, value)
    publisher = StatePublisher(ros_node, values)
    joints = ros_node.create_publisher(JointState, "joint_states", 10)

    def send(seconds, angle):
        state = JointState(name=["turn"], position=[angle])
        state.header.stamp.sec = seconds
        joints.publish(state)
        return False

    seconds = iter(range(1, 10_000))
    spin_until(
        lambda: send(next(seconds), math.pi / 2.0) or buffer.can_transform("one/base", "one/lidar", Time()), "the chain"
    )
    place = buffer.lookup_transform("one/base", "one/lidar", Time()).transform.translation
    assert (place.x, place.y, place.z) == pytest.approx((0.0, 2.0, 1.0), abs=1e-9)
    assert buffer.lookup_transform("one/mast", "one/lidar", Time(seconds=77)).transform.translation.x == 2.0
    endpoints = {each.topic_name: each.qos_profile for each in ros_node.publishers if each.topic_name.startswith("/tf")}
    assert endpoints["/tf_static"].durability == DurabilityPolicy.TRANSIENT_LOCAL
    assert (endpoints["/tf"].depth, endpoints["/tf"].durability) == (100, DurabilityPolicy.VOLATILE)
    del publisher
