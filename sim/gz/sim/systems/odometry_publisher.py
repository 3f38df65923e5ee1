"""OdometryPublisher: publishes the true pose of a model as odometry.

MuJoCo's state -> `Odometry` on `/model/M/odometry`, the same with covariances on `/model/M/odometry_with_covariance`,
`Pose_V` on `/model/M/pose`. The pose is in the world frame (not relative to the start), the twist in the model's axes
with linear parts as means over the last ten steps. Nothing drifts; as in Gazebo `<gaussian_noise>` is added to the
twist only.

Source: https://github.com/gazebosim/gz-sim/blob/gz-sim8/src/systems/odometry_publisher/OdometryPublisher.cc
"""

from __future__ import annotations

import hashlib
import math
from collections import deque
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from gz_course.sim.gz.sim.driving.odometry_reports import fill_odometry_header
from gz_course.sim.gz.sim.plugins.model_scope import ModelScope
from gz_course.sim.gz.sim.plugins.period import period_ns
from gz_course.sim.gz.sim.plugins.system import System, UpdateInfo, system
from gz_course.sim.gz.sim.plugins.topics import valid_topic
from gz_course.sim.gz.sim.pose import Pose, Vector, multiply, rotate
from gz_course.sim.gz.sim.sdf.description import Model, Plugin

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess
    from gz_course.sim.gz.transport import Node

WINDOW = 10
_INVERSE = np.array((1.0, -1.0, -1.0, -1.0))


