"""Every numeric field of a ROS message becomes a signal named after it."""

import io
import math

import pytest

from gz_course.grader.record.messages import LONGEST_LIST, LONGEST_TEXT, fields, record_message
from gz_course.grader.record.reading import Recording
from gz_course.grader.record.recorder import Recorder

pytestmark = pytest.mark.usefixtures("without_blueprint")


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


def test_a_laser_scan_keeps_its_infinities_and_its_stamp_in_seconds(recorded):
    from sensor_msgs.msg import LaserScan

    scan = LaserScan(range_min=0.25, range_max=10.0, ranges=[1.0, math.inf, -math.inf])
    scan.header.stamp.sec, scan.header.stamp.nanosec = 7, 500_000_000
    recording = recorded(("/lidar/scan", scan))
    assert recording.arrays("topics/lidar/scan/ranges")[1][0].tolist() == [1.0, math.inf, -math.inf]
    assert recording.signal("topics/lidar/scan/range_min").values.tolist() == [0.25]
    assert recording.signal("topics/lidar/scan/header/stamp").values.tolist() == [7.5]
    assert [name for name in recording.signals() if "stamp" in name] == ["topics/lidar/scan/header/stamp"]


def test_booleans_and_whole_numbers(recorded):
    from std_msgs.msg import Bool, Int64

    recording = recorded(("/b", Bool(data=True)), ("/i", Int64(data=-(2**53))))
    assert recording.signal("topics/b/data").values.tolist() == [1.0]
    assert recording.signal("topics/i/data").values.tolist() == [float(-(2**53))]


def test_lists_of_messages_are_passed_over(recorded):
    from geometry_msgs.msg import Pose, PoseArray

    recording = recorded(("/p", PoseArray(poses=[Pose()])))
    assert recording.signals() == ["topics/p/count", "topics/p/header/stamp"]


def test_a_text_is_a_line_whenever_it_changes(recorded):
    from std_msgs.msg import String

    said = ["hello", "hello", "größer", "", "x" * (LONGEST_TEXT + 1)]
    recording = recorded(*(("/s", String(data=text)) for text in said))
    lines = recording.lines("topics/s/data")
    assert [(line.time_ns // 10**9, line.text) for line in lines] == [
        (0, "hello"),
        (2, "größer"),
        (3, ""),
        (4, "x" * LONGEST_TEXT),
    ]
    assert len(recording.signal("topics/s/count")) == 5


@pytest.mark.parametrize(("encoding", "pixel"), [("rgb8", (200, 20, 40)), ("bgr8", (40, 20, 200)), ("mono8", (90,))])
def test_a_picture_is_kept_as_jpeg_in_its_colours(recorded, encoding, pixel):
    from PIL import Image as Picture
    from sensor_msgs.msg import Image

    row = bytes(pixel * 16) + b"padding"
    image = Image(encoding=encoding, width=16, height=8, step=len(row), data=row * 8)
    recording = recorded(("/camera/image", image))
    assert recording.entities("topics", "EncodedImage") == ["topics/camera/image"]
    picture = Picture.open(io.BytesIO(recording.picture_at("topics/camera/image", 10**9)))
    assert picture.size == (16, 8)
    seen = picture.getpixel((8, 4))
    wanted = {"rgb8": (200, 20, 40), "bgr8": (200, 20, 40), "mono8": (90,)}[encoding]
    assert all(abs(a - b) < 12 for a, b in zip(seen if isinstance(seen, tuple) else (seen,), wanted, strict=True))


def test_of_many_pictures_some_are_kept(tmp_path):
    from sensor_msgs.msg import Image

    image = Image(encoding="mono8", width=1, height=1, step=1, data=[7])
    with Recorder(tmp_path / "run.rrd", "robot") as recorder:
        for tenth in range(12):
            recorder.set_time(tenth * 100_000_000)
            record_message(recorder, "/camera/image", image)
    rows = Recording(tmp_path / "run.rrd")._rows["topics/camera/image", "EncodedImage:blob"]
    assert [time / 1e9 for times, _ in rows for time in times] == [0.0, 0.5, 1.0]


@pytest.mark.parametrize("broken", [{"step": 1}, {"height": 3}, {"width": 0}, {"encoding": "16UC1"}])
def test_what_is_no_whole_picture_is_passed_over(recorded, broken):
    from sensor_msgs.msg import Image

    whole = {"encoding": "mono8", "width": 2, "height": 2, "step": 2, "data": bytes(4)}
    recording = recorded(("/camera/image", Image(**(whole | broken))))
    assert recording.entities("topics", "EncodedImage") == []
    assert recording.has("topics/camera/image/count")


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


def test_transforms_are_signals_named_after_their_frames(recorded):
    from geometry_msgs.msg import TransformStamped
    from tf2_msgs.msg import TFMessage

    mount = TransformStamped(child_frame_id="robot/lidar link")
    mount.header.frame_id = "base_link"
    mount.transform.translation.x = -0.2
    recording = recorded(("/tf_static", TFMessage(transforms=[mount, TransformStamped()])))
    assert recording.signal("topics/tf_static/base_link/robot_lidar_link/translation/x").values.tolist() == [-0.2]
    assert recording.signal("topics/tf_static/_/_/rotation/w").values.tolist() == [1.0]
