"""Messages as dictionaries, YAML and CSV and back, and interfaces by their names."""

import pytest
import yaml
from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseArray, PoseWithCovariance
from rosidl_parser.definition import NamespacedType
from sensor_msgs.msg import LaserScan
from std_msgs.msg import ByteMultiArray, Header, String

from gz_course.sim.ros import rosidl_runtime_py as package
from gz_course.sim.ros.rosidl_runtime_py import (
    message_to_csv,
    message_to_ordereddict,
    message_to_yaml,
    set_message_fields,
    utilities,
)


def test_a_message_becomes_yaml_and_comes_back():
    poses = PoseArray(header=Header(frame_id="map"))
    set_message_fields(poses, {"poses": [{"position": {"x": 1.5}}, {}]})
    again = PoseArray()
    set_message_fields(again, yaml.safe_load(message_to_yaml(poses)))
    assert again == poses and poses.poses[0].position.x == 1.5
    covariance = PoseWithCovariance(covariance=[0.5] * 36)
    set_message_fields(again := PoseWithCovariance(), message_to_ordereddict(covariance))
    assert again.covariance.tolist() == [0.5] * 36


def test_long_values_are_cut_or_described():
    scan = LaserScan(ranges=[1.0, 2.0, 3.0], header=Header(frame_id="lidar"))
    assert message_to_ordereddict(scan, truncate_length=2)["ranges"] == [1.0, 2.0, "..."]
    assert message_to_ordereddict(scan, no_arr=True)["ranges"] == "<sequence type: float, length: 3>"
    assert message_to_ordereddict(scan, no_str=True)["header"]["frame_id"] == "<string length: <5>>"
    poses, covariance = message_to_ordereddict(PoseArray(), no_arr=True), PoseWithCovariance()
    assert poses["poses"] == "<sequence type: geometry_msgs/msg/Pose, length: 0>"
    assert message_to_ordereddict(covariance, no_arr=True)["covariance"] == "<array type: double[36]>"
    assert message_to_csv(scan).endswith(",lidar,0.0,0.0,0.0,0.0,0.0,0.0,0.0,1.0,2.0,3.0")
    assert message_to_ordereddict(ByteMultiArray(data=[b"a"]))["data"] == ["a"]
    assert message_to_yaml(String(data="a: b"), flow_style=True) == "{data: 'a: b'}\n"


def test_times_of_sending():
    header, time = Header(), Time(sec=7)
    (setter,) = set_message_fields(header, {"stamp": "now", "frame_id": "a"}, expand_time_now=True)
    setter(time)
    assert header.stamp.sec == 7
    (setter,) = set_message_fields(scan := LaserScan(), {"header": "auto"}, expand_header_auto=True)
    setter(time)
    assert scan.header.stamp.sec == 7


def test_what_does_not_fit_is_refused():
    with pytest.raises(AttributeError, match="has no attribute 'dat'"):
        set_message_fields(String(), {"dat": "x"})
    with pytest.raises(TypeError, match="Value '3' is expected to be a dictionary but is a int"):
        set_message_fields(LaserScan(), {"header": 3})
    with pytest.raises(TypeError):
        set_message_fields(Header(), {"stamp": "now"})


def test_classes_by_their_names():
    assert utilities.get_message("std_msgs/String") is utilities.get_interface("std_msgs/msg/String") is String
    assert utilities.get_service("std_srvs/SetBool").Request.__name__ == "SetBool_Request"
    assert utilities.get_action("tf2_msgs/LookupTransform").Goal.__name__ == "LookupTransform_Goal"
    with pytest.raises(ValueError, match="Expected the full name of an action, got 'std_msgs/msg/String'"):
        utilities.get_action("std_msgs/msg/String")
    feedback = NamespacedType(["tf2_msgs", "action"], "LookupTransform_FeedbackMessage")
    assert package.import_message_from_namespaced_type(feedback).__name__ == "LookupTransform_FeedbackMessage"


def test_installed_interfaces():
    assert package.get_message_interfaces(["std_msgs"])["std_msgs"].count("msg/String") == 1
    assert package.get_action_interfaces(["tf2_msgs", "std_msgs"]) == {"tf2_msgs": ["action/LookupTransform"]}
    assert "srv/SetBool" in package.get_service_interfaces()["std_srvs"]
    assert {"tf2_msgs", "std_msgs"} <= package.get_interface_packages().keys()
    assert package.get_interface_path("std_msgs/msg/String").endswith("/share/std_msgs/msg/String.msg")
    with pytest.raises(LookupError, match=r"Could not find the interface .*; did you mean 'String'\?"):
        package.get_interface_path("std_msgs/msg/Sring")
    with pytest.raises(LookupError, match="Unknown package 'std_msg'"):
        package.get_interfaces(["std_msg"])
    with pytest.raises(ValueError, match="Invalid name 'String'"):
        package.get_interface_path("String")
