"""The Fast DDS profile with the larger segment, and the settings of users, which take precedence."""

import os
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from gz_course.sim.ros.ros_program import shared_memory
from gz_course.sim.ros.ros_program.shared_memory import profile, segment_for_images

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
    """Remove all settings of DDS, and use a folder without any."""
    for name in SETTINGS:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(shared_memory, "_free_bytes", lambda: 8 * shared_memory.SEGMENT_BYTES)
    return monkeypatch


def test_the_setting_is_there_while_nodes_are_made_and_then_gone(unset):
    with segment_for_images():
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
    with segment_for_images():
        assert dict(os.environ) == before


def test_a_profile_in_the_working_directory_counts(unset, tmp_path):
    (tmp_path / "DEFAULT_FASTRTPS_PROFILES.xml").write_text("<dds/>")
    before = dict(os.environ)
    with segment_for_images():
        assert dict(os.environ) == before


def test_little_shared_memory_is_left_to_dds(unset):
    unset.setattr(shared_memory, "_free_bytes", lambda: 64 * 1024 * 1024)  # the default of a container
    before = dict(os.environ)
    with segment_for_images():
        assert dict(os.environ) == before


def test_nowhere_to_write_is_no_fault(unset):
    unset.setattr(shared_memory.tempfile, "tempdir", "/nonexistent")
    before = dict(os.environ)
    with segment_for_images():
        assert dict(os.environ) == before


@pytest.mark.parametrize(
    ("environment", "transports"),
    [
        ({}, ["segment_for_images", "network"]),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET"}, ["segment_for_images", "network"]),
        ({"ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}, ["segment_for_images"]),
        ({"ROS_LOCALHOST_ONLY": "1"}, ["segment_for_images"]),
    ],
)
def test_nodes_that_stay_on_the_machine_do_not_open_the_network(environment, transports):
    root = ET.fromstring(profile(environment))
    assert [each.text for each in root.iterfind(f".//{NAMESPACE}userTransports/*")] == transports
