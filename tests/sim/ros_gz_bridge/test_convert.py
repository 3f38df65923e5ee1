"""Every pair in the table survives the way there and back, but for what the other side has no words for."""

import math
import re
from array import array

import numpy as np
import pytest
from gz.msgs.image_pb2 import Image as GzImage
from gz.msgs.laserscan_pb2 import LaserScan as GzLaserScan
from gz.msgs.odometry_pb2 import Odometry as GzOdometry
from gz.msgs.pose_pb2 import Pose as GzPose
from gz.msgs.time_pb2 import Time as GzTime
from hypothesis import given, settings
from hypothesis import strategies as st
from rcl_interfaces.msg import ParameterValue
from sensor_msgs.msg import CameraInfo, Image, JointState, LaserScan, Range

from ros_gz_bridge import type_pairs
from ros_gz_bridge.header import header_to_ros, set_header_value
from ros_gz_bridge.type_pairs import ConversionError, find_pair

PAIRS = type_pairs.pairs()
_SCALARS = {
    "boolean": st.booleans(),
    "double": st.floats(),
    "float": st.floats(width=32),
    "int32": st.integers(-(2**31), 2**31 - 1),
    "uint32": st.integers(0, 2**32 - 1),
    "uint8": st.integers(0, 255),
    "int8": st.integers(-128, 127),
    "uint16": st.integers(0, 2**16 - 1),
    "uint64": st.integers(0, 2**64 - 1),
    "string": st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=20),
}


def messages(ros_class):
    """Any ROS message of a class, built from what the class says of its fields."""
    if ros_class.__name__ in _SPECIAL:
        return _SPECIAL[ros_class.__name__]()
    fields = ros_class.get_fields_and_field_types()
    return st.builds(ros_class, **{name: _values(ros_class, name, kind) for name, kind in fields.items()})


def _values(ros_class, name, kind):
    if (ros_class.__name__, name) in _LIMITS:
        return _LIMITS[ros_class.__name__, name]
    if kind in _SCALARS:
        return _SCALARS[kind]
    if listed := re.fullmatch(r"sequence<(.+)>", kind):
        code = {"float": "f", "double": "d", "int32": "i", "uint8": "B"}.get(listed[1])
        items = st.lists(_values(ros_class, "", listed[1]), max_size=10)
        return items if code is None else items.map(lambda numbers: array(code, numbers))
    if fixed := re.fullmatch(r"(double|float)\[(\d+)\]", kind):
        size = int(fixed[2])
        dtype = np.float64 if fixed[1] == "double" else np.float32
        return st.lists(st.floats(width=32), min_size=size, max_size=size).map(lambda n: np.array(n, dtype=dtype))
    package, _, class_name = kind.partition("/")
    module = __import__(f"{package}.msg", fromlist=[class_name])
    return messages(getattr(module, class_name))


_LIMITS = {
    ("Time", "nanosec"): st.integers(0, 999_999_999),
    ("Duration", "nanosec"): st.integers(0, 999_999_999),
    ("PointField", "datatype"): st.integers(1, 8),
    ("BatteryState", "power_supply_status"): st.integers(0, 4),
    ("CameraInfo", "distortion_model"): st.sampled_from(["plumb_bob", "rational_polynomial", "equidistant"]),
}


@st.composite
def images(draw):
    from ros_gz_bridge.convert.sensor_msgs.cameras import ENCODINGS

    encoding = draw(st.sampled_from(sorted(ENCODINGS)))
    width, height, padding = draw(st.integers(0, 5)), draw(st.integers(0, 5)), draw(st.integers(0, 3))
    step = width * ENCODINGS[encoding][1] + padding
    data = draw(st.binary(min_size=step * height, max_size=step * height))
    header = draw(messages(type(Image().header)))
    return Image(header=header, width=width, height=height, step=step, encoding=encoding, data=array("B", data))


@st.composite
def joint_states(draw):
    joints = draw(st.lists(_SCALARS["string"], max_size=5))
    numbers = [
        array("d", draw(st.one_of(st.just([]), st.lists(st.floats(), min_size=len(joints), max_size=len(joints)))))
        for _ in range(3)
    ]
    header = draw(messages(type(JointState().header)))
    return JointState(header=header, name=joints, position=numbers[0], velocity=numbers[1], effort=numbers[2])


