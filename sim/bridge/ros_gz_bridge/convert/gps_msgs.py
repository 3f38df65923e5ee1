"""gps_msgs: GPSFix, position on the globe with velocity.

Source: gps_msgs/msg/GPSFix.msg, https://github.com/swri-robotics/gps_umd
"""

from __future__ import annotations

import math
from typing import Any

from gps_msgs.msg import GPSFix, GPSStatus

from gz_course.sim.bridge.ros_gz_bridge.fields import Part, message_pair
from gz_course.sim.bridge.ros_gz_bridge.header import copy_header, fill_stamp, frame_to_ros


def _fill_fix(gz: Any, ros: GPSFix) -> None:
    """Write position [deg], [m] and velocity as speed [m/s], track [rad] and climb [m/s].

    As in ros_gz_bridge the track is the angle of the velocity from east towards north, although the ROS message
    specifies a compass bearing in degrees.
    """
    for header in (ros.header, ros.status.header):
        fill_stamp(gz.header.stamp, header.stamp)
        header.frame_id = frame_to_ros(gz.frame_id)
    ros.status.status = GPSStatus.STATUS_FIX
    ros.latitude, ros.longitude, ros.altitude = gz.latitude_deg, gz.longitude_deg, gz.altitude
    ros.speed = math.hypot(gz.velocity_east, gz.velocity_north)
    ros.track = math.atan2(gz.velocity_north, gz.velocity_east)
    ros.climb = gz.velocity_up
    ros.position_covariance_type = GPSFix.COVARIANCE_TYPE_UNKNOWN


def _copy_fix(ros: GPSFix, gz: Any) -> None:
    # A track that is not finite is unknown; sine and cosine would raise an error.
    track = ros.track if math.isfinite(ros.track) else 0.0
    copy_header(ros.header, gz.header)
    gz.latitude_deg, gz.longitude_deg, gz.altitude = ros.latitude, ros.longitude, ros.altitude
    gz.velocity_east = ros.speed * math.cos(track)
    gz.velocity_north = ros.speed * math.sin(track)
    gz.velocity_up = ros.climb
    gz.frame_id = ros.header.frame_id


message_pair("gps_msgs/msg/GPSFix", "gz.msgs.NavSat", Part(GPSFix, _fill_fix, _copy_fix))
