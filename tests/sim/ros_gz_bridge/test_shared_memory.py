"""Pictures reach subscribers that know nothing of it through the larger segment; nobody's own settings are touched."""

import os
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Image
from std_msgs.msg import Int32

from gz_course.sim.gz.msgs.image_pb2 import Image as GzImage
from gz_course.sim.gz.msgs.int32_pb2 import Int32 as GzInt32
from gz_course.sim.gz.transport import Node
from gz_course.sim.ros_gz_bridge import shared_memory
from gz_course.sim.ros_gz_bridge.shared_memory import profile, room_for_pictures

SETTINGS = (
    "FASTRTPS_DEFAULT_PROFILES_FILE",
    "FASTDDS_DEFAULT_PROFILES_FILE",
    "FASTDDS_BUILTIN_TRANSPORTS",
    "RMW_IMPLEMENTATION",
)
WIDTH, HEIGHT, PICTURES = 1920, 1080, 8
NAMESPACE = "{http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles}"


@pytest.fixture
def unset(monkeypatch, tmp_path):
    """No settings of DDS, in a folder without any."""
    for name in SETTINGS:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(shared_memory, "_free_bytes", lambda: 8 * shared_memory.SEGMENT_BYTES)
    return monkeypatch


def test_large_pictures_reach_a_best_effort_subscriber(start, ros, inbox, eventually, monkeypatch):
    for name in SETTINGS:
        monkeypatch.delenv(name, raising=False)
    bridge = start("/hd@sensor_msgs/msg/Image[gz.msgs.Image", "/number@std_msgs/msg/Int32[gz.msgs.Int32")
    bridge.wait_for("ready: 2 bridges")
    pictures, numbers = inbox(), inbox()
    best_effort = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    subscriptions = [
        ros.node.create_subscription(Image, "/hd", pictures, best_effort),
        ros.node.create_subscription(Int32, "/number", numbers, 10),
    ]
    step = WIDTH * 3
    picture = GzImage(width=WIDTH, height=HEIGHT, step=step, data=bytes(step * HEIGHT), pixel_format_type="RGB_INT8")
    try:
        with Node() as gz:
            number = gz.advertise("/number", GzInt32)
            # Small ones say when DDS has connected the two processes, whatever becomes of the large ones.
            eventually(lambda: (number.publish(GzInt32(data=1)), numbers.messages)[1], "a small message arrives")
            eventually(lambda: subscriptions[0].get_publisher_count() == 1, "the bridge publishes pictures")
            publisher = gz.advertise("/hd", GzImage)
            assert publisher.wait_for_subscribers(timeout=120)
            # The other half of the connection announces itself by nothing: the first picture may be too early.
            eventually(lambda: (publisher.publish(picture), pictures.messages)[1], "the first picture", timeout=5)
            for count in range(len(pictures.messages), len(pictures.messages) + PICTURES):
                publisher.publish(picture)
                pictures.wait(count + 1, timeout=5)
    finally:
        for subscription in subscriptions:
            ros.node.destroy_subscription(subscription)
    assert len(pictures.messages[-1].data) == step * HEIGHT


def test_the_setting_is_there_while_nodes_are_made_and_then_gone(unset):
    with room_for_pictures():
        path = Path(os.environ["FASTRTPS_DEFAULT_PROFILES_FILE"])
        assert os.environ["FASTDDS_DEFAULT_PROFILES_FILE"] == str(path)
        size = ET.fromstring(path.read_text()).find(f".//{NAMESPACE}segment_size")
        assert int(size.text) == shared_memory.SEGMENT_BYTES
    assert not path.exists()
    assert not {"FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE"} & os.environ.keys()


@pytest.mark.parametrize(
    "setting",
    [
        ("FASTRTPS_DEFAULT_PROFILES_FILE", "/mine.xml"),
        ("FASTDDS_DEFAULT_PROFILES_FILE", "/mine.xml"),
        ("FASTDDS_BUILTIN_TRANSPORTS", "LARGE_DATA"),
        ("RMW_IMPLEMENTATION", "rmw_cyclonedds_cpp"),
    ],
)
def test_who_has_set_up_dds_keeps_it(unset, setting):
    unset.setenv(*setting)
    before = dict(os.environ)
    with room_for_pictures():
        assert dict(os.environ) == before


def test_a_profile_in_the_working_directory_counts(unset, tmp_path):
    (tmp_path / "DEFAULT_FASTRTPS_PROFILES.xml").write_text("<dds/>")
    before = dict(os.environ)
    with room_for_pictures():
        assert dict(os.environ) == before


def test_little_shared_memory_is_left_to_dds(unset):
    unset.setattr(shared_memory, "_free_bytes", lambda: 64 * 1024 * 1024)  # what a container has by default
    before = dict(os.environ)
    with room_for_pictures():
        assert dict(os.environ) == before


def test_nowhere_to_write_is_no_fault(unset):
    unset.setattr(shared_memory.tempfile, "tempdir", "/nonexistent")
    before = dict(os.environ)
    with room_for_pictures():
        assert dict(os.environ) == before


@pytest.mark.parametrize(
    ("environment", "transports"),
    [
        ({}, ["room_for_pictures", "network"]),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}, ["room_for_pictures", "network"]),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}, ["room_for_pictures"]),
        ({"ROS_LOCALHOST_ONLY": "1"}, ["room_for_pictures"]),
    ],
)
def test_nodes_that_stay_on_the_machine_do_not_open_the_network(environment, transports):
    root = ET.fromstring(profile(environment))
    assert [each.text for each in root.iterfind(f".//{NAMESPACE}userTransports/*")] == transports
