"""The executable `image_bridge`: Gazebo's images as ROS images. `ros2 run ros_gz_image image_bridge /camera /depth`.

Each topic keeps its name; remaps give another one in ROS. The conversion is that of ros_gz_bridge. Pictures are raw:
there are no compressed ones beside them. With `lazy` a camera is listened to, and so rendered, only while somebody
listens in ROS.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from gz_course.sim.ros_gz_bridge.ros_program import UsageError, first_line, run, wait_for_signal

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.qos import QoSProfile

    from gz_course.sim.gz.transport import Node as GzNode

HELP = """\
usage: image_bridge TOPIC ... [--ros-args ...]

Bridges images from Gazebo to ROS 2, under the same names.

ROS parameters (after --ros-args, each as -p name:=value):
  qos                     default (reliable), system_default or sensor_data (best effort, 5 pictures)
  lazy                    true: listen to Gazebo only while somebody listens in ROS (default false)
  subscription_heartbeat  how often lazy bridges look for listeners, in ms (default 1000)
To give a topic another name in ROS: -r /camera:=/robot/image_raw
"""
_PARAMETERS: dict[str, Any] = {"qos": "default", "lazy": False, "subscription_heartbeat": 1000}
_WORDS = {str: "a text", bool: "true or false", int: "a whole number"}
_OF_NODES = {"use_sim_time", "start_type_description_service"}


def main(argv: list[str] | None = None) -> int:
    """Bridge until SIGINT or SIGTERM: exit code 0; 2 for arguments that make no sense, 1 if it broke."""
    return run("image_bridge", "ros_gz_image", _bridge, HELP, argv, lasting=True, pictures=True)


def _bridge(node: Node, topics: list[str]) -> int:
    from gz_course.sim.gz.transport import Node as GzNode

    values = _read_parameters(node)
    profile = qos_profile(values["qos"])
    if not topics:
        raise UsageError("there is no topic to bridge; give one or more, such as /camera (see --help)")
    wrong = next((topic for topic in topics if topic.startswith("-") or "@" in topic), "")
    if wrong:
        raise UsageError(f"'{wrong}' is not the name of a topic; image_bridge takes names only, types are known")
    with GzNode() as gz_node:
        bridges = []
        for topic in dict.fromkeys(topics):
            try:
                bridges.append(ImageTopic(node, gz_node, topic, profile))
            except Exception as error:
                raise UsageError(f"cannot bridge '{topic}': {first_line(error)}") from None
        if values["lazy"]:
            _follow_listeners(node, bridges, values["subscription_heartbeat"] / 1000)
        else:
            for bridge in bridges:
                bridge.connect()
        node.get_logger().info(f"ready: {len(bridges)} image topic{'s' if len(bridges) != 1 else ''}")
        return wait_for_signal(node)


class ImageTopic:
    """One topic on both sides. `connect` and `disconnect` start and end listening to Gazebo; both may be repeated.

    Raises `ValueError` or an error of rclpy for a name that Gazebo or ROS does not take.
    """

    def __init__(self, node: Node, gz_node: GzNode, topic: str, profile: QoSProfile) -> None:
        from gz_course.sim.gz.transport import naming
        from gz_course.sim.ros_gz_bridge.type_pairs import find_pair

        self._pair = find_pair("sensor_msgs/msg/Image", "gz.msgs.Image")
        naming.fully_qualified("", "", topic)
        self._gz_node = gz_node
        self._topic = topic
        self._logger = node.get_logger()
        self._dropping = False
        self._connected = False
        self._publisher = node.create_publisher(self._pair.ros_class, topic, profile)

    @property
    def wanted(self) -> bool:
        """Whether somebody listens in ROS."""
        return bool(self._publisher.get_subscription_count())

    def connect(self) -> None:
        """Listen to Gazebo: messages arrive in a thread of gz.transport."""
        if not self._connected:
            self._connected = True
            self._gz_node.subscribe(self._pair.gz_class, self._topic, self._on_image)

    def disconnect(self) -> None:
        """Listen no more: without another listener the camera is not rendered."""
        if self._connected:
            self._connected = False
            self._gz_node.unsubscribe(self._topic)

    def _on_image(self, image: Any) -> None:
        try:
            converted = self._pair.to_ros(image)
        except ValueError as error:
            if not self._dropping:
                self._logger.warning(f"images on {self._topic} are not bridged: {error}")
            self._dropping = True
            return
        self._dropping = False
        self._publisher.publish(converted)


def qos_profile(name: str) -> QoSProfile:
    """Return the QoS of ROS's publishers by the word of the parameter `qos`; raise `UsageError` for another word."""
    from rclpy.qos import QoSProfile, qos_profile_sensor_data, qos_profile_system_default

    profiles = {
        "default": QoSProfile(depth=10),
        "system_default": qos_profile_system_default,
        "sensor_data": qos_profile_sensor_data,
    }
    if name not in profiles:
        raise UsageError(f"the parameter qos must be {', '.join(profiles)}; got '{name}'")
    return profiles[name]


def _follow_listeners(node: Node, bridges: list[ImageTopic], period: float) -> None:
    """Look every `period` s of wall time who listens in ROS."""
    from rclpy.clock import Clock, ClockType

    def look() -> None:
        for bridge in bridges:
            if bridge.wanted:
                bridge.connect()
            else:
                bridge.disconnect()

    node.create_timer(period, look, clock=Clock(clock_type=ClockType.STEADY_TIME))


def _read_parameters(node: Node) -> dict[str, Any]:
    values = dict(_PARAMETERS)
    for name in node.get_parameters_by_prefix(""):
        if name not in values:
            if name not in _OF_NODES and not name.startswith("qos_overrides."):
                node.get_logger().warning(
                    f"the parameter {name} is not known here and changes nothing; there are {', '.join(_PARAMETERS)}"
                )
            continue
        value = node.get_parameter(name).value
        if type(value) is not type(_PARAMETERS[name]):
            raise UsageError(f"the parameter {name} must be {_WORDS[type(_PARAMETERS[name])]}, not {value!r}")
        values[name] = value
    if not 0 < values["subscription_heartbeat"] < 10**9:
        raise UsageError(
            f"the parameter subscription_heartbeat must be above 0, not {values['subscription_heartbeat']}"
        )
    return values


if __name__ == "__main__":
    sys.exit(main())
