"""The packages of interfaces: all of them can be made and sent, and they are the types that ROS 2 Jazzy has.

Source of the hashes, of which the first halves are here: what rosidl_generator_c writes for the packages of Jazzy
(`*__description.c`).
"""

import importlib
from pathlib import Path

import pytest
from rclpy.serialization import deserialize_message, serialize_message

from gz_course.sim.ros.rosidl.definitions import description
from gz_course.sim.ros.rosidl.interface_text import KINDS
from gz_course.sim.ros.rosidl.packages import BUILT_IN
from gz_course.sim.ros.rosidl.type_description import type_hash

FILES = sorted(path for kind in KINDS for path in Path(BUILT_IN, "share").glob(f"*/{kind}/*.{kind}"))
HASHES = {
    "action_tutorials_interfaces/action/Fibonacci_FeedbackMessage": "50fc26b9cac313652ecbeab3adf9b541",
    "action_tutorials_interfaces/action/Fibonacci_GetResult": "8b47e383f1e31f6d8df6417ab54957e7",
    "action_tutorials_interfaces/action/Fibonacci_SendGoal": "a0603060ed69fe2dfbd1a6f3b982a174",
    "control_msgs/msg/AdmittanceControllerState": "8a23c54184ba101c9a733a0a882001ed",
    "control_msgs/msg/InterfaceValue": "74a12144ef6b7af67533195cb30f7f60",
    "control_msgs/msg/JointComponentTolerance": "739ea7566931944d33830fa10f1bf5e7",
    "control_msgs/msg/JointControllerState": "1f6ee64b3b1f1947951f34694f8e19a1",
    "control_msgs/msg/JointJog": "ba249455a20f70168a1acb7bf43b776b",
    "control_msgs/msg/JointTolerance": "c254f9cece0f3b733017b6990fd46d13",
    "control_msgs/msg/MecanumDriveControllerState": "c560d21a4484fd5f2c05896a11de3315",
    "control_msgs/msg/MultiDOFCommand": "033fb0fa1ffc63a872ca73c61a49ded8",
    "control_msgs/msg/PidState": "9ab329825048ab6152868c2d086fc19f",
    "control_msgs/msg/SingleDOFState": "fe8365f86265bddfefbd26698975a818",
    "control_msgs/msg/SteeringControllerStatus": "151ec2fabdfdf10cabe982ceab9fec88",
    "control_msgs/srv/QueryTrajectoryState": "4a0935dffef18bc5b9e101c9d03d84e6",
    "example_interfaces/action/Fibonacci": "9508051da1ea4658de144b09bd0690ff",
    "example_interfaces/action/Fibonacci_FeedbackMessage": "c1de71afd52e49a89c53d82623668841",
    "example_interfaces/action/Fibonacci_SendGoal": "d1a57fb2a4afe8c21e34fb10db206f16",
    "example_interfaces/srv/AddTwoInts": "e118de6bf5eeb66a2491b5bda11202e7",
    "gps_msgs/msg/GPSFix": "f4e11a63872a198f70300a3990f50b09",
    "nav2_msgs/msg/Costmap": "d51bf7aecafdbb3f8f98215de648abe6",
    "nav2_msgs/msg/CostmapMetaData": "1a41ec8428d50c3b4cd3f9055e1adb0e",
    "ros_gz_interfaces/msg/Contact": "ba5acbac280b8650f9ad7caf995888ff",
    "ros_gz_interfaces/msg/Entity": "266a26f377057ebb0a1f08f7fb9dc435",
    "ros_gz_interfaces/msg/GuiCamera": "517316a3df653203b2172b52a24aa541",
    "ros_gz_interfaces/msg/JointWrench": "aa50610f0bc1a9f1f42a04e6d76da729",
    "ros_gz_interfaces/msg/Light": "8efb44b207981d0c23827eae2490a4c4",
    "ros_gz_interfaces/msg/SensorNoise": "caf76df5c8960d6c28ebf8318dd750d9",
    "ros_gz_interfaces/msg/TrackVisual": "ae5d68f113b35256f39620458d80e631",
    "ros_gz_interfaces/msg/WorldControl": "5ab5d57c81967008a869636e532ec8b8",
    "ros_gz_interfaces/srv/SetEntityPose": "abe4bc11c7e7955ec1b4ea7f9456b492",
    "turtlesim/msg/Pose": "739beba26bcba6920404ba722b7b8321",
    "vision_msgs/msg/BoundingBox2D": "008eacbb0cf8f26e83795547bed013ee",
    "vision_msgs/msg/BoundingBox3D": "bbb73a65c163d7f9bb29009c7bde9f7f",
    "vision_msgs/msg/Detection2D": "0d12b69df5c593b3455b7346fac82054",
    "vision_msgs/msg/Detection3D": "ddd703be132ab0b69d33121f1bb03413",
    "vision_msgs/msg/ObjectHypothesis": "51da43cec11c01957a64d1e05a24acd1",
    "vision_msgs/msg/ObjectHypothesisWithPose": "41c12344c0396c48b81df12467c192d9",
    "vision_msgs/msg/VisionClass": "1e4a11f0fed50b5623cb8ff26ca0e379",
}
COUNTS = {
    "ackermann_msgs": 2,
    "action_tutorials_interfaces": 1,
    "actuator_msgs": 8,
    "control_msgs": 31,
    "example_interfaces": 33,
    "gps_msgs": 2,
    "marine_acoustic_msgs": 8,
    "nav2_msgs": 35,
    "object_recognition_msgs": 8,
    "rosbag2_interfaces": 15,
    "ros_gz_interfaces": 25,
    "turtlesim": 8,
    "vision_msgs": 16,
}


def messages_of(path):
    """Yield the message classes of an interface, of requests, responses, goals, results and feedback too."""
    module = importlib.import_module(f"{path.parts[-3]}.{path.parent.name}")
    made = getattr(module, path.stem)
    if path.suffix == ".msg":
        yield made
    elif path.suffix == ".srv":
        yield from (made.Request, made.Response)
    else:
        yield from (made.Goal, made.Result, made.Feedback)


def test_every_message_is_made_and_comes_back_from_the_wire():
    for path in FILES:
        for message_class in messages_of(path):
            message = message_class()
            assert deserialize_message(serialize_message(message), message_class) == message


def test_no_interface_is_lost():
    counted = {name: sum(path.parts[-3] == name for path in FILES) for name in COUNTS}
    assert counted == COUNTS


@pytest.mark.parametrize("name", HASHES)
def test_the_hash_is_that_of_the_compiled_package(name):
    assert type_hash(description(name)).startswith(f"RIHS01_{HASHES[name]}")


def test_defaults_and_constants():
    from control_msgs.action import FollowJointTrajectory
    from control_msgs.msg import MotionPrimitive
    from nav2_msgs.action import ComputePathToPose
    from ros_gz_interfaces.msg import Entity, EntityFactory

    assert (EntityFactory().relative_to, EntityFactory().allow_renaming) == ("world", False)
    assert (Entity.MODEL, Entity().JOINT) == (2, 7)
    assert MotionPrimitive().type == MotionPrimitive.UNKNOWN == -1
    assert FollowJointTrajectory.Result.GOAL_TOLERANCE_VIOLATED == -5
    assert ComputePathToPose.Result.NO_VALID_PATH == 208
