"""A bridge's YAML as a submission: what is bridged of a file with faults, and when there is nothing to bridge."""

from hypothesis import given
from hypothesis import strategies as st

from gz_course.grader.kinds.bridge import fault, read, usable

GOOD = b"""\
- ros_topic_name: /scan
  gz_topic_name: /lidar
  ros_type_name: sensor_msgs/msg/LaserScan
  gz_type_name: gz.msgs.LaserScan
  direction: GZ_TO_ROS
"""


def entries(text):
    assert fault("bridge.yaml", text) is None
    return usable(read("bridge.yaml", text))


def test_a_good_file_is_taken_as_it_is():
    (entry,) = entries(GOOD)
    assert (entry.ros_topic, entry.gz_topic, entry.direction.value) == ("/scan", "/lidar", "GZ_TO_ROS")
    assert entry.source == "bridge.yaml:1"


def test_a_misspelt_key_is_passed_over_as_the_original_does():
    (entry,) = entries(GOOD.replace(b"direction", b"directon"))
    assert entry.direction.value == "BIDIRECTIONAL"
    findings = read("bridge.yaml", GOOD.replace(b"direction", b"directon")).findings
    assert [each.place for each in findings if "directon" in each.sentence] == ["bridge.yaml:5"]


def test_a_bad_entry_is_left_out_and_the_others_are_bridged():
    found = entries(GOOD + GOOD.replace(b"/scan", b"/other").replace(b"GZ_TO_ROS", b"gz_to_ros"))
    assert [entry.ros_topic for entry in found] == ["/scan"]


def test_a_file_of_which_nothing_can_be_made_is_the_students_error():
    assert fault("bridge.yaml", GOOD.replace(b"GZ_TO_ROS", b"gz_to_ros")).startswith("bridge.yaml:5: the direction")
    assert "the file is empty" in fault("bridge.yaml", b"")
    assert "not valid YAML" in fault("bridge.yaml", b"- a: [")
    assert "at most 100" in fault("bridge.yaml", b"".join(GOOD.replace(b"/scan", b"/s%d" % i) for i in range(101)))


def test_names_become_what_both_graphs_show():
    def names(ros, gz):
        (entry,) = entries(GOOD.replace(b"/scan", ros).replace(b"/lidar", gz))
        return entry.ros_topic, entry.gz_topic

    assert names(b"scan", b"lidar") == ("/scan", "/lidar")
    assert names(b'"~/scan"', b"a/b") == ("/ros_gz_bridge/scan", "/a/b")
    assert names(b'"{node}/scan"', b"/a/b") == ("/ros_gz_bridge/scan", "/a/b")


def test_lazy_entries_are_connected_from_the_start():
    (entry,) = entries(GOOD + b"  lazy: true\n")
    assert entry.lazy is False


@given(st.binary(max_size=300))
def test_any_bytes_are_read_or_refused_in_one_line(data):
    sentence = fault("bridge.yaml", data)
    assert sentence is None or "\n" not in sentence
    if sentence is None:
        usable(read("bridge.yaml", data))