@st.composite
def parameter_values(draw):
    kind = draw(st.integers(0, 4))
    field = {1: "bool_value", 2: "integer_value", 3: "double_value", 4: "string_value"}.get(kind)
    values = {1: st.booleans(), 2: _SCALARS["int32"], 3: st.floats(), 4: _SCALARS["string"]}
    return ParameterValue(type=kind, **({field: draw(values[kind])} if field else {}))


_SPECIAL = {"Image": images, "JointState": joint_states, "ParameterValue": parameter_values}


def plain(message):
    """A message as nested dicts in which nan equals nan."""
    if hasattr(message, "get_fields_and_field_types"):
        return {name: plain(getattr(message, name)) for name in message.get_fields_and_field_types()}
    if isinstance(message, (array, np.ndarray, list, tuple)):
        return [plain(item) for item in message]
    if isinstance(message, float):
        return "nan" if math.isnan(message) else message
    return message


# What a message of Gazebo cannot carry, and so what comes back.
_REPLACED = {
    "BatteryState": {
        "temperature": "nan",
        "design_capacity": "nan",
        "power_supply_health": 0,
        "power_supply_technology": 0,
        "present": True,
        "cell_voltage": [],
        "cell_temperature": [],
        "location": "",
        "serial_number": "",
    },
    "CameraInfo": {"binning_x": 0, "binning_y": 0, "roi": plain(CameraInfo().roi)},
    "Range": {"radiation_type": Range.INFRARED, "variance": 0.0},
    "MagneticField": {"magnetic_field_covariance": [0.0] * 9},
    "NavSatFix": {
        "status": {"status": 0, "service": 0},
        "position_covariance": [0.0] * 9,
        "position_covariance_type": 0,
    },
}


def lossy(pair, expected):
    """What is left of a ROS message (as `plain`) after a visit to Gazebo."""
    for key in ("header", None):
        inside = expected.get(key, {}) if key else expected
        for name in ("frame_id", "child_frame_id"):
            if name in inside:
                inside[name] = inside[name].replace("::", "/")
    if pair.ros_class is LaserScan:
        expected["time_increment"] = expected["scan_time"] = 0.0
        beams = len(expected["ranges"])
        expected["intensities"] = expected["intensities"][:beams] if len(expected["intensities"]) >= beams else []
    for name, values in _REPLACED.get(pair.ros_class.__name__, {}).items():
        expected[name] = values
    if pair.ros_class is JointState:
        for numbers in ("position", "velocity", "effort"):
            expected[numbers] = expected[numbers] or [0.0] * len(expected["name"])
    if pair.gz_type == "gz.msgs.Odometry":
        expected["pose"]["covariance"] = expected["twist"]["covariance"] = [0.0] * 36
    return expected


@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: f"{pair.ros_type}={pair.gz_type}")
def test_there_and_back_is_the_same_message(pair):
    @settings(max_examples=50)
    @given(messages(pair.ros_class))
    def check(ros):
        on_the_wire = pair.to_gz(ros).SerializeToString()
        back = pair.to_ros(pair.gz_class.FromString(on_the_wire))
        assert type(back) is pair.ros_class
        assert plain(back) == lossy(pair, plain(ros))

    check()


@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: f"{pair.ros_type}={pair.gz_type}")
def test_gz_message_class_is_the_one_named(pair):
    assert pair.gz_class.DESCRIPTOR.full_name == pair.gz_type
    assert isinstance(pair.to_gz(pair.ros_class()) if pair.ros_class is not Image else GzImage(), pair.gz_class)


def test_last_beam_is_kept():
    pair = find_pair("sensor_msgs/msg/LaserScan", "gz.msgs.LaserScan")
    ranges = [1.0, 2.0, math.inf, 4.0]
    gz = pair.to_gz(LaserScan(angle_min=-1.0, angle_max=1.0, angle_increment=2 / 3, ranges=ranges))
    assert (gz.count, list(gz.ranges)) == (4, ranges)
    assert list(gz.intensities) == []


def test_scan_takes_its_frame_from_frame_and_not_from_the_header():
    gz = GzLaserScan(frame="robot::base::lidar")
    set_header_value(gz.header, "frame_id", "elsewhere")
    ros = find_pair("sensor_msgs/msg/LaserScan", "gz.msgs.LaserScan").to_ros(gz)
    assert ros.header.frame_id == "robot/base/lidar"
    assert isinstance(ros.ranges, array) and ros.ranges.typecode == "f"


