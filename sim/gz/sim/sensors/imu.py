"""IMU: orientation, angular velocity and linear acceleration of a link, as `gz.msgs.IMU`.

The Imu system runs it. The acceleration is the specific force: 9.8 m/s^2 upwards at rest, zero in free fall. The
orientation is relative to the initial one, unless `<orientation_reference_frame>` names another frame.

Source: https://github.com/gazebosim/gz-sensors/blob/gz-sensors8/src/ImuSensor.cc
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np

from gz_course.sim.did_you_mean import did_you_mean
from gz_course.sim.gz.sim.errors import SimError
from gz_course.sim.gz.sim.plugins.noise import Noise
from gz_course.sim.gz.sim.plugins.sensor import sensor_type
from gz_course.sim.gz.sim.plugins.sensor_system import sensor_system
from gz_course.sim.gz.sim.plugins.site_sensor import SiteSensor, noise_at
from gz_course.sim.gz.sim.pose import Quaternion, Vector, multiply, product, quaternion_from_rpy, rotate
from gz_course.sim.gz.sim.sdf.description import Sensor
from gz_course.sim.gz.sim.sdf.element import Element

if TYPE_CHECKING:
    from gz_course.sim.gz.sim.plugins.world_access import WorldAccess

SDF_WORDS = {
    "sensor": "imu",
    "imu": (
        "angular_velocity linear_acceleration orientation orientation_reference_frame enable_orientation noise topic"
    ),
    "orientation_reference_frame": "localization custom_rpy grav_dir_x",
    "custom_rpy": "@parent_frame",
    "grav_dir_x": "@parent_frame",
    "angular_velocity": "x y z",
    "linear_acceleration": "x y z",
    "orientation": "x y z",
}

_FROM_ENU = {
    "ENU": (0.0, 0.0, 0.0),
    "NED": (math.pi, 0.0, math.pi / 2.0),
    "NWU": (0.0, 0.0, math.pi / 2.0),
}
"""Roll, pitch, yaw [rad] of the named frames in the east-north-up frame."""
LOCALIZATIONS = (*_FROM_ENU, "CUSTOM", "GRAV_UP", "GRAV_DOWN")
_AXES = [f"{group}/{axis}" for group in ("angular_velocity", "linear_acceleration") for axis in "xyz"]


@sensor_type("imu")
class Imu(SiteSensor):
    """An inertial measurement unit, run by the Imu system."""

    runs_in = sensor_system("Imu", "gz-sim-imu-system")
    suffix = "imu"
    message_type = "gz.msgs.IMU"

    def __init__(self, world: WorldAccess, description: Sensor) -> None:
        """Read `<imu>`; warns about an unknown localization and uses the initial orientation instead."""
        super().__init__(world, description)
        element = description.element
        self.enable_orientation = (element.find("imu") or element).flag("enable_orientation", True)
        self._frame = element.find("imu/orientation_reference_frame")
        self.localization = self._frame.text_of("localization", "CUSTOM") if self._frame is not None else ""
        if self._frame is not None and self.localization not in LOCALIZATIONS:
            hint = did_you_mean(self.localization, LOCALIZATIONS, listing="localizations are")
            self._warn(f"<localization> '{self.localization}' is not known{hint}")
        variances = [noise.stddev**2 for _, noise in self.read_noises(element)]
        self._covariances = [np.diag(variances[start : start + 3]).ravel().tolist() for start in (0, 3)]
        self.reference: Vector = quaternion_from_rpy(0.0, 0.0, 0.0)
        """The orientation (wxyz) of the reference frame in the world."""

    def read_noises(self, element: Element) -> Sequence[tuple[str, Noise]]:
        """Return the noises of the angular velocity [rad/s] and the acceleration [m/s^2], x y z each."""
        return [(axis, noise_at(element, f"imu/{axis}")) for axis in _AXES]

    def start(self) -> None:
        super().start()
        found = self._reference_frame()
        self.reference = self.motion.quaternion() if found is None else found
        w, x, y, z = self.reference.tolist()
        self._from_reference = w, -x, -y, -z

    def fill_constant(self, message: Any) -> None:
        message.entity_name = self.scoped_name
        if self.enable_orientation:
            message.orientation_covariance.data.extend([0.0] * 9)
        message.angular_velocity_covariance.data.extend(self._covariances[0])
        message.linear_acceleration_covariance.data.extend(self._covariances[1])

    def fill(self, message: Any) -> None:
        measured = self.noise.apply(self.motion.inertial())
        if self.enable_orientation:
            turn = message.orientation
            turn.w, turn.x, turn.y, turn.z = self.orientation()
        turning, pushing = message.angular_velocity, message.linear_acceleration
        turning.x, turning.y, turning.z, pushing.x, pushing.y, pushing.z = measured

    def orientation(self) -> Quaternion:
        """Return the sensor's orientation (wxyz) in the reference frame."""
        return product(self._from_reference, self.motion.orientation())

    def _reference_frame(self) -> Vector | None:
        """Return the quaternion (wxyz) of the reference frame, None for the initial orientation."""
        if self._frame is None:
            return None
        if self.localization in _FROM_ENU:
            where = self.world.description.spherical_coordinates
            # As in Gazebo, which turns by +heading here although the world itself is turned by +heading from ENU.
            heading = math.radians(where.heading_deg) if where is not None else 0.0
            return multiply(quaternion_from_rpy(0.0, 0.0, heading), quaternion_from_rpy(*_FROM_ENU[self.localization]))
        if self.localization == "CUSTOM":
            # Without a parent frame Gazebo uses the world's; SDF specifies the sensor's own.
            parent = self._parent_frame("custom_rpy", quaternion_from_rpy(0.0, 0.0, 0.0))
            roll, pitch, yaw = self._frame.vector("custom_rpy", (0.0, 0.0, 0.0))
            return None if parent is None else multiply(parent, quaternion_from_rpy(roll, pitch, yaw))
        if self.localization in ("GRAV_UP", "GRAV_DOWN"):
            return self._gravity_frame(1.0 if self.localization == "GRAV_UP" else -1.0)
        return None

    def _gravity_frame(self, sign: float) -> Vector | None:
        """Return the frame with z against gravity (along it for `sign` -1) and x nearest to grav_dir_x."""
        assert self._frame is not None
        parent = self._parent_frame("grav_dir_x", self.motion.quaternion())
        if parent is None:
            return None
        gravity = np.array(self.world.description.gravity)
        wanted = rotate(parent, np.array(self._frame.vector("grav_dir_x", (1.0, 0.0, 0.0))))
        strength = float(np.linalg.norm(gravity))
        up = -sign * gravity / strength if strength > 0.0 else np.zeros(3)
        ahead = wanted - up * float(up @ wanted)
        length = float(np.linalg.norm(ahead))
        if strength == 0.0 or length < 1e-9:
            self._warn(f"{self.localization} needs gravity and a <grav_dir_x> that is not parallel to it")
            return None
        ahead /= length
        found = np.zeros(4)
        mujoco.mju_mat2Quat(found, np.column_stack((ahead, np.cross(up, ahead), up)).ravel())
        return found

    def _parent_frame(self, tag: str, unnamed: Vector) -> Vector | None:
        """Return the orientation (wxyz) of the tag's `parent_frame`: the world or the present one of a link."""
        assert self._frame is not None
        element = self._frame.find(tag)
        name = element.attributes.get("parent_frame", "") if element is not None else ""
        if name in ("", "world"):
            return quaternion_from_rpy(0.0, 0.0, 0.0) if name else unnamed
        model, _, link = name.partition("::")
        try:
            return self.world.truth.link_pose(model, link).quaternion
        except SimError:
            links = [f"{each.name}::{part.name}" for each in self.world.description.models for part in each.links]
            hint = did_you_mean(name, ["world", *links], listing="frames are")
            self._warn(f"parent_frame '{name}' of <{tag}> names no link{hint}")
            return None

    def _warn(self, sentence: str) -> None:
        assert self._frame is not None
        text = f"{sentence}; sensor '{self.description.name}' reports its orientation from where it stands at the start"
        self.world.diagnostics.warn(self._frame.where, text)
