"""marine_acoustic_msgs: Dvl, the velocity a Doppler log measures against the bottom or the water (m/s, m)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from marine_acoustic_msgs.msg import Dvl

from gz_course.sim.gz.msgs.dvl_kinematic_estimate_pb2 import DVLKinematicEstimate
from gz_course.sim.gz.msgs.dvl_tracking_target_pb2 import DVLTrackingTarget
from gz_course.sim.gz.msgs.dvl_velocity_tracking_pb2 import DVLVelocityTracking
from gz_course.sim.ros_gz_bridge.convert.geometry_msgs.poses import copy_xyz, vector_to_ros
from gz_course.sim.ros_gz_bridge.header import header_to_gz, header_to_ros
from gz_course.sim.ros_gz_bridge.type_pairs import type_pair

_BEAMS = 4
_UNKNOWN = -1.0
_MODES = {
    DVLTrackingTarget.DVL_TARGET_BOTTOM: Dvl.DVL_MODE_BOTTOM,
    DVLTrackingTarget.DVL_TARGET_WATER_MASS: Dvl.DVL_MODE_WATER,
}
_TYPES = {
    DVLVelocityTracking.DVL_TYPE_PISTON: Dvl.DVL_TYPE_PISTON,
    DVLVelocityTracking.DVL_TYPE_PHASED_ARRAY: Dvl.DVL_TYPE_PHASED_ARRAY,
}


@type_pair("marine_acoustic_msgs/msg/Dvl", "gz.msgs.DVLVelocityTracking")
class DvlPair:
    """Velocity with covariance, and the beams that have a lock: four at most, the first ones.

    Gazebo knows neither altitude, speed of sound nor the directions of the beams: -1 in ROS. A beam's velocity is
    its length there; ROS to Gazebo it points along the beam.
    """

    @staticmethod
    def to_ros(gz: Any) -> Dvl:
        """Gazebo to ROS."""
        velocity = vector_to_ros(gz.velocity.mean)
        ros = Dvl(
            header=header_to_ros(gz.header),
            velocity_mode=_MODES.get(gz.target.type, 0),
            dvl_type=_TYPES.get(gz.type, 0),
            velocity=velocity,
            altitude=_UNKNOWN,
            course_gnd=math.atan2(velocity.y, velocity.x),
            speed_gnd=math.hypot(velocity.x, velocity.y),
            sound_speed=_UNKNOWN,
        )
        covariance = gz.velocity.covariance
        ros.velocity_covar = np.array(covariance) if len(covariance) == 9 else np.full(9, _UNKNOWN)
        locked = [beam for beam in gz.beams if beam.locked][:_BEAMS]
        ros.num_good_beams = len(locked)
        ros.beam_ranges_valid = ros.beam_velocities_valid = bool(locked)
        for index, beam in enumerate(locked):
            direction, mean = ros.beam_unit_vec[index], beam.velocity.mean
            direction.x = direction.y = direction.z = _UNKNOWN
            ros.range[index] = beam.range.mean
            ros.range_covar[index] = beam.range.variance
            ros.beam_quality[index] = beam.rssi
            ros.beam_velocity[index] = math.hypot(mean.x, mean.y, mean.z)
            ros.beam_velocity_covar[index] = _UNKNOWN
        return ros

    @staticmethod
    def to_gz(ros: Dvl) -> Any:
        """ROS to Gazebo."""
        gz = DVLVelocityTracking()
        header_to_gz(ros.header, gz.header)
        gz.type = next((number for number, name in _TYPES.items() if name == ros.dvl_type), 0)
        gz.target.type = next((number for number, name in _MODES.items() if name == ros.velocity_mode), 0)
        gz.velocity.reference = DVLKinematicEstimate.DVL_REFERENCE_SHIP
        copy_xyz(ros.velocity, gz.velocity.mean)
        gz.velocity.covariance.extend(ros.velocity_covar)
        for index in range(min(ros.num_good_beams, _BEAMS)):
            direction, speed = ros.beam_unit_vec[index], float(ros.beam_velocity[index])
            beam = gz.beams.add(id=index + 1, rssi=float(ros.beam_quality[index]), locked=True)
            beam.velocity.reference = DVLKinematicEstimate.DVL_REFERENCE_SHIP
            mean = beam.velocity.mean
            mean.x, mean.y, mean.z = direction.x * speed, direction.y * speed, direction.z * speed
            beam.velocity.covariance.extend([0.0] * 9)
            beam.range.mean = ros.range[index]
            beam.range.variance = ros.range_covar[index]
        return gz