@pytest.mark.parametrize(("layers", "chosen"), [(0, 0), (1, 0), (2, 1), (3, 1), (4, 2)])
def test_the_middle_layer_of_a_scan_is_taken(layers, chosen):
    ranges = [float(layer * 10 + beam) for layer in range(max(layers, 1)) for beam in range(3)]
    gz = GzLaserScan(count=3, vertical_count=layers, ranges=ranges, intensities=ranges)
    ros = find_pair("sensor_msgs/msg/LaserScan", "gz.msgs.LaserScan").to_ros(gz)
    assert list(ros.ranges) == list(ros.intensities) == [chosen * 10.0, chosen * 10 + 1.0, chosen * 10 + 2.0]


def test_a_scan_with_fewer_ranges_than_beams_is_refused():
    with pytest.raises(ConversionError, match="announces 5 beams a layer but carries 2 ranges"):
        find_pair("sensor_msgs/msg/LaserScan", "gz.msgs.LaserScan").to_ros(GzLaserScan(count=5, ranges=[1.0, 2.0]))


def test_the_last_frame_id_of_a_header_counts_and_a_missing_one_is_empty():
    gz = GzPose()
    assert header_to_ros(gz.header).frame_id == ""
    set_header_value(gz.header, "seq", "12")
    set_header_value(gz.header, "frame_id", "first")
    set_header_value(gz.header, "frame_id", "robot::odom")
    assert header_to_ros(gz.header).frame_id == "robot/odom"
    gz.header.data.add(key="frame_id")
    assert header_to_ros(gz.header).frame_id == ""


def test_odometry_carries_both_frames():
    gz = GzOdometry()
    set_header_value(gz.header, "frame_id", "robot/odom")
    set_header_value(gz.header, "child_frame_id", "robot::base")
    ros = find_pair("nav_msgs/msg/Odometry", "gz.msgs.Odometry").to_ros(gz)
    assert (ros.header.frame_id, ros.child_frame_id) == ("robot/odom", "robot/base")


@pytest.mark.parametrize("time", [GzTime(sec=2**31), GzTime(sec=-(2**31) - 1), GzTime(nsec=-1)])
def test_a_stamp_that_does_not_fit_is_refused(time):
    with pytest.raises(ConversionError, match="does not fit a ROS time"):
        find_pair("builtin_interfaces/msg/Time", "gz.msgs.Time").to_ros(time)


def test_only_sim_time_of_a_clock_travels():
    pair = find_pair("rosgraph_msgs/msg/Clock", "gz.msgs.Clock")
    clock = pair.gz_class(real=GzTime(sec=9), system=GzTime(sec=8), sim=GzTime(sec=1, nsec=2))
    ros = pair.to_ros(clock)
    assert (ros.clock.sec, ros.clock.nanosec) == (1, 2)
    assert pair.to_gz(ros) == pair.gz_class(sim=GzTime(sec=1, nsec=2))


def test_an_image_without_ros_encoding_is_refused_with_its_format():
    pair = find_pair("sensor_msgs/msg/Image", "gz.msgs.Image")
    with pytest.raises(ConversionError, match="the pixel format RGB_FLOAT32 has no ROS encoding"):
        pair.to_ros(GzImage(pixel_format_type="RGB_FLOAT32"))
    with pytest.raises(ConversionError, match="must carry 12 bytes, not 5"):
        pair.to_ros(GzImage(width=2, height=2, step=6, pixel_format_type="RGB_INT8", data=b"12345"))
    with pytest.raises(ConversionError, match="the encoding 'yuv422' has no Gazebo pixel format"):
        pair.to_gz(Image(encoding="yuv422"))


@given(st.lists(st.floats(), min_size=6, max_size=6))
def test_a_twist_is_at_fault_exactly_when_a_number_is_not_finite(numbers):
    from geometry_msgs.msg import Twist, TwistStamped, Vector3

    twist = Twist(linear=Vector3(x=numbers[0], y=numbers[1], z=numbers[2]))
    twist.angular = Vector3(x=numbers[3], y=numbers[4], z=numbers[5])
    names = ["linear.x", "linear.y", "linear.z", "angular.x", "angular.y", "angular.z"]
    bad = [name for name, value in zip(names, numbers, strict=True) if not math.isfinite(value)]
    fault = find_pair("geometry_msgs/msg/Twist", "gz.msgs.Twist").fault(twist)
    assert [part.split(" is ")[0] for part in fault.split(", ")] == bad if bad else fault is None
    stamped = find_pair("geometry_msgs/msg/TwistStamped", "gz.msgs.Twist").fault(TwistStamped(twist=twist))
    assert (stamped is None) == (not bad)
