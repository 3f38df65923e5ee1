"""Imu, JointState, BatteryState, NavSatFix, FluidPressure, Joy and MagneticField."""

from __future__ import annotations

import math
from array import array
from typing import Any

import numpy as np
from sensor_msgs.msg import (
    BatteryState,
    FluidPressure,
    Imu,
    JointState,
    Joy,
    MagneticField,
    NavSatFix,
    NavSatStatus,
)

from gz_course.sim.gz.msgs.battery_state_pb2 import BatteryState as GzBatteryState
from gz_course.sim.gz.msgs.imu_pb2 import IMU
from gz_course.sim.gz.msgs.model_pb2 import Model
from gz_course.sim.gz.msgs.navsat_pb2 import NavSat
from gz_course.sim.ros_gz_bridge.blank import blank
from gz_course.sim.ros_gz_bridge.convert.geometry_msgs.poses import VECTOR3, copy_xyz, copy_xyzw, fill_xyz, fill_xyzw
from gz_course.sim.ros_gz_bridge.fields import FLOATS, HEADER, INT32S, PLAIN, Fields, add_fields
from gz_course.sim.ros_gz_bridge.header import fill_header, frame_to_ros, header_to_gz, header_to_ros
from gz_course.sim.ros_gz_bridge.type_pairs import ConversionError, type_pair


@type_pair("sensor_msgs/msg/Imu", "gz.msgs.IMU")
class ImuPair:
    """Orientation, angular velocity (rad/s) and linear acceleration (m/s², with gravity); covariances."""

    @staticmethod
    def to_ros(gz: Any) -> Imu:
        """Gazebo to ROS."""
        ros = blank(Imu)
        fill_header(gz.header, ros.header)
        fill_xyzw(gz.orientation, ros.orientation)
        fill_xyz(gz.angular_velocity, ros.angular_velocity)
        fill_xyz(gz.linear_acceleration, ros.linear_acceleration)
        for field in (
            "orientation_covariance",
            "angular_velocity_covariance",
            "linear_acceleration_covariance",
        ):
            numbers = getattr(gz, field).data
            if len(numbers) == 9:
                setattr(ros, field, np.array(numbers, dtype=np.float64))
        return ros

    @staticmethod
    def to_gz(ros: Imu) -> Any:
        """ROS to Gazebo; the frame is the entity's name too."""
        gz = IMU(entity_name=ros.header.frame_id)
        header_to_gz(ros.header, gz.header)
        copy_xyzw(ros.orientation, gz.orientation)
        copy_xyz(ros.angular_velocity, gz.angular_velocity)
        copy_xyz(ros.linear_acceleration, gz.linear_acceleration)
        gz.orientation_covariance.data.extend(ros.orientation_covariance)
        gz.angular_velocity_covariance.data.extend(ros.angular_velocity_covariance)
        gz.linear_acceleration_covariance.data.extend(ros.linear_acceleration_covariance)
        return gz


@type_pair("sensor_msgs/msg/JointState", "gz.msgs.Model")
class JointStatePair:
    """Position, velocity and effort of each joint's first axis (rad or m; N or Nm).

    ROS may leave velocities or efforts out; they become 0 in Gazebo.
    """

    @staticmethod
    def to_ros(gz: Any) -> JointState:
        """Gazebo to ROS."""
        axes = [joint.axis1 for joint in gz.joint]
        ros = blank(JointState)
        fill_header(gz.header, ros.header)
        ros.name = [joint.name for joint in gz.joint]
        ros.position = array("d", [axis.position for axis in axes])
        ros.velocity = array("d", [axis.velocity for axis in axes])
        ros.effort = array("d", [axis.force for axis in axes])
        return ros

    @staticmethod
    def to_gz(ros: JointState) -> Any:
        """ROS to Gazebo."""
        gz = Model()
        header_to_gz(ros.header, gz.header)
        columns = {"position": ros.position, "velocity": ros.velocity, "effort": ros.effort}
        for name, numbers in columns.items():
            if len(numbers) not in (0, len(ros.name)):
                raise ConversionError(f"the state of {len(ros.name)} joints carries {len(numbers)} numbers for {name}")
        for index, name in enumerate(ros.name):
            joint = gz.joint.add(name=name)
            for field, numbers in zip(("position", "velocity", "force"), columns.values(), strict=True):
                setattr(joint.axis1, field, numbers[index] if len(numbers) else 0.0)
        return gz


@type_pair("sensor_msgs/msg/BatteryState", "gz.msgs.BatteryState")
class BatteryStatePair:
    """Volts, amperes, ampere-hours and a share of 1; what Gazebo does not model is unknown (NaN) in ROS."""

    _FIELDS = ("voltage", "current", "charge", "capacity", "percentage")

    @classmethod
    def to_ros(cls, gz: Any) -> BatteryState:
        """Gazebo to ROS."""
        status = gz.power_supply_status
        return BatteryState(
            header=header_to_ros(gz.header),
            **{field: getattr(gz, field) for field in cls._FIELDS},
            temperature=math.nan,
            design_capacity=math.nan,
            # The numbers of the known states are the same on both sides.
            power_supply_status=status if status in GzBatteryState.PowerSupplyStatus.values() else 0,
            power_supply_health=BatteryState.POWER_SUPPLY_HEALTH_UNKNOWN,
            power_supply_technology=BatteryState.POWER_SUPPLY_TECHNOLOGY_UNKNOWN,
            present=True,
        )

    @classmethod
    def to_gz(cls, ros: BatteryState) -> Any:
        """ROS to Gazebo."""
        status = ros.power_supply_status
        gz = GzBatteryState(
            **{field: getattr(ros, field) for field in cls._FIELDS},
            power_supply_status=status if status in GzBatteryState.PowerSupplyStatus.values() else 0,
        )
        header_to_gz(ros.header, gz.header)
        return gz


@type_pair("sensor_msgs/msg/NavSatFix", "gz.msgs.NavSat")
class NavSatFixPair:
    """Latitude, longitude (degrees) and altitude (m); always a fix, of unknown accuracy. Velocities stay behind."""

    @staticmethod
    def to_ros(gz: Any) -> NavSatFix:
        """Gazebo to ROS."""
        ros = NavSatFix(
            header=header_to_ros(gz.header),
            status=NavSatStatus(status=NavSatStatus.STATUS_FIX),
            latitude=gz.latitude_deg,
            longitude=gz.longitude_deg,
            altitude=gz.altitude,
            position_covariance_type=NavSatFix.COVARIANCE_TYPE_UNKNOWN,
        )
        ros.header.frame_id = frame_to_ros(gz.frame_id)
        return ros

    @staticmethod
    def to_gz(ros: NavSatFix) -> Any:
        """ROS to Gazebo."""
        gz = NavSat(
            latitude_deg=ros.latitude,
            longitude_deg=ros.longitude,
            altitude=ros.altitude,
            frame_id=ros.header.frame_id,
        )
        header_to_gz(ros.header, gz.header)
        return gz


add_fields(
    "sensor_msgs/msg/FluidPressure",
    "gz.msgs.FluidPressure",
    Fields(FluidPressure, {"fluid_pressure": "pressure"}, header=HEADER, fluid_pressure=PLAIN, variance=PLAIN),
)
add_fields("sensor_msgs/msg/Joy", "gz.msgs.Joy", Fields(Joy, header=HEADER, axes=FLOATS, buttons=INT32S))
add_fields(
    "sensor_msgs/msg/MagneticField",
    "gz.msgs.Magnetometer",
    Fields(MagneticField, {"magnetic_field": "field_tesla"}, header=HEADER, magnetic_field=VECTOR3),
)
