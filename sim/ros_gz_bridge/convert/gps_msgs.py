"""gps_msgs: GPSFix, position on the globe (degrees, metres) with velocity (m/s)."""

from __future__ import annotations

import math
from typing import Any

from gps_msgs.msg import GPSFix, GPSStatus

from gz_course.sim.gz.msgs.navsat_pb2 import NavSat
from gz_course.sim.ros_gz_bridge.header import frame_to_ros, header_to_gz, header_to_ros
from gz_course.sim.ros_gz_bridge.type_pairs import type_pair


@type_pair("gps_msgs/msg/GPSFix", "gz.msgs.NavSat")
class GPSFixPair:
    """Position, and velocity as speed, track and climb.

    The track is the mathematical angle of the velocity, in radians from east towards north, as ros_gz_bridge
    fills it, not the compass bearing in degrees that the ROS message describes.
    """

    @staticmethod
    def to_ros(gz: Any) -> GPSFix:
        """Gazebo to ROS."""
        header = header_to_ros(gz.header)
        header.frame_id = frame_to_ros(gz.frame_id)
        return GPSFix(
            header=header,
            status=GPSStatus(header=header, status=GPSStatus.STATUS_FIX),
            latitude=gz.latitude_deg,
            longitude=gz.longitude_deg,
            altitude=gz.altitude,
            speed=math.hypot(gz.velocity_east, gz.velocity_north),
            track=math.atan2(gz.velocity_north, gz.velocity_east),
            climb=gz.velocity_up,
            position_covariance_type=GPSFix.COVARIANCE_TYPE_UNKNOWN,
        )

    @staticmethod
    def to_gz(ros: GPSFix) -> Any:
        """ROS to Gazebo."""
        # A track that is not finite is unknown; sine and cosine would refuse it.
        track = ros.track if math.isfinite(ros.track) else 0.0
        gz = NavSat(
            latitude_deg=ros.latitude,
            longitude_deg=ros.longitude,
            altitude=ros.altitude,
            velocity_east=ros.speed * math.cos(track),
            velocity_north=ros.speed * math.sin(track),
            velocity_up=ros.climb,
            frame_id=ros.header.frame_id,
        )
        header_to_gz(ros.header, gz.header)
        return gz
