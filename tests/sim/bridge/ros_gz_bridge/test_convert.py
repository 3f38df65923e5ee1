"""Every pair in the table survives conversion and back, except for fields without a counterpart."""

import math
import operator
from array import array

import pytest
from builtin_interfaces.msg import Time
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rcl_interfaces.msg import ParameterValue
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import CameraInfo, Image, JointState, LaserScan, PointCloud2, PointField, Range
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from gz_course.sim.bridge.ros_gz_bridge import type_pairs
from gz_course.sim.bridge.ros_gz_bridge.fields import HEADER
from gz_course.sim.bridge.ros_gz_bridge.header import set_header_value
from gz_course.sim.bridge.ros_gz_bridge.remarks import converted
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import ConversionError, find_pair
from gz_course.sim.gz.msgs.image_pb2 import Image as GzImage
from gz_course.sim.gz.msgs.laserscan_pb2 import LaserScan as GzLaserScan
from gz_course.sim.gz.msgs.odometry_pb2 import Odometry as GzOdometry
from gz_course.sim.gz.msgs.pose_pb2 import Pose as GzPose
from gz_course.sim.gz.msgs.time_pb2 import Time as GzTime
from gz_course.tests.sim.bridge.ros_gz_bridge.ros_messages import messages, plain

PAIRS = type_pairs.pairs()
# Fields of these are computed or lost; test_convert_interfaces.py has tests of them.
_COMPUTED = {"GPSFix", "Dvl", "ParamVec", "Detection2D", "Detection2DArray", "Detection3D", "Detection3DArray"}
ALIKE = [pair for pair in PAIRS if pair.ros_class.__name__ not in _COMPUTED]
# The fields that a Gazebo message cannot hold, and their values after conversion back.
_REPLACED = {
    "BatteryState": {
        "temperature": 0.0,
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


def with_ros_frames(held):
    """Return a message (as `plain`) with the frames, at any depth, as they come back from Gazebo."""
    if isinstance(held, dict):
        return {
            key: value.replace("::", "/") if key in ("frame_id", "child_frame_id") else with_ros_frames(value)
            for key, value in held.items()
        }
    return [with_ros_frames(value) for value in held] if isinstance(held, list) else held


def lossy(pair, expected):
    """Return the ROS message (as `plain`) that is expected after conversion to Gazebo and back."""
    expected = with_ros_frames(expected)
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


@pytest.mark.hypothesis
@pytest.mark.parametrize("pair", ALIKE, ids=lambda pair: f"{pair.ros_type}={pair.gz_type}")
def test_there_and_back_is_the_same_message(pair):
    @settings(max_examples=50, suppress_health_check=[HealthCheck.too_slow])
    @given(messages(pair.ros_class))
    def check(ros):
        on_the_wire = pair.to_gz(ros).SerializeToString()
        back = pair.to_ros(pair.gz_class.FromString(on_the_wire))
        assert type(back) is pair.ros_class
        assert plain(back) == lossy(pair, plain(ros))
        assert plain(deserialize_message(serialize_message(back), pair.ros_class)) == plain(back), "as sent over DDS"

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
    assert HEADER.to_ros(gz.header).frame_id == ""
    set_header_value(gz.header, "seq", "12")
    set_header_value(gz.header, "frame_id", "first")
    set_header_value(gz.header, "frame_id", "robot::odom")
    assert HEADER.to_ros(gz.header).frame_id == "robot/odom"
    gz.header.data.add(key="frame_id")
    assert HEADER.to_ros(gz.header).frame_id == "robot/odom", "a key without value is no frame"


def test_odometry_carries_both_frames():
    gz = GzOdometry()
    set_header_value(gz.header, "frame_id", "robot/odom")
    gz.header.data.add(key="child_frame_id")
    set_header_value(gz.header, "child_frame_id", "robot::base")
    set_header_value(gz.header, "child_frame_id", "another")
    ros = find_pair("nav_msgs/msg/Odometry", "gz.msgs.Odometry").to_ros(gz)
    assert (ros.header.frame_id, ros.child_frame_id) == ("robot/odom", "robot/base")


def test_a_stamp_that_does_not_fit_is_cut_to_32_bits():
    pair = find_pair("builtin_interfaces/msg/Time", "gz.msgs.Time")
    for time, sec, nanosec in (
        (GzTime(sec=2**31, nsec=5), -(2**31), 5),
        (GzTime(sec=-(2**31) - 1), 2**31 - 1, 0),
        (GzTime(nsec=-1), 0, 2**32 - 1),
    ):
        ros, (text,) = converted(pair.to_ros, time)
        assert (ros.sec, ros.nanosec) == (sec, nanosec)
        assert text == (
            f"the stamp {time.sec} s {time.nsec} ns does not fit a ROS time; it became {sec} s {nanosec} ns"
        )
    gz, (text,) = converted(pair.to_gz, Time(sec=1, nanosec=2**31))
    assert (gz.sec, gz.nsec, "does not fit a Gazebo time" in text) == (1, -(2**31), True)
    assert converted(pair.to_gz, Time(sec=1, nanosec=2)) == (GzTime(sec=1, nsec=2), [])


def test_only_sim_time_of_a_clock_travels():
    pair = find_pair("rosgraph_msgs/msg/Clock", "gz.msgs.Clock")
    clock = pair.gz_class(real=GzTime(sec=9), system=GzTime(sec=8), sim=GzTime(sec=1, nsec=2))
    ros = pair.to_ros(clock)
    assert (ros.clock.sec, ros.clock.nanosec) == (1, 2)
    assert pair.to_gz(ros) == pair.gz_class(sim=GzTime(sec=1, nsec=2))


def test_an_image_of_another_format_is_sent_without_pixels():
    pair = find_pair("sensor_msgs/msg/Image", "gz.msgs.Image")
    gz = GzImage(width=2, height=1, step=24, pixel_format_type="RGB_FLOAT32", data=bytes(24))
    set_header_value(gz.header, "frame_id", "eye")
    ros, (text,) = converted(pair.to_ros, gz)
    assert "the pixel format RGB_FLOAT32 has no ROS encoding" in text
    assert (ros.header.frame_id, ros.width, ros.height, ros.encoding, len(ros.data)) == ("eye", 2, 1, "", 0)
    ros.encoding = "yuv422"
    gz, (text,) = converted(pair.to_gz, ros)
    assert "the encoding 'yuv422' has no Gazebo pixel format" in text
    assert (gz.width, gz.height, gz.pixel_format_type, gz.data) == (2, 1, 0, b"")


def test_an_image_with_another_number_of_pixels_is_refused():
    pair = find_pair("sensor_msgs/msg/Image", "gz.msgs.Image")
    with pytest.raises(ConversionError, match="must carry 12 bytes, not 5"):
        pair.to_ros(GzImage(width=2, height=2, step=6, pixel_format_type="RGB_INT8", data=b"12345"))


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


def pair_of(ros_type, gz_name):
    return find_pair(ros_type, f"gz.msgs.{gz_name}")


def test_velocities_and_efforts_may_be_missing_from_a_joint_state():
    pair = pair_of("sensor_msgs/msg/JointState", "Model")
    gz = pair.to_gz(JointState(name=["a", "b"], position=[1.0, 2.0]))
    assert [(j.name, j.axis1.position, j.axis1.velocity, j.axis1.force) for j in gz.joint] == [
        ("a", 1.0, 0.0, 0.0),
        ("b", 2.0, 0.0, 0.0),
    ]
    assert [joint.axis1.velocity for joint in pair.to_gz(JointState(name=["a"], velocity=[3.0])).joint] == [3.0]


@pytest.mark.parametrize("field", ["position", "velocity", "effort"])
def test_a_joint_state_with_numbers_for_other_joints_is_refused(field):
    ros = JointState(name=["a", "b"], **{field: [1.0]})
    with pytest.raises(ConversionError, match=f"the state of 2 joints carries 1 numbers for {field}"):
        pair_of("sensor_msgs/msg/JointState", "Model").to_gz(ros)


def test_a_scan_from_a_real_lidar_needs_no_intensities():
    pair = pair_of("sensor_msgs/msg/LaserScan", "LaserScan")
    gz = pair.to_gz(LaserScan(ranges=[1.0, 2.0], intensities=[5.0]))
    assert (list(gz.ranges), list(pair.to_ros(gz).intensities)) == ([1.0, 2.0], [])


def test_ranges_beyond_float32_are_infinite():
    gz = GzLaserScan(count=3, ranges=[1e300, -1e300, math.nan])
    ros = pair_of("sensor_msgs/msg/LaserScan", "LaserScan").to_ros(gz)
    assert list(ros.ranges)[:2] == [math.inf, -math.inf] and math.isnan(ros.ranges[2])


def test_rows_of_an_image_keep_their_padding():
    pair = pair_of("sensor_msgs/msg/Image", "Image")
    gz = GzImage(width=1, height=2, step=4, pixel_format_type="RGB_INT8", data=b"abc-def-")
    ros = pair.to_ros(gz)
    assert (ros.step, bytes(ros.data)) == (4, b"abc-def-")
    assert (pair.to_gz(ros).step, pair.to_gz(ros).data) == (4, b"abc-def-")
    gz.step, gz.data = 0, b"abcdef"
    assert pair.to_ros(gz).step == 3


def test_big_endian_numbers_of_an_image_are_refused():
    pair = pair_of("sensor_msgs/msg/Image", "Image")
    wide = Image(width=1, height=1, step=2, encoding="mono16", is_bigendian=1, data=array("B", b"ab"))
    with pytest.raises(ConversionError, match="big-endian"):
        pair.to_gz(wide)
    assert pair.to_gz(Image(width=1, height=1, step=1, encoding="mono8", is_bigendian=1, data=array("B", b"a"))).data


@pytest.mark.parametrize(
    ("fill", "name", "size", "count"),
    [
        (lambda gz, numbers: gz.intrinsics.k.extend(numbers), "K", 9, 10),
        (lambda gz, numbers: gz.rectification_matrix.extend(numbers), "R", 9, 8),
        (lambda gz, numbers: gz.projection.p.extend(numbers), "P", 12, 1000),
    ],
)
def test_a_camera_matrix_of_another_size_is_refused(fill, name, size, count):
    pair = pair_of("sensor_msgs/msg/CameraInfo", "CameraInfo")
    gz = pair.gz_class()
    fill(gz, [1.0] * count)
    with pytest.raises(ConversionError, match=f"the matrix {name} of a camera has {size} numbers, not {count}"):
        pair.to_ros(gz)
    gz = pair.gz_class()
    fill(gz, [2.0] * size)
    assert list(getattr(pair.to_ros(gz), name.lower())) == [2.0] * size


def test_distortion_models_that_are_not_known_lose_their_name():
    pair = pair_of("sensor_msgs/msg/CameraInfo", "CameraInfo")
    assert pair.to_ros(pair.gz_class()).distortion_model == ""
    gz, (text,) = converted(pair.to_gz, CameraInfo(distortion_model="fisheye", d=[1.0]))
    assert "the distortion model 'fisheye' is not Gazebo's" in text
    assert (gz.distortion.model, list(gz.distortion.k)) == (gz.Distortion.PLUMB_BOB, [1.0])
    gz.distortion.model = 9
    ros, (text,) = converted(pair.to_ros, gz)
    assert (ros.distortion_model, list(ros.d), "number 9 is unknown" in text) == ("", [1.0], True)
    assert converted(pair.to_gz, CameraInfo())[1] == [], "a camera that is not calibrated"


def test_types_of_point_fields_are_matched_by_name():
    pair = pair_of("sensor_msgs/msg/PointCloud2", "PointCloudPacked")
    field = pair.gz_class.Field
    names = ["INT8", "UINT8", "INT16", "UINT16", "INT32", "UINT32", "FLOAT32", "FLOAT64"]
    gz = pair.gz_class(data=b"points", point_step=3, row_step=6)
    for name in names:
        gz.field.add(name=name, datatype=field.DataType.Value(name), count=1)
    ros = pair.to_ros(gz)
    assert [getattr(PointField, one.name) == one.datatype for one in ros.fields] == [True] * 8
    assert isinstance(ros.data, array) and bytes(ros.data) == b"points"
    assert pair.to_gz(ros).field == gz.field
    gz.field.add(name="odd", datatype=8)
    ros, (text,) = converted(pair.to_ros, gz)
    assert ros.fields[-1].datatype == PointField.INT8
    assert "the field 'odd' of the points is of the unknown type number 9" in text
    gz, (text,) = converted(pair.to_gz, PointCloud2(fields=[PointField(name="odd", datatype=0)]))
    assert (gz.field[0].datatype, "unknown type number 0" in text) == (field.INT8, True)


def test_a_range_is_the_nearest_beam():
    pair = pair_of("sensor_msgs/msg/Range", "LaserScan")
    gz = GzLaserScan(frame="a::b", angle_min=-0.1, angle_max=0.2, ranges=[math.inf, math.nan, 2.0, 3.0])
    ros = pair.to_ros(gz)
    assert (ros.range, ros.header.frame_id, ros.radiation_type) == (2.0, "a/b", Range.INFRARED)
    assert ros.field_of_view == pytest.approx(0.3)
    assert math.isnan(pair.to_ros(GzLaserScan()).range)


def test_a_battery_of_gazebo_is_there_and_its_health_unknown():
    pair = pair_of("sensor_msgs/msg/BatteryState", "BatteryState")
    ros = pair.to_ros(pair.gz_class(voltage=12.5, percentage=0.5, power_supply_status="FULL"))
    assert (ros.voltage, ros.percentage, ros.present) == (12.5, 0.5, True)
    assert ros.power_supply_status == ros.POWER_SUPPLY_STATUS_FULL
    assert math.isnan(ros.design_capacity) and ros.temperature == 0.0
    assert ros.power_supply_health == ros.POWER_SUPPLY_HEALTH_UNKNOWN


def test_a_satellite_fix_takes_the_frame_of_its_own_field():
    pair = pair_of("sensor_msgs/msg/NavSatFix", "NavSat")
    gz = pair.gz_class(latitude_deg=47.5, longitude_deg=8.5, altitude=400.0, frame_id="robot::gps")
    set_header_value(gz.header, "frame_id", "elsewhere")
    ros = pair.to_ros(gz)
    assert (ros.latitude, ros.longitude, ros.altitude, ros.header.frame_id) == (47.5, 8.5, 400.0, "robot/gps")
    assert ros.status.status == ros.status.STATUS_FIX
    assert pair.to_gz(ros).frame_id == "robot/gps"


def test_a_quaternion_is_copied_as_it_is():
    pair = pair_of("geometry_msgs/msg/Pose", "Pose")
    unset = pair.to_ros(GzPose()).orientation
    assert (unset.x, unset.y, unset.z, unset.w) == (0.0, 0.0, 0.0, 0.0)
    gz = GzPose()
    gz.orientation.w = -1.0
    assert pair.to_ros(gz).orientation.w == -1.0


@pytest.mark.parametrize("count", [0, 1, 35, 37])
def test_a_covariance_of_another_size_is_left_zero(count):
    pair = pair_of("geometry_msgs/msg/PoseWithCovariance", "PoseWithCovariance")
    gz = pair.gz_class()
    gz.covariance.data.extend([1.0] * count)
    assert not pair.to_ros(gz).covariance.any()


def test_the_header_of_a_pose_with_covariance_is_in_its_pose():
    for ros_type, name, part in (("Pose", "PoseWithCovariance", "pose"), ("Twist", "TwistWithCovariance", "twist")):
        pair = pair_of(f"geometry_msgs/msg/{ros_type}WithCovarianceStamped", name)
        gz = pair.gz_class()
        set_header_value(getattr(gz, part).header, "frame_id", "map")
        assert pair.to_ros(gz).header.frame_id == "map"


def test_what_any_and_parameters_do_not_share_is_sent_without_a_value():
    pair = pair_of("rcl_interfaces/msg/ParameterValue", "Any")
    for limit, value in ((2**31 - 1, 2**40), (-(2**31), -(2**40))):
        assert pair.to_gz(ParameterValue(type=2, integer_value=value)).int_value == limit
    for number, name in ((8, "PARAMETER_DOUBLE_ARRAY"), (77, "number 77")):
        gz, (text,) = converted(pair.to_gz, ParameterValue(type=number))
        assert (gz.type, f"cannot hold a parameter of type {name}" in text) == (gz.NONE, True)
    ros, (text,) = converted(pair.to_ros, pair.gz_class(type="POSE3D"))
    assert (ros.type, "cannot hold a gz.msgs.Any of type POSE3D" in text) == (0, True)


@pytest.mark.parametrize(
    ("ros_type", "gz_name", "path"),
    [
        ("geometry_msgs/msg/Wrench", "Wrench", "force.x"),
        ("geometry_msgs/msg/WrenchStamped", "Wrench", "wrench.torque.z"),
        ("geometry_msgs/msg/TwistWithCovariance", "TwistWithCovariance", "twist.linear.y"),
        ("geometry_msgs/msg/TwistWithCovarianceStamped", "TwistWithCovariance", "twist.twist.angular.z"),
    ],
)
def test_commands_that_are_not_finite_are_named(ros_type, gz_name, path):
    pair = pair_of(ros_type, gz_name)
    ros = pair.ros_class()
    assert pair.fault(ros) is None
    owner, _, axis = path.rpartition(".")
    setattr(operator.attrgetter(owner)(ros), axis, math.nan)
    assert pair.fault(ros) == f"{path} is nan"


def test_a_trajectory_that_is_not_finite_is_named():
    pair = pair_of("trajectory_msgs/msg/JointTrajectory", "JointTrajectory")
    good = JointTrajectoryPoint(positions=[1.0, 2.0])
    assert pair.fault(JointTrajectory(points=[good])) is None
    bad = JointTrajectoryPoint(velocities=[0.0, -math.inf])
    assert pair.fault(JointTrajectory(points=[good, bad])) == "points[1].velocities[1] is -inf"
