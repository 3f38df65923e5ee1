"""The messages of ros_gz_interfaces, field by field.

Source: ros_gz_bridge/src/convert/ros_gz_interfaces.cpp, https://github.com/gazebosim/ros_gz
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from ros_gz_interfaces import msg
from std_msgs.msg import String, UInt32

from gz_course.sim.bridge.ros_gz_bridge.convert.geometry_msgs.poses import POSE, VECTOR3
from gz_course.sim.bridge.ros_gz_bridge.convert.geometry_msgs.twists import WRENCH, finite
from gz_course.sim.bridge.ros_gz_bridge.fields import (
    COLOR,
    DOUBLES,
    ENUM,
    FLOATS,
    HEADER,
    PLAIN,
    TEXTS,
    Each,
    Fields,
    Part,
    Plain,
    message_pair,
    plain,
)
from gz_course.sim.bridge.ros_gz_bridge.header import copy_header, fill_header, header_value, set_header_value

# In ROS these lists are messages of their own.
_TEXT = Plain(lambda text: String(data=text), lambda ros: ros.data)
_NUMBER = Plain(lambda number: UInt32(data=number), lambda ros: ros.data)

ENTITY = Fields(msg.Entity, **plain("id", "name"), type=ENUM)
JOINT_WRENCH = Fields(
    msg.JointWrench,
    header=HEADER,
    body_1_name=_TEXT,
    body_1_id=_NUMBER,
    body_2_name=_TEXT,
    body_2_id=_NUMBER,
    body_1_wrench=WRENCH,
    body_2_wrench=WRENCH,
)
CONTACT = Fields(
    msg.Contact,
    {"positions": "position", "normals": "normal", "depths": "depth", "wrenches": "wrench"},
    collision1=ENTITY,
    collision2=ENTITY,
    positions=Each(VECTOR3),
    normals=Each(VECTOR3),
    depths=DOUBLES,
    wrenches=Each(JOINT_WRENCH),
)
TRACK_VISUAL = Fields(
    msg.TrackVisual,
    {"is_static": "static"},
    header=HEADER,
    **plain("name", "id", "inherit_orientation", "min_dist", "max_dist", "is_static", "use_model_frame", "inherit_yaw"),
    xyz=VECTOR3,
)


def _pair(name: str, part: Part, gz_name: str = "", fault: Callable[[Any], str | None] | None = None) -> None:
    """Add a pair whose Gazebo type has the same name, or the name `gz_name`."""
    message_pair(f"ros_gz_interfaces/msg/{name}", f"gz.msgs.{gz_name or name}", part, fault)


def _fill_dataframe(gz: Any, ros: msg.Dataframe) -> None:
    """Write bytes and addresses; Gazebo keeps the signal strength [dBm] as text in the header."""
    fill_header(gz.header, ros.header)
    ros.src_address, ros.dst_address = gz.src_address, gz.dst_address
    ros.data.frombytes(gz.data)
    try:
        ros.rssi = float(header_value(gz.header, "rssi"))
    except ValueError:
        ros.rssi = 0.0


def _copy_dataframe(ros: msg.Dataframe, gz: Any) -> None:
    copy_header(ros.header, gz.header)
    set_header_value(gz.header, "rssi", repr(ros.rssi))
    gz.src_address, gz.dst_address, gz.data = ros.src_address, ros.dst_address, bytes(ros.data)


_pair(
    "Altimeter",
    Fields(msg.Altimeter, header=HEADER, **plain("vertical_position", "vertical_velocity", "vertical_reference")),
)
_pair("Contact", CONTACT)
_pair("Contacts", Fields(msg.Contacts, {"contacts": "contact"}, header=HEADER, contacts=Each(CONTACT)))
_pair("Dataframe", Part(msg.Dataframe, _fill_dataframe, _copy_dataframe))
_pair("Entity", ENTITY)
_pair(
    "EntityWrench",
    Fields(msg.EntityWrench, header=HEADER, entity=ENTITY, wrench=WRENCH),
    fault=finite("wrench.force", "wrench.torque"),
)
_pair("Float32Array", Fields(msg.Float32Array, data=FLOATS), "Float_V")
_pair(
    "GuiCamera",
    Fields(
        msg.GuiCamera,
        header=HEADER,
        **plain("name", "view_controller", "projection_type"),
        pose=POSE,
        track=TRACK_VISUAL,
    ),
    "GUICamera",
)
_pair("JointWrench", JOINT_WRENCH)
_pair(
    "Light",
    Fields(
        msg.Light,
        header=HEADER,
        type=ENUM,
        pose=POSE,
        diffuse=COLOR,
        specular=COLOR,
        direction=VECTOR3,
        **plain("name", "id", "parent_id", "intensity", "range", "cast_shadows"),
        **plain("attenuation_constant", "attenuation_linear", "attenuation_quadratic"),
        **plain("spot_inner_angle", "spot_outer_angle", "spot_falloff"),
    ),
)
_LOGICAL_MODEL = Fields(msg.LogicalCameraImageModel, name=PLAIN, pose=POSE)
_pair("LogicalCameraImage", Fields(msg.LogicalCameraImage, header=HEADER, pose=POSE, model=Each(_LOGICAL_MODEL)))
_pair(
    "MaterialColor",
    Fields(
        msg.MaterialColor,
        header=HEADER,
        entity=ENTITY,
        **dict.fromkeys(("ambient", "diffuse", "specular", "emissive"), COLOR),
        shininess=PLAIN,
        entity_match=ENUM,
    ),
)
_pair(
    "SensorNoise",
    Fields(
        msg.SensorNoise,
        header=HEADER,
        type=ENUM,
        **plain("mean", "stddev", "bias_mean", "bias_stddev", "precision"),
        **plain("dynamic_bias_stddev", "dynamic_bias_correlation_time"),
    ),
)
_pair("StringVec", Fields(msg.StringVec, header=HEADER, data=TEXTS), "StringMsg_V")
_pair("TrackVisual", TRACK_VISUAL)
_pair("VideoRecord", Fields(msg.VideoRecord, header=HEADER, **plain("start", "stop", "format", "save_filename")))
