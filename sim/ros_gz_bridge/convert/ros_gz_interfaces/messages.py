"""The messages of ros_gz_interfaces, field by field."""

from __future__ import annotations

from typing import Any

from ros_gz_interfaces.msg import (
    Altimeter,
    Contact,
    Contacts,
    Dataframe,
    Entity,
    EntityWrench,
    Float32Array,
    GuiCamera,
    JointWrench,
    Light,
    LogicalCameraImage,
    LogicalCameraImageModel,
    MaterialColor,
    SensorNoise,
    StringVec,
    TrackVisual,
    VideoRecord,
)
from std_msgs.msg import String, UInt32

from gz_course.sim.gz.msgs.dataframe_pb2 import Dataframe as GzDataframe
from gz_course.sim.ros_gz_bridge.convert.geometry_msgs.poses import POSE, VECTOR3
from gz_course.sim.ros_gz_bridge.convert.geometry_msgs.twists import WRENCH, not_finite
from gz_course.sim.ros_gz_bridge.fields import (
    COLOR,
    DOUBLES,
    ENUM,
    FLOATS,
    HEADER,
    PLAIN,
    TEXTS,
    Each,
    Fields,
    Kind,
    Plain,
    add_fields,
)
from gz_course.sim.ros_gz_bridge.header import header_to_gz, header_to_ros, header_value, set_header_value
from gz_course.sim.ros_gz_bridge.type_pairs import type_pair


def _plain(*names: str) -> dict[str, Kind]:
    return dict.fromkeys(names, PLAIN)


# ROS wraps these in messages of their own.
_TEXT = Plain(lambda text: String(data=text), lambda ros: ros.data)
_NUMBER = Plain(lambda number: UInt32(data=number), lambda ros: ros.data)

ENTITY = Fields(Entity, **_plain("id", "name"), type=ENUM)
JOINT_WRENCH = Fields(
    JointWrench,
    header=HEADER,
    body_1_name=_TEXT,
    body_1_id=_NUMBER,
    body_2_name=_TEXT,
    body_2_id=_NUMBER,
    body_1_wrench=WRENCH,
    body_2_wrench=WRENCH,
)
CONTACT = Fields(
    Contact,
    {"positions": "position", "normals": "normal", "depths": "depth", "wrenches": "wrench"},
    collision1=ENTITY,
    collision2=ENTITY,
    positions=Each(VECTOR3),
    normals=Each(VECTOR3),
    depths=DOUBLES,
    wrenches=Each(JOINT_WRENCH),
)
TRACK_VISUAL = Fields(
    TrackVisual,
    {"is_static": "static"},
    header=HEADER,
    **_plain("name", "id", "inherit_orientation", "min_dist", "max_dist", "is_static", "use_model_frame"),
    xyz=VECTOR3,
    inherit_yaw=PLAIN,
)

add_fields(
    "ros_gz_interfaces/msg/Altimeter",
    "gz.msgs.Altimeter",
    Fields(Altimeter, header=HEADER, **_plain("vertical_position", "vertical_velocity", "vertical_reference")),
)
add_fields("ros_gz_interfaces/msg/Contact", "gz.msgs.Contact", CONTACT)
add_fields(
    "ros_gz_interfaces/msg/Contacts",
    "gz.msgs.Contacts",
    Fields(Contacts, {"contacts": "contact"}, header=HEADER, contacts=Each(CONTACT)),
)
add_fields("ros_gz_interfaces/msg/Entity", "gz.msgs.Entity", ENTITY)
add_fields(
    "ros_gz_interfaces/msg/EntityWrench",
    "gz.msgs.EntityWrench",
    Fields(EntityWrench, header=HEADER, entity=ENTITY, wrench=WRENCH),
    fault=lambda ros: not_finite(ros, "wrench.force", "wrench.torque"),
)
add_fields("ros_gz_interfaces/msg/Float32Array", "gz.msgs.Float_V", Fields(Float32Array, data=FLOATS))
add_fields(
    "ros_gz_interfaces/msg/GuiCamera",
    "gz.msgs.GUICamera",
    Fields(
        GuiCamera,
        header=HEADER,
        **_plain("name", "view_controller"),
        pose=POSE,
        track=TRACK_VISUAL,
        projection_type=PLAIN,
    ),
)
add_fields("ros_gz_interfaces/msg/JointWrench", "gz.msgs.JointWrench", JOINT_WRENCH)
add_fields(
    "ros_gz_interfaces/msg/Light",
    "gz.msgs.Light",
    Fields(
        Light,
        header=HEADER,
        name=PLAIN,
        type=ENUM,
        pose=POSE,
        diffuse=COLOR,
        specular=COLOR,
        direction=VECTOR3,
        **_plain("attenuation_constant", "attenuation_linear", "attenuation_quadratic", "range", "cast_shadows"),
        **_plain("spot_inner_angle", "spot_outer_angle", "spot_falloff", "id", "parent_id", "intensity"),
    ),
)
add_fields(
    "ros_gz_interfaces/msg/LogicalCameraImage",
    "gz.msgs.LogicalCameraImage",
    Fields(
        LogicalCameraImage,
        header=HEADER,
        pose=POSE,
        model=Each(Fields(LogicalCameraImageModel, name=PLAIN, pose=POSE)),
    ),
)
add_fields(
    "ros_gz_interfaces/msg/MaterialColor",
    "gz.msgs.MaterialColor",
    Fields(
        MaterialColor,
        header=HEADER,
        entity=ENTITY,
        ambient=COLOR,
        diffuse=COLOR,
        specular=COLOR,
        emissive=COLOR,
        shininess=PLAIN,
        entity_match=ENUM,
    ),
)
add_fields(
    "ros_gz_interfaces/msg/SensorNoise",
    "gz.msgs.SensorNoise",
    Fields(
        SensorNoise,
        header=HEADER,
        type=ENUM,
        **_plain("mean", "stddev", "bias_mean", "bias_stddev", "precision"),
        **_plain("dynamic_bias_stddev", "dynamic_bias_correlation_time"),
    ),
)
add_fields("ros_gz_interfaces/msg/StringVec", "gz.msgs.StringMsg_V", Fields(StringVec, header=HEADER, data=TEXTS))
add_fields("ros_gz_interfaces/msg/TrackVisual", "gz.msgs.TrackVisual", TRACK_VISUAL)
add_fields(
    "ros_gz_interfaces/msg/VideoRecord",
    "gz.msgs.VideoRecord",
    Fields(VideoRecord, header=HEADER, **_plain("start", "stop", "format", "save_filename")),
)


@type_pair("ros_gz_interfaces/msg/Dataframe", "gz.msgs.Dataframe")
class DataframePair:
    """Bytes from one address to another; Gazebo keeps the signal strength (dBm) as text in the header."""

    @staticmethod
    def to_ros(gz: Any) -> Dataframe:
        """Gazebo to ROS."""
        try:
            rssi = float(header_value(gz.header, "rssi"))
        except ValueError:
            rssi = 0.0
        ros = Dataframe(header=header_to_ros(gz.header), src_address=gz.src_address, dst_address=gz.dst_address)
        ros.data.frombytes(gz.data)
        ros.rssi = rssi
        return ros

    @staticmethod
    def to_gz(ros: Dataframe) -> Any:
        """ROS to Gazebo."""
        gz = GzDataframe(src_address=ros.src_address, dst_address=ros.dst_address, data=bytes(ros.data))
        header_to_gz(ros.header, gz.header)
        set_header_value(gz.header, "rssi", repr(ros.rssi))
        return gz
