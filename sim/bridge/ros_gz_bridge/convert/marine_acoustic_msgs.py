"""marine_acoustic_msgs: Dvl, the velocity that a Doppler velocity log measures against the bottom or the water.

Source: marine_acoustic_msgs/msg/Dvl.msg, https://github.com/apl-ocean-engineering/marine_msgs
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from marine_acoustic_msgs.msg import Dvl

from gz_course.sim.bridge.ros_gz_bridge.convert.geometry_msgs.poses import copy_xyz
from gz_course.sim.bridge.ros_gz_bridge.fields import Part, message_pair
from gz_course.sim.bridge.ros_gz_bridge.header import copy_header, fill_header
from gz_course.sim.gz.msgs.dvl_kinematic_estimate_pb2 import DVLKinematicEstimate
from gz_course.sim.gz.msgs.dvl_tracking_target_pb2 import DVLTrackingTarget
from gz_course.sim.gz.msgs.dvl_velocity_tracking_pb2 import DVLVelocityTracking

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


def _fill_dvl(gz: Any, ros: Dvl) -> None:
    """Write velocity [m/s] with covariance, and the first four beams that have a lock.

    Gazebo has no altitude, no speed of sound and no directions of beams; these become -1. The velocity of a beam is
    the length of Gazebo's vector.
    """
    fill_header(gz.header, ros.header)
    ros.velocity_mode = _MODES.get(gz.target.type, 0)
    ros.dvl_type = _TYPES.get(gz.type, 0)
    copy_xyz(gz.velocity.mean, ros.velocity)
    ros.altitude = ros.sound_speed = _UNKNOWN
    ros.course_gnd = math.atan2(ros.velocity.y, ros.velocity.x)
    ros.speed_gnd = math.hypot(ros.velocity.x, ros.velocity.y)
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


def _copy_dvl(ros: Dvl, gz: Any) -> None:
    """Write velocity and beams; the velocity of a beam is along its direction."""
    copy_header(ros.header, gz.header)
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


message_pair("marine_acoustic_msgs/msg/Dvl", "gz.msgs.DVLVelocityTracking", Part(Dvl, _fill_dvl, _copy_dvl))
