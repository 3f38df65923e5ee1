"""JointStatePublisher: publishes position, velocity and force of the joints of a model after every step.

MuJoCo's state -> `gz.msgs.Model` on `/world/W/model/M/joint_state`, with one `joint` each whose `axis1` (and `axis2`)
holds position [rad or m], velocity, and the force [N m or N] of actuators and applied forces in the last step.
`parameter_bridge` converts it to `sensor_msgs/JointState`.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/joint_state_publisher/JointStatePublisher.cc
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from gz_course.sim.gz.sim.physics.joint_axis import JointAxis, find_axes
from gz_course.sim.gz.sim.plugins.model_scope import ModelScope
from gz_course.sim.gz.sim.plugins.period import period_ns
from gz_course.sim.gz.sim.plugins.system import FOREVER_NS, System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.pose import Pose, Vector, rotate
from gz_course.sim.gz.sim.sdf.description import UNLIMITED, Axis, Joint, Model, Plugin

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node


_REST_NS = 5_000_000
"""Simulated time [ns] after which it looks again whether there is a subscriber."""


@system("JointStatePublisher", "gz-sim-joint-state-publisher-system")
class JointStatePublisher(System):
    """Publishes the joints of one model, without nested models, or those that `<joint_name>` lists."""

    parameters = frozenset(("joint_name", "topic", "update_rate"))

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        element = plugin.element
        self.world = world
        self.scope = ModelScope(world, model, plugin, self.name)
        named = element.find("joint_name") is not None
        self.joints = self.scope.find_joints(element) if named else self.scope.joints()
        self.topic = valid_topic(element.text_of("topic"), f"/world/{world.name}{self.scope.topic}/joint_state")
        self._period_ns = period_ns(element.number("update_rate", 0.0))
        self._publisher: Any = None

    def bind(self) -> None:
        prefix, data = f"{self.scope.model.name}::", self.world.data
        self._axes: list[tuple[int, str, JointAxis]] = []
        self._arrays = data.qpos, data.qvel, data.qfrc_actuator, data.qfrc_applied
        self._balls: dict[int, tuple[Vector, Vector]] = {}
        """The quaternion in `data` and the rotation vector of each ball joint, by its position in qpos."""
        for index, joint in enumerate(self.joints):
            # A ball joint has three axes, the message has fields for two.
            for place, axis in zip(("axis1", "axis2"), find_axes(self.world.model, prefix + joint.name), strict=False):
                self._axes.append((index, place, axis))
                if axis.part >= 0:
                    self._balls[axis.position] = data.qpos[axis.position : axis.position + 4], np.zeros(3)
        if self._publisher is not None:
            self._prepare()

    def start(self) -> None:
        self._last_ns = 0

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.model_pb2 import Model as ModelMessage

        self._type = ModelMessage
        self._publisher = node.advertise(self.topic, ModelMessage)
        self._prepare()

    def post_update(self, info: UpdateInfo) -> None:
        if info.sim_time_ns - self._last_ns < self._period_ns:
            return
        self._last_ns = info.sim_time_ns
        if self._publisher is not None and self._publisher.has_connections():
            self._publish(info.sim_time_ns)

    def rests_until(self, info: UpdateInfo) -> int:
        if self._publisher is None:
            return FOREVER_NS
        if self._period_ns or self._publisher.has_connections():
            return self._last_ns + self._period_ns
        return info.sim_time_ns + _REST_NS

    def paused_update(self, info: UpdateInfo) -> None:
        """Publish the last state again, as Gazebo does."""
        if self._publisher is not None and self._publisher.has_connections():
            self._publish(info.sim_time_ns)

    def _publish(self, now_ns: int) -> None:
        message = self._message  # Publishing serializes it at once, so that one message object can be reused.
        message.header.stamp.sec, message.header.stamp.nsec = divmod(now_ns, 1_000_000_000)
        _fill_pose(message.pose, *self.scope.pose_in_floats())
        # Lists are faster than arrays for reading single numbers.
        positions, velocities, driven, applied = (array.tolist() for array in self._arrays)
        for quaternion, turn in self._balls.values():
            mujoco.mju_quat2Vel(turn, quaternion, 1.0)
        for filled, position, part, dof in self._filled:
            filled.position = positions[position] if part < 0 else self._balls[position][1].item(part)
            filled.velocity = velocities[dof]
            filled.force = driven[dof] + applied[dof]
        self._publisher.publish(message)

    def _prepare(self) -> None:
        """Create the parts that are the same in every message."""
        scope = self.scope
        message = self._type(name=scope.name, id=self.world.entities.number("model", *scope.path))
        moving = {(index, place) for index, place, _ in self._axes}
        for index, joint in enumerate(self.joints):
            made = message.joint.add(name=scope.own_name(joint.name), id=scope.entity("joint", joint.name))
            made.parent, made.child = scope.own_name(joint.parent), scope.own_name(joint.child)
            _fill_pose(made.pose, joint.pose.position.tolist(), joint.pose.quaternion.tolist())
            if (index, "axis1") in moving:
                made.axis1.SetInParent()
                if joint.axis is not None:
                    _fill_axis(made.axis1, joint, joint.axis)
        self._message = message
        self._filled = [
            (getattr(message.joint[index], place), axis.position, axis.part, axis.dof)
            for index, place, axis in self._axes
        ]


def _fill_axis(message: Any, joint: Joint, axis: Axis) -> None:
    back = joint.pose.inverse().quaternion
    message.xyz.x, message.xyz.y, message.xyz.z = rotate(back, Pose(axis.direction).position).tolist()
    message.limit_lower = axis.lower if axis.lower > -UNLIMITED else float("-inf")
    message.limit_upper = axis.upper if axis.upper < UNLIMITED else float("inf")
    message.damping = axis.damping


def _fill_pose(message: Any, position: Sequence[float], quaternion: Sequence[float]) -> None:
    place, turn = message.position, message.orientation
    place.x, place.y, place.z = position
    turn.w, turn.x, turn.y, turn.z = quaternion
