"""Imu, JointState, BatteryState, NavSatFix, FluidPressure, Joy and MagneticField.

Source: ros_gz_bridge/src/convert/sensor_msgs.cpp, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

import math
from array import array
from typing import Any

import numpy as np
from sensor_msgs import msg

from gz_course.sim.bridge.ros_gz_bridge.convert.geometry_msgs.poses import VECTOR3, copy_xyz, copy_xyzw
from gz_course.sim.bridge.ros_gz_bridge.fields import FLOATS, HEADER, INT32S, PLAIN, Fields, Part, message_pair
from gz_course.sim.bridge.ros_gz_bridge.header import copy_header, fill_header, fill_stamp, frame_to_ros
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import ConversionError
from gz_course.sim.gz.msgs.battery_state_pb2 import BatteryState as GzBatteryState

_COVARIANCES = ("orientation_covariance", "angular_velocity_covariance", "linear_acceleration_covariance")
_BATTERY = ("voltage", "current", "charge", "capacity", "percentage")


def _copy_motion(source: Any, target: Any) -> None:
    copy_xyzw(source.orientation, target.orientation)
    copy_xyz(source.angular_velocity, target.angular_velocity)
    copy_xyz(source.linear_acceleration, target.linear_acceleration)


def _fill_imu(gz: Any, ros: msg.Imu) -> None:
    """Write orientation, angular velocity [rad/s], linear acceleration with gravity [m/s^2] and covariances (3, 3)."""
    fill_header(gz.header, ros.header)
    _copy_motion(gz, ros)
    for field in _COVARIANCES:
        numbers = getattr(gz, field).data
        if len(numbers) == 9:
            setattr(ros, field, np.array(numbers, dtype=np.float64))


def _copy_imu(ros: msg.Imu, gz: Any) -> None:
    """Write the same fields; the entity name is the frame."""
    copy_header(ros.header, gz.header)
    gz.entity_name = ros.header.frame_id
    _copy_motion(ros, gz)
    for field in _COVARIANCES:
        getattr(gz, field).data.extend(getattr(ros, field))


def _fill_joints(gz: Any, ros: msg.JointState) -> None:
    """Write position [rad] or [m], velocity [rad/s] or [m/s] and effort [N m] or [N] of each joint's first axis."""
    axes = [joint.axis1 for joint in gz.joint]
    fill_header(gz.header, ros.header)
    ros.name = [joint.name for joint in gz.joint]
    ros.position = array("d", [axis.position for axis in axes])
    ros.velocity = array("d", [axis.velocity for axis in axes])
    ros.effort = array("d", [axis.force for axis in axes])


def _copy_joints(ros: msg.JointState, gz: Any) -> None:
    """Write the same fields; positions, velocities and efforts that are missing in ROS become 0."""
    copy_header(ros.header, gz.header)
    columns = {"position": ros.position, "velocity": ros.velocity, "effort": ros.effort}
    for name, numbers in columns.items():
        if len(numbers) not in (0, len(ros.name)):
            raise ConversionError(f"the state of {len(ros.name)} joints carries {len(numbers)} numbers for {name}")
    for index, name in enumerate(ros.name):
        joint = gz.joint.add(name=name)
        for field, numbers in zip(("position", "velocity", "force"), columns.values(), strict=True):
            setattr(joint.axis1, field, numbers[index] if len(numbers) else 0.0)


def _fill_battery(gz: Any, ros: msg.BatteryState) -> None:
    """Write voltage [V], current [A], charge and capacity [Ah], percentage [0..1]; NaN as design capacity."""
    fill_header(gz.header, ros.header)
    _copy_charge(gz, ros)
    ros.design_capacity = math.nan
    ros.power_supply_health = msg.BatteryState.POWER_SUPPLY_HEALTH_UNKNOWN
    ros.power_supply_technology = msg.BatteryState.POWER_SUPPLY_TECHNOLOGY_UNKNOWN
    ros.present = True


def _copy_battery(ros: msg.BatteryState, gz: Any) -> None:
    copy_header(ros.header, gz.header)
    _copy_charge(ros, gz)


def _copy_charge(source: Any, target: Any) -> None:
    for field in _BATTERY:
        setattr(target, field, getattr(source, field))
    # The numbers of the known states are the same on both sides.
    known = source.power_supply_status in GzBatteryState.PowerSupplyStatus.values()
    target.power_supply_status = source.power_supply_status if known else 0


def _fill_fix(gz: Any, ros: msg.NavSatFix) -> None:
    """Write latitude [deg], longitude [deg] and altitude [m]; the status is always a fix, the covariance unknown."""
    fill_stamp(gz.header.stamp, ros.header.stamp)
    ros.header.frame_id = frame_to_ros(gz.frame_id)
    ros.status.status = msg.NavSatStatus.STATUS_FIX
    ros.latitude, ros.longitude, ros.altitude = gz.latitude_deg, gz.longitude_deg, gz.altitude
    ros.position_covariance_type = msg.NavSatFix.COVARIANCE_TYPE_UNKNOWN


def _copy_fix(ros: msg.NavSatFix, gz: Any) -> None:
    copy_header(ros.header, gz.header)
    gz.latitude_deg, gz.longitude_deg, gz.altitude = ros.latitude, ros.longitude, ros.altitude
    gz.frame_id = ros.header.frame_id


message_pair("sensor_msgs/msg/Imu", "gz.msgs.IMU", Part(msg.Imu, _fill_imu, _copy_imu))
message_pair("sensor_msgs/msg/JointState", "gz.msgs.Model", Part(msg.JointState, _fill_joints, _copy_joints))
message_pair(
    "sensor_msgs/msg/BatteryState", "gz.msgs.BatteryState", Part(msg.BatteryState, _fill_battery, _copy_battery)
)
message_pair("sensor_msgs/msg/NavSatFix", "gz.msgs.NavSat", Part(msg.NavSatFix, _fill_fix, _copy_fix))
message_pair(
    "sensor_msgs/msg/FluidPressure",
    "gz.msgs.FluidPressure",
    Fields(msg.FluidPressure, {"fluid_pressure": "pressure"}, header=HEADER, fluid_pressure=PLAIN, variance=PLAIN),
)
message_pair("sensor_msgs/msg/Joy", "gz.msgs.Joy", Fields(msg.Joy, header=HEADER, axes=FLOATS, buttons=INT32S))
message_pair(
    "sensor_msgs/msg/MagneticField",
    "gz.msgs.Magnetometer",
    Fields(msg.MagneticField, {"magnetic_field": "field_tesla"}, header=HEADER, magnetic_field=VECTOR3),
)
