"""Mistakes in the files of a launch are facts of its run, and come before what the checks say."""

from pathlib import Path

from gz_course.grader.exercise import find_exercise
from gz_course.grader.kinds.kind import find_kind
from gz_course.grader.kinds.launch import plan
from gz_course.grader.submission import Submission

LAUNCH = b"""\
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch_ros.actions import Node


def generate_launch_description():
    driver = Node(package="a", executable="b")
    return LaunchDescription([DeclareLaunchArgument("world", default_value="bay.sdf")])
"""


def test_the_places_of_every_file_are_recorded_with_its_name(record):
    files = {"bringup.launch.py": LAUNCH, "driver_node.py": b"def main():\n    pass\n", "bridge.yaml": b"[]"}
    facts = plan(find_exercise("12"), Submission(Path(), "bringup.launch.py", "", files=files)).facts
    assert {name: [(each["file"], each["line"]) for each in found] for name, found in facts.items()} == {
        "launch_slips": [("bringup.launch.py", 7)],
        "declared": [("bringup.launch.py", 8)],
        "slips": [("driver_node.py", 1)],
    }
    said = [remark(record(facts=facts), []) for remark in find_kind("launch").diagnosis().remarks]
    assert [words.partition(":")[0] for words in said if words] == [
        "bringup.launch.py, line 7",
        "driver_node.py, line 1",
    ]


def test_entries_of_a_bridge_without_a_dash_between_them_are_a_mistake():
    entry = "ros_topic_name: {0}\n  gz_topic_name: {0}\n  direction: GZ_TO_ROS\n"
    for dash, lines in (("- ", []), ("  ", [4])):
        text = "- " + entry.format("/clock") + dash + entry.format("/scan")
        files = {"bringup.launch.py": b"", "bridge.yaml": text.encode()}
        facts = plan(find_exercise("12"), Submission(Path(), "bringup.launch.py", "", files=files)).facts
        found = facts.get("launch_slips", [])
        assert [each["line"] for each in found] == lines and all("a dash is missing" in each["said"] for each in found)


def test_a_second_document_of_a_bridges_file_is_a_mistake():
    entry = b"- ros_topic_name: /a\n  gz_topic_name: /a\n  direction: GZ_TO_ROS\n"
    files = {"bringup.launch.py": b"", "bridge.yaml": entry + b"---\n" + entry.replace(b"/a", b"/b")}
    facts = plan(find_exercise("12"), Submission(Path(), "bringup.launch.py", "", files=files)).facts
    assert ["a second document begins here" in each["said"] for each in facts["launch_slips"]] == [True]
