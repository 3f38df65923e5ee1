"""The topics of robot_state_publisher: `/robot_description`, `/tf_static`, and `/tf` from `/joint_states`.

`robot_state_publisher.main` creates one `StatePublisher`.

Source: README.md of https://github.com/ros/robot_state_publisher
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from geometry_msgs.msg import TransformStamped
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from gz_course.sim.gz.sim.errors import SimError
from gz_course.sim.ros.robot_state_publisher.kinematics import Kinematics, Transform
from gz_course.sim.ros.ros_program.errors import UsageError, first_line
from gz_course.sim.ros.tf2_ros.static_transform_broadcaster import StaticTransformBroadcaster
from gz_course.sim.ros.tf2_ros.transform_broadcaster import TransformBroadcaster

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.parameter import Parameter

Send = Callable[[list[TransformStamped]], None]
DEFAULTS: dict[str, Any] = {
    "robot_description": "",
    "publish_frequency": 20.0,
    "frame_prefix": "",
    "ignore_timestamp": False,
}
_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_FASTEST_HZ = 1000.0


class StatePublisher:
    """The publishers and subscriptions of one node, which last as long as the node.

    `values` holds all parameters; only robot_description may change later. `send` and `send_static` get the transforms
    for `/tf` and `/tf_static`; by default they are published there. Raises UsageError for a wrong parameter or
    description.
    """

    def __init__(
        self, node: Node, values: dict[str, Any], send: Send | None = None, send_static: Send | None = None
    ) -> None:
        self._node = node
        self._logger = node.get_logger()
        self._prefix = str(values["frame_prefix"])
        self._ignore_timestamp = bool(values["ignore_timestamp"])
        frequency = float(values["publish_frequency"])
        if not 0.0 <= frequency <= _FASTEST_HZ:
            raise UsageError(f"the parameter publish_frequency must be 0 to {_FASTEST_HZ:g} Hz, not {frequency:g}")
        self._period_ns = round(1e9 / frequency) if frequency else 0
        self._published_ns: dict[str, int] = {}
        self._latest_ns = 0
        self._has_warned = False
        self._send = send or TransformBroadcaster(node).sendTransform
        self._send_static = send_static or StaticTransformBroadcaster(node).sendTransform
        self._description = node.create_publisher(String, "robot_description", _LATCHED)
        try:
            self._kinematics = Kinematics.from_urdf(values["robot_description"])
        except SimError as error:
            raise UsageError(first_line(error)) from None
        self._publish_description(values["robot_description"])
        node.create_subscription(JointState, "joint_states", self.take, qos_profile_sensor_data)
        node.add_on_set_parameters_callback(self._check)
        node.add_post_set_parameters_callback(self._change)

    def take(self, state: JointState) -> None:
        """Send the transforms of a joint state, of each joint at most `publish_frequency` [Hz] by its stamps."""
        if len(state.name) != len(state.position):
            self._warn(f"a joint state with {len(state.name)} names and {len(state.position)} positions is ignored")
            return
        positions = dict(zip(state.name, state.position, strict=True))
        unreal = next((name for name, position in positions.items() if not math.isfinite(position)), None)
        if unreal is not None:
            self._warn(f"a joint state in which '{unreal}' is {positions[unreal]} is ignored")
            return
        if state.name and not any(name in self._kinematics.moving for name in state.name):
            self._warn(f"no joint of the joint state is one of robot '{self._kinematics.name}': {state.name[0]}")
        stamp = state.header.stamp
        now = self._node.get_clock().now().nanoseconds
        if now < self._latest_ns:
            self._logger.warning("Moved backwards in time, re-publishing joint transforms!")
            self._published_ns.clear()
        self._latest_ns = now
        stamp_ns = stamp.sec * 10**9 + stamp.nanosec
        due = [name for name in positions if self._is_due(name, stamp_ns, now)]
        if not due:
            return
        for name in due:
            self._published_ns[name] = stamp_ns
        transforms = self._kinematics.transforms({name: positions[name] for name in due})
        if transforms:
            self._send(self._stamped(transforms, stamp))

    def _is_due(self, name: str, stamp_ns: int, now: int) -> bool:
        if self._ignore_timestamp:
            return True
        last = self._published_ns.get(name)
        if last is None:
            return True
        # Stamps more than a second older come from a publisher that was restarted.
        return stamp_ns >= last + self._period_ns or stamp_ns < last - 10**9

    def _warn(self, sentence: str) -> None:
        if not self._has_warned:
            self._has_warned = True
            self._logger.warning(f"{sentence} (reported once)")

    def _stamped(self, transforms: Iterable[Transform], stamp: Any) -> list[TransformStamped]:
        return [_message(each, self._prefix, stamp) for each in transforms]

    def _publish_description(self, text: str) -> None:
        """Publish the description and the transforms of fixed joints."""
        for warning in self._kinematics.warnings:
            self._logger.warning(warning)
        self._description.publish(String(data=text))
        if self._kinematics.fixed:
            self._send_static(self._stamped(self._kinematics.fixed, self._node.get_clock().now().to_msg()))
        self._logger.info(
            f"Robot initialized: '{self._kinematics.name}', {len(self._kinematics.moving)} joints move, "
            f"{len(self._kinematics.fixed)} are fixed"
        )

    def _check(self, parameters: list[Parameter]) -> Any:
        from rcl_interfaces.msg import SetParametersResult

        for parameter in parameters:
            if parameter.name == "robot_description":
                try:
                    Kinematics.from_urdf(str(parameter.value))
                except SimError as error:
                    return SetParametersResult(successful=False, reason=first_line(error))
            elif parameter.name in DEFAULTS:
                reason = f"{parameter.name} cannot be changed while robot_state_publisher runs; start it with the value"
                return SetParametersResult(successful=False, reason=reason)
        return SetParametersResult(successful=True)

    def _change(self, parameters: list[Parameter]) -> None:
        for parameter in parameters:
            if parameter.name == "robot_description":
                self._kinematics = Kinematics.from_urdf(str(parameter.value))
                self._published_ns.clear()
                self._publish_description(str(parameter.value))


def _message(transform: Transform, prefix: str, stamp: Any) -> TransformStamped:
    message = TransformStamped(child_frame_id=prefix + transform.child)
    message.header.stamp = stamp
    message.header.frame_id = prefix + transform.parent
    place, turn = message.transform.translation, message.transform.rotation
    place.x, place.y, place.z = map(float, transform.pose.position)
    turn.w, turn.x, turn.y, turn.z = map(float, transform.pose.quaternion)
    return message
