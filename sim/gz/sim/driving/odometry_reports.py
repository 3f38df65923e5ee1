"""Publishes the odometry of a drive such as DiffDrive as `Odometry` and, for transforms, as `Pose_V`.

The topics are `/model/M/odometry` and `/model/M/tf`, the rate is `<odom_publish_frequency>`.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/diff_drive/DiffDrive.cc
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, ClassVar

from gz_course.sim.gz.sim.plugins.model_scope import ModelScope
from gz_course.sim.gz.sim.plugins.period import period_ns
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.transport import Node


def fill_odometry_header(header: Any, now_ns: int, frame_id: str, child_frame_id: str) -> None:
    """Write the stamp (simulated time [ns]) and the two frames as Gazebo does."""
    header.stamp.sec, header.stamp.nsec = divmod(now_ns, 1_000_000_000)
    for key, value in (("frame_id", frame_id), ("child_frame_id", child_frame_id)):
        entry = header.data.add()
        entry.key = key
        entry.value.append(value)


class OdometryReports:
    """Topics, frames and rate of one drive's odometry, read from its parameters."""

    parameters: ClassVar[tuple[str, ...]] = (
        "odom_publish_frequency",
        "odom_topic",
        "tf_topic",
        "frame_id",
        "child_frame_id",
    )

    def __init__(self, scope: ModelScope, element: Element) -> None:
        self._period_ns = period_ns(element.number("odom_publish_frequency", 50.0))
        self.odometry_topic = valid_topic(element.text_of("odom_topic"), f"/model/{scope.name}/odometry")
        self.tf_topic = valid_topic(element.text_of("tf_topic"), f"/model/{scope.name}/tf")
        self.frame_id = element.text_of("frame_id", f"{scope.name}/odom")
        base = scope.own_name(scope.canonical_link).replace("::", "/")
        self.child_frame_id = element.text_of("child_frame_id", f"{scope.name}/{base}")
        self._publisher: Any = None
        self._tf_publisher: Any = None
        self.start()

    def start(self) -> None:
        self._last_ns = 0

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.odometry_pb2 import Odometry
        from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V

        # Publishing serializes a message at once, so that the same two can be filled again and again.
        self._odometry, self._frames = Odometry(), Pose_V()
        self._frame = self._frames.pose.add()
        for message in (self._odometry, self._frame):
            fill_odometry_header(message.header, 0, self.frame_id, self.child_frame_id)
        self._publisher = node.advertise(self.odometry_topic, Odometry)
        self._tf_publisher = node.advertise(self.tf_topic, Pose_V)

    def has_connections(self) -> bool:
        """Tell whether there is a subscriber of one of the two topics."""
        return self._publisher is not None and (
            self._publisher.has_connections() or self._tf_publisher.has_connections()
        )

    def due(self, now_ns: int) -> bool:
        """Tell whether a message is due; if so, schedule the next one."""
        if now_ns - self._last_ns < self._period_ns:
            return False
        self._last_ns = now_ns
        return True

    @property
    def next_ns(self) -> int:
        """The simulated time [ns] from which the next message is due."""
        return self._last_ns + self._period_ns

    def publish(
        self, now_ns: int, pose: tuple[float, float, float], linear: float, angular: float, left: float = 0.0
    ) -> None:
        """Publish to subscribers: `pose` is x, y [m] and heading [rad]; `linear` (forward) and `left` are in [m/s],
        `angular` is in [rad/s].
        """
        if self._publisher is not None and self._publisher.has_connections():
            message = self._odometry
            _fill_pose(message, now_ns, message.pose, pose)
            message.twist.linear.x = linear
            message.twist.linear.y = left
            message.twist.angular.z = angular
            self._publisher.publish(message)
        if self._tf_publisher is not None and self._tf_publisher.has_connections():
            _fill_pose(self._frame, now_ns, self._frame, pose)
            self._tf_publisher.publish(self._frames)


def _fill_pose(stamped: Any, now_ns: int, into: Any, pose: tuple[float, float, float]) -> None:
    stamp, position, turn = stamped.header.stamp, into.position, into.orientation
    stamp.sec, stamp.nsec = divmod(now_ns, 1_000_000_000)
    position.x, position.y, heading = pose
    turn.z, turn.w = math.sin(heading / 2.0), math.cos(heading / 2.0)