@system("OdometryPublisher", "gz-sim-odometry-publisher-system")
class OdometryPublisher(System):
    """Publishes the true odometry of one model. Parameters and defaults are Gazebo's."""

    parameters = frozenset(
        (
            "odom_frame",
            "robot_base_frame",
            "odom_publish_frequency",
            "odom_topic",
            "odom_covariance_topic",
            "tf_topic",
            "dimensions",
            "xyz_offset",
            "rpy_offset",
            "gaussian_noise",
        )
    )

    def configure(self, world: WorldAccess, model: Model | None, plugin: Plugin) -> None:
        """Read the parameters. Raises SdfError for dimensions other than 2 and 3, and for numbers that are not
        finite.
        """
        element = plugin.element
        self.world = world
        self.scope = scope = ModelScope(world, model, plugin, self.name)
        self.frame_id = element.text_of("odom_frame", f"{scope.name}/odom")
        self.child_frame_id = element.text_of("robot_base_frame", f"{scope.name}/base_footprint")
        self.dimensions = element.integer("dimensions", 2)
        if self.dimensions not in (2, 3):
            raise element.error(f"OdometryPublisher's <dimensions> must be 2 or 3, got {self.dimensions}")
        offset = (*element.vector("xyz_offset", (0.0, 0.0, 0.0)), *element.vector("rpy_offset", (0.0, 0.0, 0.0)))
        self.noise = element.number("gaussian_noise", 0.0)
        if not all(map(math.isfinite, (*offset, self.noise))) or self.noise < 0.0:
            raise element.error(
                "OdometryPublisher's offsets and <gaussian_noise> must be finite, the noise not negative"
            )
        self._offset = Pose.from_rpy(offset[:3], offset[3:])
        self._period_ns = period_ns(element.number("odom_publish_frequency", 50.0))
        default = f"/model/{scope.name}"
        self.odometry_topic = valid_topic(element.text_of("odom_topic"), f"{default}/odometry")
        self.covariance_topic = valid_topic(
            element.text_of("odom_covariance_topic"), f"{default}/odometry_with_covariance"
        )
        self.tf_topic = valid_topic(element.text_of("tf_topic"), f"{default}/pose")
        self._publishers: tuple[Any, ...] = ()

    def bind(self) -> None:
        """Check whether the canonical link has a free joint, so that qpos holds the pose of the model."""
        scope, model = self.scope, self.world.model
        self._link_to_base = scope.link_to_frame() * self._offset
        self._address = -1
        body = scope.body(scope.canonical_link)
        if body > 0 and model.body_jntnum[body] == 1:
            joint = int(model.body_jntadr[body])
            if int(model.jnt_type[joint]) == int(mujoco.mjtJoint.mjJNT_FREE):
                self._address = int(model.jnt_qposadr[joint])

    def start(self) -> None:
        self._published_ns = 0
        self._published = 0
        self._seen: deque[Vector | Pose] = deque(maxlen=WINDOW + 1)
        self._last: Pose | None = None
        self._velocities: deque[Vector] = deque(maxlen=WINDOW)
        self._turning = np.zeros(3)
        self._steps = self._caught_up = 0

    def connect(self, node: Node) -> None:
        from gz_course.sim.gz.msgs.odometry_pb2 import Odometry
        from gz_course.sim.gz.msgs.odometry_with_covariance_pb2 import OdometryWithCovariance
        from gz_course.sim.gz.msgs.pose_v_pb2 import Pose_V

        self._types: tuple[Any, ...] = (Odometry, OdometryWithCovariance, Pose_V)
        topics = (self.odometry_topic, self.covariance_topic, self.tf_topic)
        self._publishers = tuple(node.advertise(topic, kind) for topic, kind in zip(topics, self._types, strict=True))

    def post_update(self, info: UpdateInfo) -> None:
        """Store the present pose; publish if due and subscribed."""
        if self._address >= 0:
            self._seen.append(self.world.data.qpos[self._address : self._address + 7].copy())
        elif any(publisher.has_connections() for publisher in self._publishers):
            self._seen.append(self.scope.world_pose() * self._offset)
        self._steps += 1
        # Gazebo initializes with the first step and does not publish it.
        if self._steps == 1 or info.sim_time_ns - self._published_ns < self._period_ns:
            return
        self._published_ns = info.sim_time_ns
        self._published += 1
        heard = [publisher.has_connections() for publisher in self._publishers]
        if any(heard):
            self._publish(info, heard)

    def _publish(self, info: UpdateInfo, heard: list[bool]) -> None:
        pose = self._catch_up(info.dt)
        if pose is None:
            return
        odometry_type, covariance_type, pose_v_type = self._types
        message = odometry_type()
        fill_odometry_header(message.header, info.sim_time_ns, self.frame_id, self.child_frame_id)
        x, y, z = pose.position.tolist()
        message.pose.position.x, message.pose.position.y = x, y
        if self.dimensions == 3:
            message.pose.position.z = z
        turn = message.pose.orientation
        turn.w, turn.x, turn.y, turn.z = pose.quaternion.tolist()
        linear, angular = message.twist.linear, message.twist.angular
        speeds = np.concatenate((self._mean_velocity(), self._turning))
        if self.dimensions == 2:
            speeds[2:5] = 0.0
        if self.noise > 0.0:
            speeds += self.noise * self._random().standard_normal(6)
        linear.x, linear.y, linear.z, angular.x, angular.y, angular.z = speeds.tolist()
        if heard[0]:
            self._publishers[0].publish(message)
        if heard[1]:
            both = covariance_type()
            both.header.CopyFrom(message.header)
            both.pose_with_covariance.pose.CopyFrom(message.pose)
            both.twist_with_covariance.twist.CopyFrom(message.twist)
            diagonal = (np.eye(6) * self.noise**2).ravel().tolist()
            both.pose_with_covariance.covariance.data.extend(diagonal)
            both.twist_with_covariance.covariance.data.extend(diagonal)
            self._publishers[1].publish(both)
        if heard[2]:
            frames = pose_v_type()
            frame = frames.pose.add()
            frame.CopyFrom(message.pose)
            frame.header.CopyFrom(message.header)
            self._publishers[2].publish(frames)

    def _catch_up(self, dt: float) -> Pose | None:
        """Compute velocities from the poses since the last message; return the present pose of the base."""
        if self._steps - self._caught_up != len(self._seen):
            # Poses of skipped steps are missing: start again from the present one.
            self._last = None
            self._velocities.clear()
        self._caught_up = self._steps
        for seen in self._seen:
            pose = seen if isinstance(seen, Pose) else Pose(seen[:3], seen[3:]) * self._link_to_base
            if self._last is not None:
                self._velocities.append(self._velocity(self._last, pose, dt))
                between = multiply(pose.quaternion, self._last.quaternion * _INVERSE)
                self._turning = rotate(pose.quaternion * _INVERSE, np.array(Pose((0.0, 0.0, 0.0), between).rpy()) / dt)
            self._last = pose
        self._seen.clear()
        return self._last

    def _velocity(self, before: Pose, now: Pose, dt: float) -> Vector:
        """Return the linear velocity [m/s] of the base in its own axes; in 2-D only its heading is used."""
        moved = (now.position - before.position) / dt
        if self.dimensions == 3:
            return rotate(now.quaternion * _INVERSE, moved)
        yaw = now.yaw()
        cosine, sine = math.cos(yaw), math.sin(yaw)
        return np.array((cosine * moved[0] + sine * moved[1], cosine * moved[1] - sine * moved[0], 0.0))

    def _mean_velocity(self) -> Vector:
        if not self._velocities:
            return np.zeros(3)
        mean: Vector = np.mean(self._velocities, axis=0)
        return mean

    def _random(self) -> np.random.Generator:
        """Return the random generator of this message, which depends only on seed, model and message number."""
        text = f"{self.world.seed}/{self.scope.full_name}/OdometryPublisher/{self._published}"
        key = int.from_bytes(hashlib.sha256(text.encode()).digest()[:16], "little")
        return np.random.Generator(np.random.Philox(key=key))
