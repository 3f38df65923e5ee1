"""Every numeric field of a ROS message becomes a signal named after it."""

import math

import pytest

from grader.record.messages import LONGEST_LIST, fields, record_message
from grader.record.reading import Recording
from grader.record.recorder import Recorder


@pytest.fixture
def recorded(tmp_path):
    """Record messages on topics, a second apart, and read them back."""

    def call(*messages):
        with Recorder(tmp_path / "run.rrd", "robot") as recorder:
            for second, (topic, message) in enumerate(messages):
                recorder.set_time(second * 1_000_000_000)
                record_message(recorder, topic, message)
        return Recording(tmp_path / "run.rrd")

    return call


def test_the_leaves_of_a_nested_message():
    from geometry_msgs.msg import Twist

    names = [name for name, _ in fields(Twist(), "topics/cmd_vel")]
    assert names == [f"topics/cmd_vel/{part}/{axis}" for part in ("linear", "angular") for axis in "xyz"]


def test_a_twist(recorded):
    from geometry_msgs.msg import Twist

    twist = Twist()
    twist.linear.x, twist.angular.z = 0.5, -0.1
    recording = recorded(("/cmd_vel", twist), ("/cmd_vel", Twist()))
    assert recording.signal("topics/cmd_vel/linear/x").values.tolist() == [0.5, 0.0]
    assert recording.signal("topics/cmd_vel/angular/z").values.tolist() == [-0.1, 0.0]
    assert recording.signal("topics/cmd_vel/count").times.tolist() == [0, 1_000_000_000]


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_is_counted_and_not_a_value(recorded, bad):
    from std_msgs.msg import Float64

    recording = recorded(("/x", Float64(data=1.0)), ("/x", Float64(data=bad)))
    assert recording.signal("topics/x/data").values.tolist() == [1.0]
    assert recording.signal("topics/x/data/not_finite").times.tolist() == [1_000_000_000]
    assert len(recording.signal("topics/x/count")) == 2


def test_a_laser_scan_keeps_its_infinities_and_leaves_its_stamp_out(recorded):
    from sensor_msgs.msg import LaserScan

    scan = LaserScan(range_min=0.25, range_max=10.0, ranges=[1.0, math.inf, -math.inf])
    scan.header.stamp.sec = 7
    recording = recorded(("/lidar/scan", scan))
    assert recording.arrays("topics/lidar/scan/ranges")[1][0].tolist() == [1.0, math.inf, -math.inf]
    assert recording.signal("topics/lidar/scan/range_min").values.tolist() == [0.25]
    assert not [name for name in recording.signals() if "stamp" in name]


def test_booleans_and_whole_numbers(recorded):
    from std_msgs.msg import Bool, Int64

    recording = recorded(("/b", Bool(data=True)), ("/i", Int64(data=-(2**53))))
    assert recording.signal("topics/b/data").values.tolist() == [1.0]
    assert recording.signal("topics/i/data").values.tolist() == [float(-(2**53))]


def test_texts_and_lists_of_messages_are_passed_over(recorded):
    from geometry_msgs.msg import Pose, PoseArray
    from std_msgs.msg import String

    recording = recorded(("/s", String(data="hello")), ("/p", PoseArray(poses=[Pose()])))
    assert [name for name in recording.signals() if "count" not in name] == []


def test_an_empty_list_is_no_row_and_a_long_one_is_not_stored(recorded):
    from std_msgs.msg import Float64MultiArray

    recording = recorded(
        ("/a", Float64MultiArray(data=[])),
        ("/a", Float64MultiArray(data=[0.0] * (LONGEST_LIST + 1))),
        ("/a", Float64MultiArray(data=[0.5] * LONGEST_LIST)),
    )
    times, rows = recording.arrays("topics/a/data")
    assert times.tolist() == [2_000_000_000]
    assert len(rows[0]) == LONGEST_LIST


def test_every_common_message_type_can_be_recorded(recorded):
    """Whatever type an exercise observes, its default message must not break a run."""
    import geometry_msgs.msg
    import nav_msgs.msg
    import sensor_msgs.msg
    import std_msgs.msg

    classes = [
        value
        for package in (geometry_msgs.msg, nav_msgs.msg, sensor_msgs.msg, std_msgs.msg)
        for value in vars(package).values()
        if isinstance(value, type)
    ]
    recording = recorded(*((f"/{kind.__name__}", kind()) for kind in classes))
    assert len(classes) > 90
    assert all(recording.has(f"topics/{kind.__name__}/count") for kind in classes)
