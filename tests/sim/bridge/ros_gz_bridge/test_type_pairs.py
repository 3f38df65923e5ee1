"""The table of pairs is found by scanning its folder, and reports missing packages."""

import pytest

import gz_course.sim.bridge.ros_gz_bridge.convert as ros_gz_bridge_convert
from gz_course.sim.bridge.ros_gz_bridge import type_pairs
from gz_course.sim.bridge.ros_gz_bridge.type_pairs import (
    MissingPackageError,
    UnknownPairError,
    canonical_gz_type,
    find_pair,
    find_service,
)


def test_every_package_of_the_folder_contributes_pairs():
    with_pairs = {pair.ros_type.split("/")[0] for pair in type_pairs.pairs()}
    assert with_pairs | set(type_pairs.missing_packages()) == set(type_pairs.convertible_packages())
    assert {"geometry_msgs", "nav_msgs", "rosgraph_msgs", "sensor_msgs", "std_msgs"} <= with_pairs


@pytest.mark.parametrize("spelling", ["gz.msgs.Twist", "ignition.msgs.Twist", "gz_msgs.Twist", "ign_msgs.Twist"])
def test_older_spellings_of_gz_types_are_the_same_pair(spelling):
    assert canonical_gz_type(spelling) == "gz.msgs.Twist"
    assert find_pair("geometry_msgs/msg/Twist", spelling) is find_pair("geometry_msgs/msg/Twist", "gz.msgs.Twist")


@pytest.mark.parametrize(
    ("ros_type", "gz_type", "words"),
    [
        ("std_msgs/String", "gz.msgs.StringMsg", "not a ROS message type .*pairs with std_msgs/msg/String"),
        ("geometry_msgs/msg/Twist", "gz.msgs.Pose", "geometry_msgs/msg/Twist pairs with gz.msgs.Twist"),
        ("geometry_msgs/msg/Twits", "gz.msgs.Twist", "gz.msgs.Twist pairs with geometry_msgs/msg/Twist"),
        (
            "sensor_msgs/msg/LaserScn",
            "gz.msgs.LaserSan",
            "nearest pair is sensor_msgs/msg/LaserScan with gz.msgs.Las",
        ),
        ("", "", "nearest pair is"),
        ("turtle_msgs/msg/Shell", "gz.msgs.Shell", "no conversion is known for turtle_msgs/msg/Shell"),
    ],
)
def test_an_unknown_pair_names_the_nearest(ros_type, gz_type, words):
    with pytest.raises(UnknownPairError, match=words):
        find_pair(ros_type, gz_type)


def test_a_file_for_a_package_that_is_absent_is_passed_over(tmp_path, monkeypatch):
    (tmp_path / "absent_msgs.py").write_text("from absent_msgs.msg import Thing\n")
    monkeypatch.setattr(ros_gz_bridge_convert, "__path__", [*ros_gz_bridge_convert.__path__, str(tmp_path)])
    assert "absent_msgs" in type_pairs.missing_packages()
    assert type_pairs.pairs()
    with pytest.raises(MissingPackageError, match="needs the ROS package absent_msgs, which is not installed"):
        find_pair("absent_msgs/msg/Thing", "gz.msgs.Thing")


def test_a_new_file_in_the_folder_is_a_new_pair(tmp_path, monkeypatch):
    (tmp_path / "std_srvs.py").write_text(
        "from gz_course.sim.bridge.ros_gz_bridge.type_pairs import _pairs\n_pairs['std_srvs/msg/A', 'b'] = 'pair'\n"
    )
    monkeypatch.setattr(ros_gz_bridge_convert, "__path__", [*ros_gz_bridge_convert.__path__, str(tmp_path)])
    monkeypatch.setattr(type_pairs, "_pairs", dict(type_pairs._pairs))
    monkeypatch.setattr(type_pairs, "_loaded", set(type_pairs._loaded))
    assert find_pair("std_srvs/msg/A", "b") == "pair"


def test_the_same_pair_cannot_be_declared_twice():
    type_pairs.pairs()
    with pytest.raises(ValueError, match=r"std_msgs/msg/Bool = gz\.msgs\.Boolean is declared twice"):
        type_pairs.add_pair("std_msgs/msg/Bool", "gz.msgs.Boolean", to_ros=lambda gz: gz, to_gz=lambda ros: ros)


def test_the_package_that_a_type_needs_is_named(monkeypatch):
    monkeypatch.setattr(type_pairs, "_installed", lambda package: package != "ros_gz_interfaces")
    for kind, find in (("msg/Contacts", lambda name: find_pair(name, "gz.msgs.Contacts")), ("srv/Spawn", find_service)):
        with pytest.raises(MissingPackageError, match=f"/{kind} needs the ROS package ros_gz_interfaces, which is not"):
            find(f"ros_gz_interfaces/{kind}")


def test_an_unknown_service_is_told_what_is_known(monkeypatch):
    with pytest.raises(UnknownPairError, match=r"std_srvs/srv/Empty; the nearest is ros_gz_interfaces/srv/"):
        find_service("std_srvs/srv/Empty")
    monkeypatch.setattr(type_pairs, "_services", {})
    monkeypatch.setattr(type_pairs, "_installed", lambda package: package != "ros_gz_interfaces")
    with pytest.raises(UnknownPairError, match=r"std_srvs/srv/Empty; none.*not installed: ros_gz_interfaces"):
        find_service("std_srvs/srv/Empty")
