"""The program `ros2 run ros_gz_image image_bridge /camera /depth`, which bridges Gazebo's images to ROS.

Each topic keeps its name, unless it is remapped in ROS. The conversion is that of ros_gz_bridge; images are not
compressed. With `lazy` a camera is subscribed to, and so rendered, only while there is a subscriber in ROS.

Source: README.md of ros_gz_image, https://github.com/gazebosim/ros_gz/tree/jazzy/ros_gz_image
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from gz_course.sim.bridge.ros_gz_bridge.remarks import converted
from gz_course.sim.ros.ros_program.errors import UsageError, first_line
from gz_course.sim.ros.ros_program.parameters import read_parameters
from gz_course.sim.ros.ros_program.program import run
from gz_course.sim.ros.ros_program.spinner import wait_for_signal

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
_DEFAULTS: dict[str, Any] = {"qos": "default", "lazy": False, "subscription_heartbeat": 1000}


def main(argv: list[str] | None = None) -> int:
    """Bridge until SIGINT or SIGTERM; return 0, 2 for unusable arguments, or 1 if a callback failed."""
    return run("image_bridge", "ros_gz_image", _bridge, HELP, argv, lasting=True, images=True)


def _bridge(node: Node, topics: list[str]) -> int:
    from gz_course.sim.gz.transport import Node as GzNode

    values = read_parameters(node, _DEFAULTS)
    heartbeat = values["subscription_heartbeat"]
    if not 0 < heartbeat < 10**9:
        raise UsageError(f"the parameter subscription_heartbeat must be above 0, not {heartbeat}")
    profile = qos_profile(values["qos"])
    if not topics:
        raise UsageError("there is no topic to bridge; give one or more, such as /camera (see --help)")
    wrong = next((topic for topic in topics if topic.startswith("-") or "@" in topic), "")
    if wrong:
        raise UsageError(f"'{wrong}' is not the name of a topic; image_bridge takes names only, without types")
    with GzNode() as gz_node:
        bridges = []
        for topic in dict.fromkeys(topics):
            try:
                bridges.append(ImageTopic(node, gz_node, topic, profile))
            except Exception as error:
                raise UsageError(f"cannot bridge '{topic}': {first_line(error)}") from None
        if values["lazy"]:
            _follow_listeners(node, bridges, heartbeat / 1000)
        else:
            for bridge in bridges:
                bridge.connect()
        node.get_logger().info(f"ready: {len(bridges)} image topic{'s' if len(bridges) != 1 else ''}")
        return wait_for_signal(node)


class ImageTopic:
    """One topic on both sides; `connect` and `disconnect` may be repeated.

    Raises ValueError or an error of rclpy for a name that Gazebo or ROS does not accept.
    """

    def __init__(self, node: Node, gz_node: GzNode, topic: str, profile: QoSProfile) -> None:
        from gz_course.sim.bridge.ros_gz_bridge.type_pairs import find_pair
        from gz_course.sim.gz.transport import naming

        self._pair = find_pair("sensor_msgs/msg/Image", "gz.msgs.Image")
        naming.fully_qualified("", "", topic)
        self._gz_node = gz_node
        self._topic = topic
        self._logger = node.get_logger()
        self._said = ""
        self._connected = False
        self._publisher = node.create_publisher(self._pair.ros_class, topic, profile)

    @property
    def wanted(self) -> bool:
        """Whether there is a subscriber in ROS."""
        return bool(self._publisher.get_subscription_count())

    def connect(self) -> None:
        """Subscribe in Gazebo; messages arrive in a thread of `gz.transport`."""
        if not self._connected:
            self._connected = True
            self._gz_node.subscribe(self._pair.gz_class, self._topic, self._on_image)

    def disconnect(self) -> None:
        """Unsubscribe in Gazebo, which stops rendering if there is no other subscriber."""
        if self._connected:
            self._connected = False
            self._gz_node.unsubscribe(self._topic)

    def _on_image(self, image: Any) -> None:
        try:
            picture, remarks = converted(self._pair.to_ros, image)
        except ValueError as error:
            self._warn(f"images on {self._topic} are not bridged: {error}")
            return
        self._warn(f"images on {self._topic} are bridged, but {remarks[0]}" if remarks else "")
        self._publisher.publish(picture)

    def _warn(self, sentence: str) -> None:
        """Log a sentence that differs from that of the last image."""
        if sentence and sentence != self._said:
            self._logger.warning(sentence)
        self._said = sentence


def qos_profile(name: str) -> QoSProfile:
    """Return the QoS for a value of the parameter `qos`. Raises UsageError for an unknown value."""
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
    """Connect the topics that have a subscriber in ROS, every `period` [s] of wall time."""
    from rclpy.clock import Clock, ClockType

    def look() -> None:
        for bridge in bridges:
            if bridge.wanted:
                bridge.connect()
            else:
                bridge.disconnect()

    node.create_timer(period, look, clock=Clock(clock_type=ClockType.STEADY_TIME))


if __name__ == "__main__":
    sys.exit(main())
